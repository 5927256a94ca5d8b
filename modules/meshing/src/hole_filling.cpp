#include "drape/meshing/hole_filling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cleaning.hpp"
#include "drape/base/error.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/simplify.hpp"
#include "edge_repair.hpp"
#include "faces_without_area.hpp"
#include "hole_measures.hpp"
#include "nested_holes.hpp"
#include "patching.hpp"
#include "seen_space.hpp"
#include "smoothing.hpp"
#include "vertex_fans.hpp"

namespace drape::meshing {
namespace {

TriangleMesh repaired(const TriangleMesh& mesh, const FillOptions& options, FillResult& result) {
  Cleaned cleaned{mesh, 0};
  if (options.repair) {
    cleaned = with_joined_borders(mesh);
    result.vertices_joined = cleaned.removed;
    cleaned = without_bad_faces(cleaned.mesh);
    result.bad_faces_removed = cleaned.removed;
    cleaned = with_manifold_edges(cleaned.mesh);
    result.non_manifold_repaired = cleaned.removed;
    cleaned = without_faces_without_area(cleaned.mesh);
    result.bad_faces_removed += cleaned.removed;
  }
  cleaned = without_small_components(cleaned.mesh, options.min_component_percent);
  result.components_removed = cleaned.removed;
  return std::move(cleaned.mesh);
}

// Loops with a rule each: filled in what style, or left and why.
struct Plan {
  std::vector<BoundaryLoop> loops;
  std::vector<Hole> holes;
  std::vector<PatchStyle> styles;   // of the holes without a `why`
  std::vector<std::size_t> around;  // the loop that each one lies in, or itself
};

std::size_t longest(const std::vector<Hole>& holes) {
  return static_cast<std::size_t>(
      std::max_element(holes.begin(), holes.end(),
                       [](const Hole& a, const Hole& b) { return a.length < b.length; }) -
      holes.begin());
}

Plan planned(const TriangleMesh& mesh, double spacing, const FillOptions& options) {
  const Pieces pieces(mesh);
  const VertexFaces around(mesh);
  Plan plan;
  plan.loops = boundary_loops(mesh);
  for (const BoundaryLoop& loop : plan.loops) plan.holes.push_back(measured(mesh, loop));
  plan.around = loops_around(mesh, pieces, plan.loops, plan.holes, spacing);
  plan.styles.assign(plan.loops.size(), PatchStyle::smooth);
  const double limit = options.max_hole_size_spacings * spacing;
  for (std::size_t i = 0; i < plan.loops.size(); ++i) {
    Hole& hole = plan.holes[i];
    const BoundaryLoop& loop = plan.loops[i];
    const double piece_area = pieces.area(pieces.of_vertex(loop.vertices[0]));
    if (!loop.closed) {
      hole.why = "the faces round it are inconsistent: it is no closed loop";
    } else if (limit > 0 && options.base == Base::flat && i == longest(plan.holes)) {
      plan.styles[i] = PatchStyle::flat;
    } else if (plan.around[i] != i) {
      continue;  // it goes with the loop round it
    } else if (options.keep_outer_border && is_sheet_rim(hole, piece_area)) {
      hole.why = "outer border of an open sheet";
    } else if (limit > 0 && is_base(mesh, around, pieces, loop, hole, spacing)) {
      plan.styles[i] = PatchStyle::flat;
      if (options.base == Base::leave) hole.why = "a flat base";
    } else if (hole.length >= limit) {
      hole.why = "not shorter than max_hole_size_spacings";
    }
  }
  // What lies in a hole that stays open stays open.
  for (std::size_t i = 0; i < plan.loops.size(); ++i)
    if (plan.around[i] != i && !plan.holes[plan.around[i]].why.empty())
      plan.holes[i].why = "inside a hole that stays open";
  return plan;
}

// The loops to fill, with what lies in them joined to them by bridges.
struct Bridged {
  TriangleMesh mesh;  // bridges appended
  std::vector<LoopToFill> loops;
  std::vector<std::size_t> hole_of;                    // per loop
  std::vector<std::vector<std::size_t>> bridge_faces;  // per loop
};

Bridged with_bridges(const TriangleMesh& mesh, const Plan& plan) {
  Bridged result;
  result.mesh = mesh;
  result.mesh.filled.resize(mesh.faces.size(), 0);
  for (std::size_t i = 0; i < plan.loops.size(); ++i) {
    if (plan.around[i] != i || !plan.holes[i].why.empty()) continue;
    std::vector<std::uint32_t> loop = plan.loops[i].vertices;
    result.bridge_faces.emplace_back();
    for (std::size_t inner = 0; inner < plan.loops.size(); ++inner) {
      if (inner == i || plan.around[inner] != i) continue;
      BridgedLoop joined = bridged(mesh, loop, plan.loops[inner].vertices);
      loop = std::move(joined.loop);
      for (const Face& f : joined.bridge) {
        result.bridge_faces.back().push_back(result.mesh.faces.size());
        result.mesh.faces.push_back(f);
        result.mesh.filled.push_back(1);
      }
    }
    result.loops.push_back({std::move(loop), plan.styles[i]});
    result.hole_of.push_back(i);
  }
  return result;
}

// Bridges whose hole stays open after all go again.
void drop_faces(TriangleMesh& mesh, const std::vector<std::size_t>& faces) {
  for (auto f = faces.rbegin(); f != faces.rend(); ++f) {
    mesh.faces.erase(mesh.faces.begin() + static_cast<std::ptrdiff_t>(*f));
    mesh.filled.erase(mesh.filled.begin() + static_cast<std::ptrdiff_t>(*f));
  }
}

std::string reason(PatchStyle style, const Patched::Hole& patch) {
  if (patch.action == HoleAction::leave) return patch.how;
  return (style == PatchStyle::flat ? "a base; " : "shorter than max_hole_size_spacings; ") + patch.how;
}

// Fills what the plan says, and writes into its holes what became of them.
Patched carried_out(const TriangleMesh& mesh, Plan& plan, const SpaceToKeep* keep, const Progress& progress) {
  const Bridged bridged = with_bridges(mesh, plan);
  Patched patched = with_patches(bridged.mesh, bridged.loops, keep, progress);
  std::vector<std::size_t> useless;
  for (std::size_t k = 0; k < bridged.loops.size(); ++k) {
    const std::size_t i = bridged.hole_of[k];
    Hole& hole = plan.holes[i];
    hole.why = reason(plan.styles[i], patched.holes[k]);
    hole.action = patched.holes[k].action;
    if (hole.filled())
      hole.faces_added = patched.holes[k].faces + bridged.bridge_faces[k].size();
    else
      useless.insert(useless.end(), bridged.bridge_faces[k].begin(), bridged.bridge_faces[k].end());
  }
  drop_faces(patched.mesh, useless);
  for (std::size_t i = 0; i < plan.loops.size(); ++i) {
    const Hole& around = plan.holes[plan.around[i]];
    if (plan.around[i] == i || !plan.holes[i].why.empty()) continue;
    plan.holes[i].action = around.action;
    plan.holes[i].why =
        around.filled() ? "inside another hole; filled with it" : "inside a hole that stays open";
  }
  return patched;
}

void check(const TriangleMesh& mesh, double spacing) {
  if (const std::string problem = problem_of(mesh); !problem.empty())
    throw input_error("the mesh: {}", problem);
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw input_error("hole filling needs a point spacing; it is {}", spacing);
}

}  // namespace

std::string to_string(HoleAction action) {
  switch (action) {
    case HoleAction::fair:
      return "fair";
    case HoleAction::plain:
      return "plain";
    case HoleAction::flat:
      return "flat";
    case HoleAction::leave:
      break;
  }
  return "leave";
}

FillResult fill_holes(const TriangleMesh& mesh, double spacing, const FillOptions& options,
                      const PlacedScans& seen_by, const Progress& progress) {
  check(mesh, spacing);
  FillResult result;
  progress.update(0.0, "repairing the mesh");
  const TriangleMesh open = smoothed(repaired(mesh, options, result), options.smooth_rounds);

  Plan plan = planned(open, spacing, options);
  const bool any =
      std::any_of(plan.holes.begin(), plan.holes.end(), [](const Hole& h) { return h.why.empty(); });
  progress.update(0.05, "reading what the scanners saw");
  const SeenSpace seen(any && options.keep_seen_space_open ? seen_by : PlacedScans{}, spacing);
  const SpaceToKeep keep{seen, spacing};
  Patched patched = carried_out(open, plan, seen.empty() ? nullptr : &keep, progress.part(0.1, 0.8));
  result.holes = std::move(plan.holes);
  result.self_intersections = patched.crossings;
  result.mesh = std::move(patched.mesh);
  if (options.repair) {
    Cleaned parted = with_parted_fans(result.mesh);
    result.non_manifold_repaired += parted.removed;
    result.mesh = std::move(parted.mesh);
  }
  progress.update(0.9, "simplifying");
  result.simplified = simplified(result.mesh, {static_cast<std::size_t>(options.simplify_triangles),
                                               options.simplify_error_spacings * spacing});
  progress.update(1.0);
  return result;
}

}  // namespace drape::meshing
