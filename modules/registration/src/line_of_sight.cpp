#include "line_of_sight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

namespace drape::registration {
namespace {

struct Sighting {
  Eigen::Vector2d place;  // in pixels
  double depth;
};

// The viewer's image plane: across the rays of a parallel view; the octahedral map of directions (Cigolle et
// al. 2014) round an origin, which covers all of them without a pole.
class Sight {
 public:
  explicit Sight(const ScanSurface& viewer) : view_(viewer.view()) {
    constexpr double pixel_spacings = 2;
    if (view_.kind == ScanView::Kind::direction) {
      right_ = view_.vector.unitOrthogonal();
      down_ = view_.vector.cross(right_);
      pixel_ = pixel_spacings * viewer.spacing();
    } else {
      std::vector<double> ranges;
      for (const auto& p : viewer.points()) ranges.push_back((p - view_.vector).norm());
      const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
      std::nth_element(ranges.begin(), middle, ranges.end());
      pixel_ = pixel_spacings * viewer.spacing() / *middle;
    }
  }

  [[nodiscard]] std::optional<Sighting> of(const Eigen::Vector3d& point) const {
    if (view_.kind == ScanView::Kind::direction)
      return Sighting{Eigen::Vector2d(right_.dot(point), down_.dot(point)) / pixel_, view_.vector.dot(point)};
    const Eigen::Vector3d ray = point - view_.vector;
    const double range = ray.norm();
    if (!(range > 0)) return std::nullopt;
    const Eigen::Vector3d d = ray / ray.cwiseAbs().sum();
    Eigen::Vector2d place = d.head<2>();
    if (d.z() < 0)
      place = Eigen::Vector2d((1 - std::abs(d.y())) * (d.x() < 0 ? -1 : 1),
                              (1 - std::abs(d.x())) * (d.y() < 0 ? -1 : 1));
    return Sighting{place / pixel_, range};
  }

 private:
  ScanView view_;
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d down_ = Eigen::Vector3d::Zero();
  double pixel_ = 1;
};

std::int64_t key(std::int64_t x, std::int64_t y) {
  return x * (std::int64_t{1} << 32) + y;
}

std::array<std::int64_t, 2> pixel_of(const Sighting& sighting) {
  return {static_cast<std::int64_t>(std::floor(sighting.place.x())),
          static_cast<std::int64_t>(std::floor(sighting.place.y()))};
}

}  // namespace

double seen_through_share(const ScanSurface& surface, const ScanSurface& viewer,
                          const Rigid3& viewer_from_surface, double tolerance) {
  if (viewer.view().kind == ScanView::Kind::unknown || viewer.size() == 0) return 0;
  const Sight sight(viewer);
  std::unordered_map<std::int64_t, double> nearest_depth;
  for (const auto& p : viewer.points())
    if (const auto sighting = sight.of(p)) {
      const auto [x, y] = pixel_of(*sighting);
      const auto [entry, added] = nearest_depth.try_emplace(key(x, y), sighting->depth);
      if (!added) entry->second = std::min(entry->second, sighting->depth);
    }
  std::size_t judged = 0;
  std::size_t seen_through = 0;
  for (const std::uint32_t i : surface.sample(5000)) {
    const Eigen::Vector3d point = viewer_from_surface * surface.points()[i];
    const auto sighting = sight.of(point);
    if (!sighting) continue;
    const auto [x, y] = pixel_of(*sighting);
    // Only inside what the viewer saw, and in front of all that it saw around: edges may be a pixel off.
    double front = std::numeric_limits<double>::max();
    int known = 0;
    for (std::int64_t right = -1; right <= 1; ++right)
      for (std::int64_t down = -1; down <= 1; ++down)
        if (const auto entry = nearest_depth.find(key(x + right, y + down)); entry != nearest_depth.end()) {
          front = std::min(front, entry->second);
          ++known;
        }
    if (known < 9) continue;
    ++judged;
    seen_through += sighting->depth < front - tolerance * viewer.scale_at(point) ? 1 : 0;
  }
  return judged > 0 ? static_cast<double>(seen_through) / static_cast<double>(judged) : 0.0;
}

}  // namespace drape::registration
