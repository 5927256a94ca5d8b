#include "poisson.hpp"

#include "stable_double_map.hpp"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_with_circumcenter_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Point_with_normal_3.h>
#include <CGAL/Poisson_reconstruction_function.h>
#include <CGAL/Random.h>
#include <CGAL/Robust_circumcenter_traits_3.h>
#include <CGAL/Surface_mesh_cell_base_3.h>
#include <CGAL/Surface_mesh_default_criteria_3.h>
#include <CGAL/Surface_mesh_vertex_base_3.h>
#include <CGAL/make_surface_mesh.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "drape/base/error.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "point_merging.hpp"

namespace drape::meshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using OrientedPoint = std::pair<Point, Vector>;
using PoissonFunction = CGAL::Poisson_reconstruction_function<Kernel>;

// A vertex or cell that knows its number: CGAL's sets order handles by it, instead of by their addresses,
// which would make the outcome depend on where memory happens to be.
template <class Base>
class Stamped : public Base {
 public:
  using Has_timestamp = CGAL::Tag_true;
  template <class Structure>
  struct Rebind_TDS {
    using Other = Stamped<typename Base::template Rebind_TDS<Structure>::Other>;
  };
  using Base::Base;
  [[nodiscard]] std::size_t time_stamp() const { return stamp_; }
  void set_time_stamp(const std::size_t& stamp) { stamp_ = stamp; }

 private:
  std::size_t stamp_ = static_cast<std::size_t>(-1);
};

// CGAL's Surface_mesh_default_triangulation_3 with stamps.
using SurfaceTraits = CGAL::Robust_circumcenter_traits_3<Kernel>;
using SurfaceVertex = Stamped<CGAL::Surface_mesh_vertex_base_3<SurfaceTraits>>;
using SurfaceCell = Stamped<CGAL::Delaunay_triangulation_cell_base_with_circumcenter_3<
    SurfaceTraits, CGAL::Surface_mesh_cell_base_3<SurfaceTraits>>>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<SurfaceTraits,
                                   CGAL::Triangulation_data_structure_3<SurfaceVertex, SurfaceCell>>;
using SurfaceComplex = CGAL::Surface_mesh_complex_2_in_triangulation_3<Triangulation>;

// CGAL's solver weighs terms of different units against each other, so the samples go in with a spacing of 1
// about their centre: the outcome does not depend on the unit.
struct UnitFrame {
  Eigen::Vector3d center;
  double scale;

  [[nodiscard]] Point to_unit(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d q = (p - center) / scale;
    return {q.x(), q.y(), q.z()};
  }
  [[nodiscard]] Eigen::Vector3d to_world(const Point& p) const {
    return center + scale * Eigen::Vector3d(p.x(), p.y(), p.z());
  }
};

// CGAL's solver crashes on samples that all lie in one plane, and decides ties between samples on a lattice
// by addresses in memory: all go in off their place by an invisible part of the spacing.
std::vector<OrientedPoint> oriented_points(const PointCloud& samples, const UnitFrame& frame) {
  constexpr double most = 1e-4;
  std::vector<OrientedPoint> points;
  points.reserve(samples.size());
  Rng rng(0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double x = rng.uniform(-most, most);
    const double y = rng.uniform(-most, most);
    const Vector offset(x, y, rng.uniform(-most, most));
    const Eigen::Vector3f& n = samples.normals[i];
    points.emplace_back(frame.to_unit(samples.positions[i]) + offset, Vector(n.x(), n.y(), n.z()));
  }
  return points;
}

[[noreturn]] void throw_no_surface(std::size_t samples) {
  throw input_error(
      "mesh.method poisson finds no closed surface round the {} samples, as happens where they are flat; "
      "advancing_front needs none",
      samples);
}

// The implicit function as the surface mesher asks for it: reports how far it is, and can be interrupted.
// Where the function hardly changes, as far round samples of one plane, the mesher follows a surface without
// end: it is stopped after many times the calls that a surface takes.
struct WatchedFunction {
  using FT = Kernel::FT;
  using Point = Kernel::Point_3;

  const PoissonFunction* function;
  const Progress* progress;
  std::size_t samples;
  double expected_calls;
  double most_calls;
  std::size_t* calls;

  FT operator()(const Point& p) const {
    if (static_cast<double>(++*calls) > most_calls) throw_no_surface(samples);
    if (*calls % 16384 == 0)
      progress->update(1 - std::exp(-static_cast<double>(*calls) / expected_calls), "contouring the surface");
    return (*function)(p);
  }
};

// The place on the implicit surface next to a sample along its normal.
std::optional<Point> on_surface(const PoissonFunction& function, const OrientedPoint& sample) {
  for (const double reach : {0.5, 1.0, 2.0, 4.0}) {
    Point inside = sample.first - reach * sample.second;
    Point outside = sample.first + reach * sample.second;
    if (!(function(inside) < 0 && function(outside) >= 0)) continue;
    for (int i = 0; i < 20; ++i) {
      const Point middle = CGAL::midpoint(inside, outside);
      (function(middle) < 0 ? inside : outside) = middle;
    }
    return CGAL::midpoint(inside, outside);
  }
  return std::nullopt;
}

// CGAL finds its first points by shooting rays from the middle, which misses small and separate pieces: every
// part of the surface gets some.
void insert_seeds(const PointCloud& samples, const UnitFrame& frame, double seed_voxel,
                  const PoissonFunction& function, Triangulation& triangulation) {
  std::vector<Point> seeds;
  for (const OrientedPoint& sample : oriented_points(merged_on_voxels(samples, seed_voxel), frame))
    if (const std::optional<Point> p = on_surface(function, sample)) seeds.push_back(*p);
  triangulation.insert(seeds.begin(), seeds.end());
}

TriangleMesh extract(const Triangulation& triangulation, const UnitFrame& frame) {
  TriangleMesh mesh;
  std::unordered_map<const void*, std::uint32_t> index;
  for (auto facet = triangulation.finite_facets_begin(); facet != triangulation.finite_facets_end();
       ++facet) {
    if (!facet->first->is_facet_on_surface(facet->second)) continue;
    Face face{};
    for (int k = 0; k < 3; ++k) {
      const auto vertex = facet->first->vertex(Triangulation::vertex_triple_index(facet->second, k));
      const auto [entry, is_new] = index.emplace(&*vertex, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(frame.to_world(vertex->point()));
      face[static_cast<std::size_t>(k)] = entry->second;
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

}  // namespace

TriangleMesh poisson_mesh(const PointCloud& samples, const PoissonSizes& sizes, const Progress& progress) {
  CGAL::get_default_random() = CGAL::Random(0);  // CGAL seeds it by the time of day
  const UnitFrame frame{bounding_box(samples.positions).center(), sizes.spacing};
  std::vector<OrientedPoint> points = oriented_points(samples, frame);
  PoissonFunction function(points.begin(), points.end(), CGAL::First_of_pair_property_map<OrientedPoint>(),
                           CGAL::Second_of_pair_property_map<OrientedPoint>());
  progress.update(0.1, "solving Poisson's equation");
  if (!function.compute_implicit_function()) return {};
  const Point inner = function.get_inner_point();
  if (!(function(inner) < 0)) return {};

  const Progress contouring = progress.part(0.5, 1.0);
  const double radius = sizes.facet_radius / sizes.spacing;
  const double distance = sizes.facet_distance / sizes.spacing;
  const double sphere_radius = 5 * std::sqrt(function.bounding_sphere().squared_radius());
  std::size_t calls = 0;
  // The triangles are as large as their radius may be, or as their distance allows where the surface bends by
  // as much as the samples can show.
  const double calls_per_square = 150.0 * static_cast<double>(samples.size());
  const double least_square = std::min(radius * radius, 8 * distance);
  constexpr double surfaces = 40;  // as large as what was sampled: gaps are closed, too
  const WatchedFunction watched{&function,
                                &contouring,
                                samples.size(),
                                calls_per_square / (radius * radius),
                                surfaces * calls_per_square / least_square,
                                &calls};
  const CGAL::Implicit_surface_3<Kernel, WatchedFunction> surface(
      watched, Kernel::Sphere_3(inner, sphere_radius * sphere_radius), distance / 20 / sphere_radius);
  Triangulation triangulation;
  SurfaceComplex complex(triangulation);
  constexpr double seeds_apart = 8;  // in facet radii
  insert_seeds(samples, frame, seeds_apart * sizes.facet_radius, function, triangulation);
  constexpr double least_angle_deg = 20;  // the algorithm is proven to end up to 30
  const CGAL::Surface_mesh_default_criteria_3<Triangulation> criteria(least_angle_deg, radius, distance);
  // Where the function hardly changes, CGAL's mesher also meets the surface twice in one place and says so by
  // an assertion.
  try {
    CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_with_boundary_tag());
  } catch (const CGAL::Failure_exception&) {
    throw_no_surface(samples.size());
  }
  return extract(triangulation, frame);
}

}  // namespace drape::meshing
