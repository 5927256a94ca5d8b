// Meshes that are really one scan each: their vertices.
#include "drape/io/mesh_files.hpp"
#include "mesh_formats.hpp"
#include "scan_formats.hpp"

namespace drape::io {

std::vector<RangeScan> read_mesh_scan(const ScanSource& source) {
  TriangleMesh mesh = parse_mesh(source.file, source.bytes);
  RangeScan scan;
  scan.cloud.positions = std::move(mesh.vertices);
  scan.cloud.normals = std::move(mesh.normals);
  scan.cloud.colors = std::move(mesh.colors);
  scan.cloud.intensities = std::move(mesh.intensities);
  scan.cloud.confidences = std::move(mesh.confidences);
  return {std::move(scan)};
}

}  // namespace drape::io
