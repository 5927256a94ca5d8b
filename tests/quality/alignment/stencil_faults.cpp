#include "stencil_faults.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "drape/base/random.hpp"
#include "signed_distance.hpp"

namespace drape::lab {
namespace {

constexpr double correlation_px = 8;

/// Whether a pixel's centre belongs to a part of this size (its radius, half width or depth).
using Part = std::function<bool(const Eigen::Vector2d&, double size)>;

Eigen::Vector2d center_of(int x, int y) {
  return {x + 0.5, y + 0.5};
}

template <class Visit>
void for_each_pixel(const Image8& stencil, Visit visit) {
  for (int y = 0; y < stencil.height(); ++y)
    for (int x = 0; x < stencil.width(); ++x) visit(x, y, stencil.at(x, y) == stencil::object);
}

Eigen::Vector2d middle_of(const Image8& stencil) {
  Eigen::Vector2d sum(0, 0);
  for_each_pixel(stencil, [&](int x, int y, bool object) {
    if (object) sum += center_of(x, y);
  });
  return sum / std::max(1, object_pixels(stencil));
}

Eigen::Vector2d point_of_outline(const Image8& stencil, Rng& rng) {
  std::vector<Eigen::Vector2d> points;
  for_each_pixel(stencil, [&](int x, int y, bool object) {
    if (x > 0 && object != (stencil.at(x - 1, y) == stencil::object)) points.emplace_back(x, y + 0.5);
    if (y > 0 && object != (stencil.at(x, y - 1) == stencil::object)) points.emplace_back(x + 0.5, y);
  });
  return points.empty() ? middle_of(stencil) : points[rng.below(points.size())];
}

Eigen::Vector2d direction(Rng& rng) {
  const double angle = rng.uniform(0, 2 * std::numbers::pi);
  return {std::cos(angle), std::sin(angle)};
}

Part disc(const Eigen::Vector2d& center) {
  return [center](const Eigen::Vector2d& x, double size) { return (x - center).norm() <= size; };
}

// Pixels with this value become `value` in the part; its size is such that they are about `wanted`.
Image8 changed(const Image8& stencil, const Part& part, std::uint8_t from, std::uint8_t to, int wanted) {
  const auto count = [&](double size) {
    int pixels = 0;
    for_each_pixel(stencil, [&](int x, int y, bool) {
      pixels += stencil.at(x, y) == from && part(center_of(x, y), size);
    });
    return pixels;
  };
  double least = 0;
  double most = 2.0 * (stencil.width() + stencil.height());
  while (most - least > 0.05) {
    const double size = (least + most) / 2;
    (count(size) < wanted ? least : most) = size;
  }
  Image8 result = stencil;
  for_each_pixel(stencil, [&](int x, int y, bool) {
    if (stencil.at(x, y) == from && part(center_of(x, y), least)) result.at(x, y) = to;
  });
  return result;
}

cv::Mat smooth_noise(int width, int height, double sigma, std::uint64_t seed) {
  Rng rng(seed);
  cv::Mat noise(height, width, CV_32F);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) noise.at<float>(y, x) = static_cast<float>(rng.normal());
  // White noise blurred by s correlates as exp(-(d / 2 s)^2).
  cv::GaussianBlur(noise, noise, {0, 0}, correlation_px / 2, correlation_px / 2, cv::BORDER_REFLECT);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(noise, mean, deviation);
  return (noise - mean[0]) * (sigma / deviation[0]);
}

}  // namespace

int object_pixels(const Image8& stencil) {
  return static_cast<int>(std::count(stencil.data().begin(), stencil.data().end(), stencil::object));
}

Image8 with_boundary_noise(const Image8& stencil, double sigma_px, std::uint64_t seed) {
  const ImageF distance = signed_distance(stencil);
  const cv::Mat noise = smooth_noise(stencil.width(), stencil.height(), sigma_px, seed);
  Image8 result(stencil.width(), stencil.height(), 1, stencil::background);
  for (int y = 0; y < result.height(); ++y)
    for (int x = 0; x < result.width(); ++x)
      if (distance.at(x, y) + noise.at<float>(y, x) > 0) result.at(x, y) = stencil::object;
  return result;
}

Image8 with_missing_part(const Image8& stencil, double share, std::uint64_t seed) {
  Rng rng(seed);
  const int wanted = static_cast<int>(share * object_pixels(stencil));
  const Eigen::Vector2d at = point_of_outline(stencil, rng);
  const Eigen::Vector2d normal = direction(rng);
  const double far = 2.0 * (stencil.width() + stencil.height());
  const Part beyond = [&](const Eigen::Vector2d& x, double size) { return normal.dot(x) >= far / 2 - size; };
  const bool round = rng.below(2) == 0;
  return changed(stencil, round ? disc(at) : beyond, stencil::object, stencil::background, wanted);
}

Image8 with_extra_part(const Image8& stencil, double share, std::uint64_t seed) {
  Rng rng(seed);
  const int wanted = static_cast<int>(share * object_pixels(stencil));
  const Eigen::Vector2d at = point_of_outline(stencil, rng);
  const Eigen::Vector2d middle = middle_of(stencil);
  const Eigen::Vector2d along = direction(rng);
  const Part bar = [&](const Eigen::Vector2d& x, double size) {
    const Eigen::Vector2d from_middle = x - middle;
    const double across = from_middle.x() * along.y() - from_middle.y() * along.x();
    return from_middle.dot(along) > 0 && std::abs(across) <= size;
  };
  const bool round = rng.below(2) == 0;
  return changed(stencil, round ? disc(at) : bar, stencil::background, stencil::object, wanted);
}

Image8 with_pin_holes(const Image8& stencil, double share, std::uint64_t seed) {
  Rng rng(seed);
  Image8 result = stencil;
  const int kept = static_cast<int>((1 - share) * object_pixels(stencil));
  const ImageF depth = signed_distance(stencil);
  const double deepest = *std::max_element(depth.data().begin(), depth.data().end());
  for (int tries = 0; tries < 100'000 && object_pixels(result) > kept; ++tries) {
    const int x = static_cast<int>(rng.below(static_cast<std::uint64_t>(stencil.width())));
    const int y = static_cast<int>(rng.below(static_cast<std::uint64_t>(stencil.height())));
    const double radius = std::min(rng.uniform(4, 12), 0.6 * deepest);
    if (depth.at(x, y) < radius + 1) continue;
    for_each_pixel(result, [&](int i, int j, bool) {
      if (std::hypot(i - x, j - y) <= radius) result.at(i, j) = stencil::background;
    });
  }
  return result;
}

}  // namespace drape::lab
