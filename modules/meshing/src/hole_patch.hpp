// One patch for one hole.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// A hole and the faces round it. Points 0 .. loop - 1 are its boundary, each once, with the hole on the
/// left; the rest belong to the faces near by. At a boundary vertex only those faces are there that hang
/// together with the boundary there.
struct HoleRegion {
  std::vector<Eigen::Vector3d> points;
  std::vector<Face> faces;
  std::size_t loop = 0;
};

/// Faces over the loop's vertices 0 .. loop - 1 and the new vertices after them.
struct Patch {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Face> faces;
};

enum class Smoothness { faired, refined, plain };

/// A triangulation of least dihedral angles and area (Liepa 2003), by CGAL; refined to the density of the
/// faces round it, times `density`; faired to continue their tangents (Botsch and Kobbelt 2004) as
/// `smoothness` asks. Nothing where CGAL finds none. The same for any thread.
[[nodiscard]] std::optional<Patch> triangulated_patch(const HoleRegion& region, Smoothness smoothness,
                                                      double density);

/// Chords between boundary vertices (lesser, greater place) that are edges of the region's faces already.
using Chords = std::set<std::pair<std::uint32_t, std::uint32_t>>;
[[nodiscard]] Chords taken_chords(const HoleRegion& region);

/// The loop seen along its mean normal, counter-clockwise.
[[nodiscard]] std::vector<Eigen::Vector2d> flattened(const std::vector<Eigen::Vector3d>& loop);

/// A constrained Delaunay triangulation in the loop's mean plane (CGAL); nothing where the loop crosses
/// itself there.
[[nodiscard]] std::optional<Patch> planar_patch(const std::vector<Eigen::Vector3d>& loop);

/// Ear clipping in the loop's mean plane, sharpest ear first, without `taken` chords; nothing where no ear is
/// left to clip.
[[nodiscard]] std::optional<Patch> clipped_patch(const std::vector<Eigen::Vector3d>& loop,
                                                 const Chords& taken);

/// Triangles from each boundary edge to one new vertex in the middle: always possible.
[[nodiscard]] Patch fan_patch(const std::vector<Eigen::Vector3d>& loop);

/// Whether the patch closes the hole and nothing else: each boundary edge once and in the right direction,
/// each other edge twice and in both, no taken chord, no face twice, and only finite coordinates.
[[nodiscard]] bool closes_hole(const Patch& patch, std::size_t loop, const Chords& taken);

}  // namespace drape::meshing
