#include <algorithm>

#include "drape/base/error.hpp"
#include "drape/base/log.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/records.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "drape/stages/units.hpp"
#include "posed_scans.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

struct MeshInFrame {
  TriangleMesh mesh;
  io::WorkspaceFrame frame;
  double spacing_m = 0;
};

MeshInFrame given_mesh(pipeline::StageRun& run) {
  MeshInFrame given;
  given.mesh = io::read_mesh(run.input().mesh);
  if (given.mesh.empty()) throw input_error("{}: has no faces; it is no mesh", run.input().mesh.string());
  given.frame = workspace_frame(bounding_box(given.mesh.vertices), run);
  for (Eigen::Vector3d& vertex : given.mesh.vertices) vertex = given.frame.from_input(vertex);
  given.spacing_m = median_edge_length(given.mesh);
  return given;
}

MeshInFrame scanned_mesh(pipeline::StageRun& run) {
  return {io::read_mesh(run.artifact("mesh", "mesh.ply")),
          io::read_scans_record(run.artifact("ingest", "scans.json")).frame, median_spacing_m(run)};
}

io::HoleRecord to_record(const meshing::Hole& hole, double spacing_m) {
  io::HoleRecord record;
  record.boundary_edges = hole.boundary_edges;
  record.length_m = hole.length;
  record.length_spacings = hole.length / spacing_m;
  record.area_m2 = hole.area;
  record.flatness_m = hole.flatness;
  record.center = hole.center;
  record.action = meshing::to_string(hole.action);
  record.why = hole.why;
  record.faces_added = hole.faces_added;
  return record;
}

void run(const meshing::FillOptions& options, pipeline::StageRun& run) {
  const MeshInFrame input = run.input().mesh.empty() ? scanned_mesh(run) : given_mesh(run);
  // A mesh that was given comes without scans.
  const PosedScans posed = run.input().mesh.empty() ? placed_scans(run) : PosedScans{};
  const meshing::FillResult result = meshing::fill_holes(
      input.mesh, input.spacing_m, options, {posed.scans, posed.world_from_scan}, run.progress());
  io::write_mesh_ply(run.output("mesh.ply"), result.mesh);
  io::write_mesh_ply(run.output("mesh_simplified.ply"), result.simplified);
  io::HolesRecord record{input.frame, input.spacing_m, {}};
  for (const meshing::Hole& hole : result.holes) record.holes.push_back(to_record(hole, input.spacing_m));
  io::write_holes(run.output("holes.json"), record);
  run.metric("holes", static_cast<double>(record.holes.size()));
  run.metric("holes_filled",
             static_cast<double>(std::count_if(result.holes.begin(), result.holes.end(),
                                               [](const meshing::Hole& h) { return h.filled(); })));
  run.metric("faces", static_cast<double>(result.mesh.faces.size()));
  run.metric("faces_simplified", static_cast<double>(result.simplified.faces.size()));
  run.metric("self_intersections_added", static_cast<double>(result.self_intersections));
  run.metric("spacing_m", input.spacing_m);
}

}  // namespace

pipeline::Stage fill_stage() {
  pipeline::Stage stage;
  stage.name = "fill";
  stage.summary =
      "Repairs the mesh, closes holes under a stated limit, and makes a simplified copy for texturing.";
  stage.input_parts = {"mesh", "units"};
  stage.version = 5;
  stage.reads = {
      {"mesh", "mesh.ply"}, {"ingest", "scans.json"}, {"ingest", "scans/*.ply"}, {"register", "poses.json"}};
  stage.writes = {"mesh.ply", "mesh_simplified.ply", "holes.json"};
  stage.applies = [](const pipeline::Input&) { return true; };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
