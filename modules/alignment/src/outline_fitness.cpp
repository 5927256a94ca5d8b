#include "outline_fitness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace drape::alignment {
namespace {

constexpr std::size_t list_points = 360;
constexpr int ray_count = 360;
constexpr double ray_step_px = 0.5;

// The outer outline of the largest part, through pixel centres; empty without an object pixel.
std::vector<cv::Point> outline_of(const Image8& stencil) {
  cv::Mat object(stencil.height(), stencil.width(), CV_8UC1);
  std::transform(
      stencil.data().begin(), stencil.data().end(), object.begin<std::uint8_t>(),
      [](std::uint8_t value) { return static_cast<std::uint8_t>(value == stencil::object ? 255 : 0); });
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(object, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  std::vector<cv::Point> longest;
  for (std::vector<cv::Point>& outline : outlines)
    if (outline.size() > longest.size()) longest = std::move(outline);
  return longest;
}

// `count` points at equal steps along a closed outline, from its point `first` on.
std::vector<Eigen::Vector2d> equal_steps(const std::vector<cv::Point>& outline, std::size_t first,
                                         std::size_t count) {
  const std::size_t size = outline.size();
  const auto point = [&](std::size_t i) {
    const cv::Point& p = outline[(first + i) % size];
    return Eigen::Vector2d(p.x + 0.5, p.y + 0.5);
  };
  std::vector<double> lengths{0};  // from the first point to each
  for (std::size_t i = 0; i < size; ++i) lengths.push_back(lengths.back() + (point(i + 1) - point(i)).norm());
  std::vector<Eigen::Vector2d> points;
  std::size_t segment = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = lengths.back() * static_cast<double>(k) / static_cast<double>(count);
    while (segment + 1 < size && lengths[segment + 1] <= at) ++segment;
    const double length = lengths[segment + 1] - lengths[segment];
    const double share = length > 0 ? (at - lengths[segment]) / length : 0;
    points.emplace_back((1 - share) * point(segment) + share * point(segment + 1));
  }
  return points;
}

double length_of(const std::vector<Eigen::Vector2d>& closed) {
  double length = 0;
  for (std::size_t i = 0; i < closed.size(); ++i)
    length += (closed[(i + 1) % closed.size()] - closed[i]).norm();
  return length;
}

bool borders_unknown(const ImageStencil& image, const Eigen::Vector2d& point) {
  const int x = static_cast<int>(point.x());
  const int y = static_cast<int>(point.y());
  for (int j = y - 1; j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i)
      if (image.pixels.contains(i, j) && image.pixels.at(i, j) == stencil::unknown) return true;
  return false;
}

double fitness_of(double mean_px, double loss_per_px) {
  return 100 * std::max(0.0, 1 - loss_per_px * mean_px);
}

}  // namespace

ListFitness::ListFitness(const ImageStencil& image) {
  points_ = equal_steps(outline_of(image.pixels), 0, list_points);
  for (const Eigen::Vector2d& point : points_) counts_.push_back(borders_unknown(image, point) ? 0 : 1);
  loss_per_px_ = length_of(points_) / static_cast<double>(image.moments.pixels);
}

double ListFitness::operator()(const Image8& model) const {
  const std::vector<cv::Point> outline = outline_of(model);
  if (outline.empty()) return 0;
  std::size_t common = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const double distance =
        (Eigen::Vector2d(outline[i].x + 0.5, outline[i].y + 0.5) - points_.front()).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      common = i;
    }
  }
  const std::vector<Eigen::Vector2d> points = equal_steps(outline, common, list_points);
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (counts_[i] == 0) continue;
    sum += (points[i] - points_[i]).norm();
    count += 1;
  }
  return count > 0 ? fitness_of(sum / count, loss_per_px_) : 0;
}

RayFitness::RayFitness(const ImageStencil& image) {
  const Image8& pixels = image.pixels;
  const Eigen::Vector2d center = image.moments.center;
  const double reach = std::hypot(pixels.width(), pixels.height());
  double area = 0;
  double length = 0;
  for (int k = 0; k < ray_count; ++k) {
    const double angle = 2 * std::numbers::pi * k / ray_count;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    Ray ray;
    for (double radius = 0; radius < reach; radius += ray_step_px) {
      const Eigen::Vector2d at = center + radius * along;
      const int x = static_cast<int>(std::floor(at.x()));
      const int y = static_cast<int>(std::floor(at.y()));
      if (!pixels.contains(x, y)) break;
      ray.pixels.push_back(static_cast<std::uint32_t>(y * pixels.width() + x));
    }
    std::reverse(ray.pixels.begin(), ray.pixels.end());
    ray.image_radius = radius_on(ray, pixels);
    const auto steps = static_cast<std::size_t>(std::lround(ray.image_radius / ray_step_px));
    if (steps < ray.pixels.size())
      ray.counts = pixels.data()[ray.pixels[ray.pixels.size() - 1 - steps]] != stencil::unknown;
    area += ray.image_radius * ray.image_radius / 2;
    length += ray.image_radius;
    rays_.push_back(std::move(ray));
  }
  // Of the star that the rays see; its outline as seen from the centre has the length of the rays' arcs.
  loss_per_px_ = area > 0 ? length / area : 0;
}

double RayFitness::radius_on(const Ray& ray, const Image8& stencil) {
  std::size_t steps = ray.pixels.size();
  for (const std::uint32_t pixel : ray.pixels) {
    if (stencil.data()[pixel] == stencil::object) break;
    --steps;
  }
  return static_cast<double>(steps) * ray_step_px;
}

double RayFitness::operator()(const Image8& model) const {
  double sum = 0;
  double count = 0;
  bool seen = false;
  for (const Ray& ray : rays_) {
    if (!ray.counts) continue;
    const double radius = radius_on(ray, model);
    seen |= radius > 0;
    sum += std::abs(radius - ray.image_radius);
    count += 1;
  }
  return seen ? fitness_of(sum / count, loss_per_px_) : 0;
}

}  // namespace drape::alignment
