#include "drape/io/mesh_files.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/meshing/mesh_scans.hpp"
#include "posed_scans.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

void run(const meshing::MeshOptions& options, pipeline::StageRun& run) {
  const PosedScans posed = placed_scans(run);
  // Large, and of no use to methods that go by the scans themselves.
  const PointCloud cloud = meshing::needs_cloud(posed.scans, options.method)
                               ? io::read_cloud_ply(run.artifact("register", "cloud.ply"))
                               : PointCloud();
  const meshing::MeshInput input{posed.scans, posed.world_from_scan, cloud, median_spacing_m(run)};
  const meshing::MeshResult result = meshing::mesh_scans(input, options, run.progress());
  io::write_mesh_ply(run.output("mesh.ply"), result.mesh);
  run.metric("vertices", static_cast<double>(result.mesh.vertices.size()));
  run.metric("faces", static_cast<double>(result.mesh.faces.size()));
  run.metric("samples_used", static_cast<double>(result.samples_used));
  run.metric("faces_trimmed", static_cast<double>(result.faces_trimmed));
  run.metric("components_removed", static_cast<double>(result.components_removed));
  run.metric("non_manifold_repaired", static_cast<double>(result.non_manifold_repaired));
  run.metric("self_intersections_repaired", static_cast<double>(result.self_intersections_repaired));
  run.metric("self_intersections", static_cast<double>(result.self_intersections));
}

}  // namespace

pipeline::Stage mesh_stage() {
  pipeline::Stage stage;
  stage.name = "mesh";
  stage.summary = "Builds a triangle mesh from the registered scans.";
  stage.reads = {{"ingest", "scans.json"},
                 {"ingest", "scans/*.ply"},
                 {"register", "poses.json"},
                 {"register", "cloud.ply"}};
  stage.version = 9;
  stage.writes = {"mesh.ply"};
  stage.applies = [](const pipeline::Input& input) { return !input.scans.empty(); };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
