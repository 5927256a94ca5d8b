#include "texture_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace drape::segmentation {
namespace {

constexpr int scale_count = 7;      // sigma = 0.5, 1, ... 3.5 pixels
constexpr int direction_count = 8;  // over half a turn; the other half is the same with the sign reversed
constexpr float settled_change = 0.02F;  // of the polarity from one scale to the next
constexpr double gradient_unit = 0.01;   // brings L 0..100 to 0..1

cv::Mat blurred(const cv::Mat& image, double sigma) {
  cv::Mat out;
  cv::GaussianBlur(image, out, {}, sigma, sigma, cv::BORDER_REFLECT_101);
  return out;
}

struct Gradient {
  cv::Mat x;
  cv::Mat y;
};

Gradient gradient_of(const ImageF& lab) {
  cv::Mat lightness(lab.height(), lab.width(), CV_32F);
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) lightness.at<float>(y, x) = lab.at(x, y, 0);
  Gradient g;
  cv::Sobel(lightness, g.x, CV_32F, 1, 0, 1, gradient_unit / 2, 0, cv::BORDER_REFLECT_101);
  cv::Sobel(lightness, g.y, CV_32F, 0, 1, 1, gradient_unit / 2, 0, cv::BORDER_REFLECT_101);
  return g;
}

// The second-moment matrix of the gradient in a Gaussian window.
struct Moments {
  cv::Mat xx;
  cv::Mat xy;
  cv::Mat yy;

  Moments(const Gradient& g, double sigma)
      : xx(blurred(g.x.mul(g.x), sigma)),
        xy(blurred(g.x.mul(g.y), sigma)),
        yy(blurred(g.y.mul(g.y), sigma)) {}

  [[nodiscard]] float direction(int x, int y) const {
    return 0.5F * std::atan2(2 * xy.at<float>(y, x), xx.at<float>(y, x) - yy.at<float>(y, x));
  }
  // The larger and the smaller eigenvalue.
  [[nodiscard]] std::array<float, 2> eigenvalues(int x, int y) const {
    const float half_sum = 0.5F * (xx.at<float>(y, x) + yy.at<float>(y, x));
    const float half_difference = 0.5F * (xx.at<float>(y, x) - yy.at<float>(y, x));
    const float root = std::hypot(half_difference, xy.at<float>(y, x));
    return {half_sum + root, std::max(0.F, half_sum - root)};
  }
};

// |E+ - E-| / (E+ + E-): 1 at the edge of a flat area, near 0 in stripes.
cv::Mat polarity(const Gradient& g, const Moments& moments, double sigma) {
  std::array<cv::Mat, direction_count> directed;
  for (int d = 0; d < direction_count; ++d) {
    const double angle = std::numbers::pi * d / direction_count;
    const cv::Mat along = std::cos(angle) * g.x + std::sin(angle) * g.y;
    const cv::Mat ahead = blurred(cv::max(along, 0), sigma);
    const cv::Mat behind = blurred(cv::max(-along, 0), sigma);
    cv::divide(cv::abs(ahead - behind), ahead + behind + 1e-6, directed[static_cast<std::size_t>(d)]);
  }
  cv::Mat out(g.x.size(), CV_32F);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x) {
      const double turn = moments.direction(x, y) / std::numbers::pi * direction_count;
      const int d =
          (static_cast<int>(std::lround(turn)) % direction_count + direction_count) % direction_count;
      out.at<float>(y, x) = directed[static_cast<std::size_t>(d)].at<float>(y, x);
    }
  return blurred(out, 2 * sigma);
}

}  // namespace

ImageF texture_features(const ImageF& lab) {
  const Gradient g = gradient_of(lab);
  ImageF texture(lab.width(), lab.height(), 3, 0.F);
  Image8 settled(lab.width(), lab.height(), 1, 0);
  cv::Mat before;
  for (int k = 1; k <= scale_count; ++k) {
    const double sigma = 0.5 * k;
    const Moments moments(g, sigma);
    const cv::Mat now = polarity(g, moments, sigma);
    for (int y = 0; y < lab.height(); ++y)
      for (int x = 0; x < lab.width(); ++x) {
        if (settled.at(x, y)) continue;
        const auto [large, small] = moments.eigenvalues(x, y);
        const float contrast = std::min(1.F, 2 * std::sqrt(large + small));
        const float anisotropy = large > 0 ? 1 - small / large : 0.F;
        texture.at(x, y, 0) = anisotropy * contrast;
        texture.at(x, y, 1) = now.at<float>(y, x) * contrast;
        texture.at(x, y, 2) = contrast;
        if (k > 1 && std::abs(now.at<float>(y, x) - before.at<float>(y, x)) < settled_change)
          settled.at(x, y) = 1;
      }
    before = now;
  }
  return texture;
}

}  // namespace drape::segmentation
