#include "charts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "face_edges.hpp"
#include "triangle_raster.hpp"
#include "view_choice.hpp"

namespace drape::texturing {
namespace {

struct Adjacency {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> list;

  Adjacency(const TriangleMesh& mesh, std::span<const int> chosen) : first(mesh.faces.size() + 1, 0) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const FaceEdge& e : face_edges(mesh))
      if (chosen[e.first] == chosen[e.second]) {
        pairs.emplace_back(e.first, e.second);
        pairs.emplace_back(e.second, e.first);
      }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [a, b] : pairs) {
      ++first[a + 1];
      list.push_back(b);
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) first[f + 1] += first[f];
  }
};

Eigen::AlignedBox2d box_of(const std::vector<FaceTexels>& faces) {
  Eigen::AlignedBox2d box;
  for (const FaceTexels& t : faces)
    for (const Eigen::Vector2d& p : t) box.extend(p);
  return box;
}

// Moves the chart's faces to its own corner: whole texels of the photo stay whole texels.
void place(Chart& chart, int padding, int most_side) {
  Eigen::AlignedBox2d box = box_of(chart.texels);
  const double room = std::max(1, most_side - 2 * padding - 2);
  const double larger = box.sizes().maxCoeff() / room;
  if (larger > 1) {
    for (FaceTexels& t : chart.texels)
      for (Eigen::Vector2d& p : t) p /= larger;
    chart.scale /= larger;
    box = box_of(chart.texels);
  }
  const Eigen::Vector2d corner = box.min().array().floor() - padding;
  for (FaceTexels& t : chart.texels)
    for (Eigen::Vector2d& p : t) p -= corner;
  chart.width = static_cast<int>(std::ceil(box.max().x() - corner.x())) + padding;
  chart.height = static_cast<int>(std::ceil(box.max().y() - corner.y())) + padding;
}

// Faces reached from `start`, less those that would lie on others: they are left for charts of their own.
class ChartGrower {
 public:
  ChartGrower(const PaintedFaces& surface, std::span<const int> chosen, std::span<const PhotoSight> sights,
              double scale)
      : surface_(surface),
        chosen_(chosen),
        sights_(sights),
        scale_(scale),
        adjacency_(surface.mesh, chosen),
        done_(chosen.size(), 0),
        looked_at_(chosen.size(), 0) {}

  [[nodiscard]] bool done(std::size_t face) const { return done_[face] != 0; }

  Chart grown_from(std::uint32_t start) {
    Chart chart;
    chart.view = chosen_[start];
    chart.scale = scale_;
    ++round_;
    const PhotoSight& sight = sights_[static_cast<std::size_t>(chart.view)];
    std::vector<std::uint32_t> component = reached(start);
    std::vector<FaceTexels> texels;
    for (const std::uint32_t f : component) {
      FaceTexels t;
      for (std::size_t k = 0; k < 3; ++k)
        t[k] = scale_ * sight.pixel_of(surface_.mesh.vertices[surface_.mesh.faces[f][k]]);
      texels.push_back(t);
    }
    const Eigen::AlignedBox2d box = box_of(texels);
    const Eigen::Vector2d corner = box.min().array().floor();
    const auto width = static_cast<int>(std::ceil(box.max().x() - corner.x())) + 1;
    const auto height = static_cast<int>(std::ceil(box.max().y() - corner.y())) + 1;
    Image8 taken(width, height, 1, 0);
    for (std::size_t i = 0; i < component.size(); ++i) {
      FaceTexels t = texels[i];
      for (Eigen::Vector2d& p : t) p -= corner;
      if (!claims(t, taken) && i > 0) continue;
      done_[component[i]] = 1;
      chart.faces.push_back(component[i]);
      chart.texels.push_back(texels[i]);
    }
    return chart;
  }

 private:
  std::vector<std::uint32_t> reached(std::uint32_t start) {
    std::vector<std::uint32_t> queue = {start};
    looked_at_[start] = round_;
    for (std::size_t i = 0; i < queue.size(); ++i)
      for (std::uint32_t j = adjacency_.first[queue[i]]; j < adjacency_.first[queue[i] + 1]; ++j) {
        const std::uint32_t next = adjacency_.list[j];
        if (looked_at_[next] == round_ || done_[next] != 0) continue;
        looked_at_[next] = round_;
        queue.push_back(next);
      }
    return queue;
  }

  // Takes the texels of a face unless one of them is another's already. A centre on a common edge belongs to
  // whichever face came first.
  static bool claims(const FaceTexels& t, Image8& taken) {
    constexpr double inside = 1e-6;
    const TexelBounds bounds{0, 0, taken.width(), taken.height()};
    bool free = true;
    for_texels(t, 0, bounds, [&](int x, int y, const Eigen::Vector3d& weights) {
      free = free && (taken.at(x, y) == 0 || weights.minCoeff() < inside);
    });
    if (free) for_texels(t, 0, bounds, [&](int x, int y, const Eigen::Vector3d&) { taken.at(x, y) = 1; });
    return free;
  }

  const PaintedFaces& surface_;
  std::span<const int> chosen_;
  std::span<const PhotoSight> sights_;
  double scale_;
  Adjacency adjacency_;
  std::vector<std::uint8_t> done_;
  std::vector<std::uint32_t> looked_at_;
  std::uint32_t round_ = 0;
};

}  // namespace

std::vector<Chart> charts_of(const PaintedFaces& surface, std::span<const int> chosen,
                             std::span<const PhotoSight> sights, double scale, int padding, int most_side) {
  ChartGrower grower(surface, chosen, sights, scale);
  std::vector<Chart> charts;
  for (std::uint32_t f = 0; f < chosen.size(); ++f)
    while (chosen[f] != no_view && !grower.done(f)) {
      charts.push_back(grower.grown_from(f));
      place(charts.back(), padding, most_side);
    }
  return charts;
}

}  // namespace drape::texturing
