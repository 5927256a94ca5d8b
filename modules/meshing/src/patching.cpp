#include "patching.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

#include "drape/base/parallel.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "hole_patch.hpp"
#include "hole_region.hpp"
#include "least_crossing_patch.hpp"
#include "patch_mending.hpp"

namespace drape::meshing {
namespace {

// Patches of loops up to this many edges are as dense as the mesh round them. Their vertices grow with the
// square of the edges, and the cost of fairing faster than that, so longer loops get patches of about the
// same number of vertices: 400 edges cost half a second, 2,300 at full density over a minute.
constexpr std::size_t full_density_edges = 400;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// A patch may stand in space that was seen through with this much of the hole's area: registration errs at
// edges.
constexpr double most_seen_through = 0.1;

// Where the triangulation that crosses least cannot be sought, as the loop is too long for that, a patch that
// cuts the surface in this many pairs of faces or more does more harm than the hole.
constexpr std::size_t too_many_crossings = 5;

// From the best kind of patch to the least.
enum class Kind { capped, faired, refined, plain };

// A hole and its patch.
struct Work {
  std::vector<std::uint32_t> loop;
  HoleRegion region;
  Patch patch;
  Kind kind = Kind::faired;
  double area = std::numeric_limits<double>::infinity();  // of the least patch that was made
  HoleAction action = HoleAction::leave;
  std::string how;
  std::size_t crossings = 0;  // pairs of faces
};

std::string in_words(Kind kind, double density) {
  if (kind == Kind::capped) return "capped by a plane";
  std::string words = kind == Kind::faired    ? "refined and faired"
                      : kind == Kind::refined ? "refined, not faired"
                                              : "triangulated without new vertices";
  if (density < 1 && kind != Kind::plain)
    words += fmt::format(", {:.1f} times coarser than the mesh to bound the cost", 1 / density);
  return words;
}

std::vector<Eigen::Vector3d> loop_points(const HoleRegion& region) {
  return {region.points.begin(), region.points.begin() + static_cast<std::ptrdiff_t>(region.loop)};
}

// Measured against the least patch: one that wastes area elsewhere is no better for it.
bool stands_in_seen_space(Work& work, const Patch& patch, const SpaceToKeep* keep) {
  if (keep == nullptr) return false;
  std::vector<Eigen::Vector3d> points = loop_points(work.region);
  points.insert(points.end(), patch.vertices.begin(), patch.vertices.end());
  const SeenThroughArea area = seen_through_area(keep->seen, points, patch.faces, keep->spacing);
  work.area = std::min(work.area, area.all);
  return area.through > most_seen_through * work.area;
}

std::optional<Patch> patch_of_kind(const HoleRegion& region, Kind kind, double density) {
  if (kind == Kind::capped) return planar_patch(loop_points(region));
  const Smoothness smoothness = kind == Kind::faired    ? Smoothness::faired
                                : kind == Kind::refined ? Smoothness::refined
                                                        : Smoothness::plain;
  return triangulated_patch(region, smoothness, density);
}

// Tries the best kind first, from work.kind on; a fan at the end always succeeds, unless it is the place that
// is wrong. A cap that fails is not replaced by a bulge.
void make_patch(Work& work, const SpaceToKeep* keep) {
  const Chords taken = taken_chords(work.region);
  const double density =
      std::min(1.0, static_cast<double>(full_density_edges) / static_cast<double>(work.region.loop));
  bool in_seen_space = false;
  const auto accepted = [&](std::optional<Patch> patch, HoleAction action, std::string how) {
    if (!patch || !closes_hole(*patch, work.region.loop, taken)) return false;
    if (stands_in_seen_space(work, *patch, keep)) {
      in_seen_space = true;
      return false;
    }
    if (in_seen_space) how += ": a smoother patch would stand in space that a scanner looked through";
    work.patch = std::move(*patch);
    work.action = action;
    work.how = std::move(how);
    return true;
  };
  const bool cap = work.kind == Kind::capped;
  for (const Kind kind : {Kind::capped, Kind::faired, Kind::refined, Kind::plain}) {
    if (kind < work.kind || (cap && (kind == Kind::faired || kind == Kind::refined))) continue;
    const HoleAction action = kind == Kind::capped   ? HoleAction::flat
                              : kind == Kind::faired ? HoleAction::fair
                                                     : HoleAction::plain;
    work.kind = kind;
    if (accepted(patch_of_kind(work.region, kind, density), action, in_words(kind, density))) return;
  }
  const std::vector<Eigen::Vector3d> loop = loop_points(work.region);
  if (accepted(clipped_patch(loop, taken), HoleAction::plain, "ears clipped: no smoother patch was found"))
    return;
  if (accepted(fan_patch(loop), HoleAction::plain, "a fan: no other patch was found")) return;
  work.patch = {};
  work.action = HoleAction::leave;
  work.how = "every patch would stand in space that a scanner looked through";
}

void make_patches(std::vector<Work*> works, const SpaceToKeep* keep) {
  parallel_for(works.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) make_patch(*works[i], keep);
  });
}

// Two holes may want the same chord between two vertices that both of them pass: the later one gets a fan.
void part_chords(std::vector<Work>& works) {
  std::set<Edge> chords;
  for (Work& work : works) {
    std::vector<Edge> own;
    const auto size = static_cast<std::uint32_t>(work.loop.size());
    for (const Face& f : work.patch.faces)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = f[k];
        const std::uint32_t b = f[(k + 1) % 3];
        if (a >= size || b >= size || (a + 1) % size == b || (b + 1) % size == a) continue;
        own.push_back(std::minmax(work.loop[a], work.loop[b]));
      }
    if (std::any_of(own.begin(), own.end(), [&](const Edge& e) { return chords.count(e) != 0; })) {
      work.patch = fan_patch(loop_points(work.region));
      work.action = HoleAction::plain;
      work.how = "a fan: another hole's patch has the same edges";
      continue;
    }
    chords.insert(own.begin(), own.end());
  }
}

// The blend of a boundary attribute by inverse squared distance, for each new vertex.
template <class Attribute>
void append_blended(std::vector<Attribute>& values, const TriangleMesh& mesh, const Work& work) {
  if (values.empty()) return;
  std::vector<double> weights(work.loop.size());
  for (const Eigen::Vector3d& p : work.patch.vertices) {
    double total = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double squared = (mesh.vertices[work.loop[i]] - p).squaredNorm();
      total += weights[i] = 1 / std::max(squared, std::numeric_limits<double>::min());
    }
    Attribute blend = values[work.loop[0]] * 0.0F;
    for (std::size_t i = 0; i < weights.size(); ++i)
      blend += values[work.loop[i]] * static_cast<float>(weights[i] / total);
    values.push_back(blend);
  }
}

void append_patch(TriangleMesh& mesh, const TriangleMesh& original, const Work& work) {
  const auto first_new = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto size = static_cast<std::uint32_t>(work.loop.size());
  mesh.vertices.insert(mesh.vertices.end(), work.patch.vertices.begin(), work.patch.vertices.end());
  append_blended(mesh.colors, original, work);
  append_blended(mesh.intensities, original, work);
  // No scanner saw what is filled in.
  if (!mesh.confidences.empty()) mesh.confidences.resize(mesh.vertices.size(), 0.0F);
  for (const Face& f : work.patch.faces) {
    Face face{};
    for (std::size_t k = 0; k < 3; ++k) face[k] = f[k] < size ? work.loop[f[k]] : f[k] - size + first_new;
    mesh.faces.push_back(face);
    mesh.filled.push_back(1);
  }
}

TriangleMesh assembled(const TriangleMesh& mesh, const std::vector<Work>& works) {
  TriangleMesh result = mesh;
  result.filled.resize(mesh.faces.size(), 0);
  for (const Work& work : works) append_patch(result, mesh, work);
  if (!mesh.normals.empty()) {
    const std::vector<Eigen::Vector3f> normals = vertex_normals(result);
    result.normals.insert(result.normals.end(),
                          normals.begin() + static_cast<std::ptrdiff_t>(mesh.vertices.size()), normals.end());
  }
  return result;
}

// For each hole, how many pairs of faces its patch is part of that cross.
void count_crossings(const TriangleMesh& patched, std::size_t faces_before, std::vector<Work>& works) {
  std::vector<std::uint32_t> hole_of;
  for (std::uint32_t i = 0; i < works.size(); ++i)
    hole_of.insert(hole_of.end(), works[i].patch.faces.size(), i);
  std::vector<std::uint8_t> tested(patched.faces.size(), 0);
  std::fill(tested.begin() + static_cast<std::ptrdiff_t>(faces_before), tested.end(), 1);
  for (Work& work : works) work.crossings = 0;
  for (const auto& [a, b] : self_intersecting_pairs(patched, tested)) {
    if (b >= faces_before) ++works[hole_of[b - faces_before]].crossings;
    if (a >= faces_before && hole_of[a - faces_before] != hole_of[b - faces_before])
      ++works[hole_of[a - faces_before]].crossings;
  }
}

// Each hole's faces in the mesh that its patches are assembled to: from first[i] up to first[i + 1].
std::vector<std::size_t> first_faces(std::size_t faces_before, const std::vector<Work>& works) {
  std::vector<std::size_t> first{faces_before};
  for (const Work& work : works) first.push_back(first.back() + work.patch.faces.size());
  return first;
}

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh, std::span<const std::uint32_t> vertices) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t v : vertices) box.extend(mesh.vertices[v]);
  return box;
}

// Faces with area that a triangle within this box may meet.
std::vector<Face> faces_near(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box) {
  std::vector<Face> near;
  for (const Face& f : mesh.faces)
    if (f[0] != f[1] && box.intersects(box_of(mesh, f))) near.push_back(f);
  return near;
}

// A patch is no obstacle to the one that will replace it: faces without area stand in for its own, which are
// returned. Corners alike make a face that crosses nothing.
std::vector<Face> taken_out(TriangleMesh& patched, const Work& work, std::size_t first, std::size_t end) {
  const auto from = patched.faces.begin() + static_cast<std::ptrdiff_t>(first);
  const auto to = patched.faces.begin() + static_cast<std::ptrdiff_t>(end);
  std::vector<Face> own(from, to);
  std::fill(from, to, Face{work.loop[0], work.loop[0], work.loop[0]});
  return own;
}

// The faces of a patch between vertices of the mesh that it is part of, as the work's own.
Patch own_patch(const Work& work, std::uint32_t first_new, const std::vector<Face>& faces) {
  const auto size = static_cast<std::uint32_t>(work.loop.size());
  std::unordered_map<std::uint32_t, std::uint32_t> place;
  for (std::uint32_t i = 0; i < size; ++i) place.emplace(work.loop[i], i);
  Patch patch;
  for (Face f : faces) {
    for (std::uint32_t& v : f) {
      const auto [entry, is_new] = place.emplace(v, size + static_cast<std::uint32_t>(patch.vertices.size()));
      if (is_new) patch.vertices.push_back(work.patch.vertices[v - first_new]);
      v = entry->second;
    }
    patch.faces.push_back(f);
  }
  return patch;
}

// Patches that cross the surface in spots are triangulated anew there, one after the other, and stay as they
// are elsewhere. `patched` is what all are assembled to.
TriangleMesh with_spots_mended(const TriangleMesh& mesh, std::vector<Work>& works, const SpaceToKeep* keep,
                               TriangleMesh patched) {
  const std::vector<std::size_t> first = first_faces(mesh.faces.size(), works);
  std::size_t first_new = mesh.vertices.size();
  bool any = false;
  for (std::size_t i = 0; i < works.size(); ++i) {
    Work& work = works[i];
    const auto first_vertex = static_cast<std::uint32_t>(first_new);
    first_new += work.patch.vertices.size();
    if (work.crossings == 0) continue;
    const std::vector<Face> own = taken_out(patched, work, first[i], first[i + 1]);
    Eigen::AlignedBox3d box;
    for (const Face& f : own) box.extend(box_of(patched, f));
    const MendedPatch mended = mended_patch(patched, own, faces_near(patched, box));
    Patch patch = own_patch(work, first_vertex, mended.faces);
    if (mended.crossings >= work.crossings ||
        !closes_hole(patch, work.loop.size(), taken_chords(work.region)) ||
        stands_in_seen_space(work, patch, keep)) {
      std::copy(own.begin(), own.end(), patched.faces.begin() + static_cast<std::ptrdiff_t>(first[i]));
      continue;
    }
    any = true;
    work.patch = std::move(patch);
    work.how += ", triangulated anew where it cut the surface";
    patched.faces.insert(patched.faces.end(), mended.faces.begin(), mended.faces.end());
  }
  if (!any) return patched;
  patched = assembled(mesh, works);
  count_crossings(patched, mesh.faces.size(), works);
  return patched;
}

// Where all of those cross the surface, the triangulation that crosses least is sought, one hole after the
// other, each beside the patches that the others have by then.
TriangleMesh with_fewest_crossings(const TriangleMesh& mesh, std::vector<Work>& works,
                                   const SpaceToKeep* keep, TriangleMesh patched) {
  const std::vector<std::size_t> first = first_faces(mesh.faces.size(), works);
  bool any = false;
  for (std::size_t i = 0; i < works.size(); ++i) {
    Work& work = works[i];
    if (work.crossings == 0 || work.loop.size() > most_edges_for_least_crossings) continue;
    const std::vector<Face> own = taken_out(patched, work, first[i], first[i + 1]);
    auto found = least_crossing_patch(patched, work.loop, faces_near(patched, box_of(patched, work.loop)));
    if (!found || found->crossings >= work.crossings ||
        !closes_hole(found->patch, work.loop.size(), taken_chords(work.region)) ||
        stands_in_seen_space(work, found->patch, keep)) {
      std::copy(own.begin(), own.end(), patched.faces.begin() + static_cast<std::ptrdiff_t>(first[i]));
      continue;
    }
    any = true;
    work.patch = std::move(found->patch);
    work.action = HoleAction::plain;
    work.how = "triangulated to cut the surface as little as can be";
    for (const Face& f : work.patch.faces)
      patched.faces.push_back({work.loop[f[0]], work.loop[f[1]], work.loop[f[2]]});
  }
  if (!any) return patched;
  patched = assembled(mesh, works);
  count_crossings(patched, mesh.faces.size(), works);
  return patched;
}

// The patches in the mesh, mended where they cross the surface, and the crossings that are left counted.
TriangleMesh assembled_and_mended(const TriangleMesh& mesh, std::vector<Work>& works,
                                  const SpaceToKeep* keep) {
  TriangleMesh patched = assembled(mesh, works);
  count_crossings(patched, mesh.faces.size(), works);
  return with_spots_mended(mesh, works, keep, std::move(patched));
}

// Long loops whose patches still cut the surface in many places stay open.
TriangleMesh without_harmful_patches(const TriangleMesh& mesh, std::vector<Work>& works,
                                     TriangleMesh patched) {
  bool any = false;
  for (Work& work : works) {
    if (work.crossings < too_many_crossings || work.loop.size() <= most_edges_for_least_crossings) continue;
    any = true;
    work.how = fmt::format("every patch that was found would cut the surface, the best in {} pairs of faces",
                           work.crossings);
    work.action = HoleAction::leave;
    work.patch = {};
  }
  if (!any) return patched;
  patched = assembled(mesh, works);
  count_crossings(patched, mesh.faces.size(), works);
  return patched;
}

// Where a patch crosses the surface, the next less smooth one is tried; the one that crosses least stays.
TriangleMesh with_least_crossings(const TriangleMesh& mesh, std::vector<Work>& works,
                                  const SpaceToKeep* keep) {
  TriangleMesh result = assembled_and_mended(mesh, works, keep);
  for (const Kind kind : {Kind::refined, Kind::plain}) {
    std::vector<Work> tries = works;
    std::vector<Work*> changed;
    for (Work& work : tries)
      if (work.crossings > 0 && work.kind < kind) {
        work.kind = kind;
        changed.push_back(&work);
      }
    if (changed.empty()) continue;
    make_patches(changed, keep);
    part_chords(tries);
    static_cast<void>(assembled_and_mended(mesh, tries, keep));
    for (std::size_t i = 0; i < works.size(); ++i) {
      if (tries[i].crossings >= works[i].crossings || tries[i].patch.faces.empty()) continue;
      works[i] = tries[i];
      works[i].how += ": a smoother patch would cut the surface";
    }
    part_chords(works);
    result = assembled(mesh, works);
  }
  result = with_fewest_crossings(mesh, works, keep, std::move(result));
  return without_harmful_patches(mesh, works, std::move(result));
}

}  // namespace

Patched with_patches(const TriangleMesh& mesh, const std::vector<LoopToFill>& loops, const SpaceToKeep* keep,
                     const Progress& progress) {
  Patched result;
  result.holes.resize(loops.size());
  const VertexFaces around(mesh);
  std::vector<Work> works;
  std::vector<std::size_t> hole_of;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    std::optional<HoleRegion> region = hole_region(mesh, around, loops[i].loop);
    if (!region) {
      result.holes[i].how = "the faces round it are inconsistent: a boundary edge has not exactly one face";
      continue;
    }
    const Kind kind = loops[i].style == PatchStyle::smooth ? Kind::faired
                      : loops[i].style == PatchStyle::flat ? Kind::capped
                                                           : Kind::plain;
    Work work;
    work.loop = loops[i].loop;
    work.region = std::move(*region);
    work.kind = kind;
    works.push_back(std::move(work));
    hole_of.push_back(i);
  }
  constexpr std::size_t holes_per_step = 64;
  for (std::size_t begin = 0; begin < works.size(); begin += holes_per_step) {
    progress.update(0.8 * static_cast<double>(begin) / static_cast<double>(works.size()), "filling holes");
    std::vector<Work*> step;
    for (std::size_t i = begin; i < std::min(works.size(), begin + holes_per_step); ++i)
      step.push_back(&works[i]);
    make_patches(step, keep);
  }
  progress.update(0.8, "looking for self-intersections");
  part_chords(works);
  result.mesh = with_least_crossings(mesh, works, keep);
  for (std::size_t i = 0; i < works.size(); ++i) {
    result.holes[hole_of[i]] = {works[i].action, works[i].how, works[i].patch.faces.size()};
    result.crossings += works[i].crossings;
  }
  return result;
}

}  // namespace drape::meshing
