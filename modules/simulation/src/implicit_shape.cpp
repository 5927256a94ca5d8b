#include "implicit_shape.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "distance_functions.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Solids and cuts, with a lattice of cells that know which of them matter to points within.
class Composition {
 public:
  Composition(std::vector<Part> solids, std::vector<Part> cuts, const BoundingBox& box)
      : solids_(std::move(solids)),
        cuts_(std::move(cuts)),
        box_(box),
        size_((box.sizes() / cell_size).array().ceil().cast<int>()) {
    Choice all;
    for (const Part& solid : solids_) all.solids.push_back(&solid);
    for (const Part& cut : cuts_) all.cuts.push_back(&cut);
    Vector3i cell;
    for (cell.z() = 0; cell.z() < size_.z(); ++cell.z())
      for (cell.y() = 0; cell.y() < size_.y(); ++cell.y())
        for (cell.x() = 0; cell.x() < size_.x(); ++cell.x())
          cells_.push_back(
              choice_at(box_.min() + cell_size * (cell.cast<double>() + Vector3d::Constant(0.5))));
    cells_.push_back(std::move(all));  // for points out of the box
  }
  Composition(const Composition&) = delete;
  Composition& operator=(const Composition&) = delete;

  [[nodiscard]] double distance(const Vector3d& p) const {
    const Choice& near = choice(p);
    double distance = infinity;
    for (const Part* solid : near.solids) {
      const double own = solid->distance(p);
      distance = distance == infinity ? own : blend(distance, own, solid->fillet);
    }
    for (const Part* cut : near.cuts) distance = carve(distance, cut->distance(p), cut->fillet);
    return distance;
  }

  [[nodiscard]] Eigen::Vector3f color(const Vector3d& p) const {
    const Choice& near = choice(p);
    const Part* nearest = nullptr;
    double solid_distance = infinity;
    for (const Part* solid : near.solids)
      if (const double own = solid->distance(p); own < solid_distance) {
        solid_distance = own;
        nearest = solid;
      }
    for (const Part* cut : near.cuts)
      if (const double own = -cut->distance(p); own > solid_distance) {
        solid_distance = own;
        nearest = cut;
      }
    return nearest->paint(p);
  }

 private:
  struct Choice {
    std::vector<const Part*> solids;
    std::vector<const Part*> cuts;
  };
  static constexpr double cell_size = 8;

  /// What can reach any point of the cell with this centre.
  [[nodiscard]] Choice choice_at(const Vector3d& center) const {
    // Half a cell's diagonal, and as much again because the distances are not exact.
    const double slack = 2 * std::sqrt(3.0) * cell_size / 2;
    std::vector<double> distances;
    double nearest = infinity;
    for (const Part& solid : solids_) {
      distances.push_back(solid.distance(center));
      nearest = std::min(nearest, distances.back());
    }
    Choice choice;
    for (std::size_t i = 0; i < solids_.size(); ++i)
      if (distances[i] - slack <= nearest + slack + solids_[i].fillet) choice.solids.push_back(&solids_[i]);
    for (const Part& cut : cuts_)
      if (cut.distance(center) - slack <= cut.fillet + slack - nearest) choice.cuts.push_back(&cut);
    return choice;
  }

  [[nodiscard]] const Choice& choice(const Vector3d& p) const {
    if (!box_.contains(p)) return cells_.back();
    const Vector3i cell = ((p - box_.min()) / cell_size).cast<int>().cwiseMin(size_ - Vector3i::Ones());
    return cells_[static_cast<std::size_t>((cell.z() * size_.y() + cell.y()) * size_.x() + cell.x())];
  }

  std::vector<Part> solids_;
  std::vector<Part> cuts_;
  BoundingBox box_;
  Vector3i size_;
  std::vector<Choice> cells_;
};

}  // namespace

ImplicitShape compose(std::vector<Part> solids, std::vector<Part> cuts, const BoundingBox& box) {
  const auto parts = std::make_shared<const Composition>(std::move(solids), std::move(cuts), box);
  ImplicitShape shape;
  shape.distance = [parts](const Vector3d& p) { return parts->distance(p); };
  shape.color = [parts](const Vector3d& p) { return parts->color(p); };
  shape.box = box;
  return shape;
}

Vector3d outward_normal(const ImplicitShape& shape, const Vector3d& point) {
  // Over the facets of the splines' polylines, under the finest feature.
  constexpr double step = 0.3;
  // Four corners of a cube: their directions sum to zero and span space evenly.
  static constexpr int corners[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  Vector3d gradient = Vector3d::Zero();
  for (const auto& corner : corners) {
    const Vector3d direction(corner[0], corner[1], corner[2]);
    gradient += shape.distance(point + step * direction) * direction;
  }
  return gradient.normalized();
}

}  // namespace drape::simulation
