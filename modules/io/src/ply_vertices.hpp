// The "vertex" element of a PLY as points with attributes: the same for scans, meshes and textured models.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "ply.hpp"
#include "scan_builder.hpp"

namespace drape::io {

/// The columns that vertices_of looks at, for read_ply.
[[nodiscard]] std::vector<PlyWanted> vertex_columns();

/// All vertices, also those that are not finite. Values of files that drape wrote are taken bit by bit; of
/// other files normals are brought to unit length, colours and intensities to 0..1. Error{input} without a
/// vertex element with x, y and z.
[[nodiscard]] PointCloud vertices_of(const PlyFile& ply);

/// The values that mean 1 in the colours and the intensities of a file; 0: its values tell.
struct VertexScales {
  double color = 0;
  double intensity = 0;
};

/// Vertices one by one in the file's own numbers, for files of which not all is held. Error{input} without a
/// vertex element with x, y and z.
class VertexSamples {
 public:
  explicit VertexSamples(const PlyFile& ply);

  [[nodiscard]] SampleFields fields() const;
  [[nodiscard]] VertexScales scales() const { return scales_; }
  [[nodiscard]] Sample sample(std::size_t row) const;

  using Columns = std::array<const PlyColumn*, 3>;  // all three or none
  [[nodiscard]] const Columns& position() const { return position_; }
  [[nodiscard]] const Columns& normal() const { return normal_; }
  [[nodiscard]] const Columns& color() const { return color_; }
  [[nodiscard]] const PlyColumn* intensity() const { return intensity_; }
  [[nodiscard]] const PlyColumn* confidence() const { return confidence_; }

 private:
  Columns position_, normal_, color_;
  const PlyColumn* intensity_;
  const PlyColumn* confidence_;
  VertexScales scales_;
};

/// Marks a file as written by drape: what kind of file it is.
void put_mark(PlyBuilder& ply, std::string_view kind);
[[nodiscard]] bool has_mark(const PlyHeader& header);

/// The vertices of a cloud or a mesh on their way out: doubles, floats, and bytes for colours that bytes can
/// hold. Attributes are empty or as long as the positions.
class VertexWriter {
 public:
  explicit VertexWriter(const PointCloud& cloud)
      : VertexWriter(cloud.positions, cloud.normals, cloud.colors, cloud.intensities, cloud.confidences) {}
  explicit VertexWriter(const TriangleMesh& mesh)
      : VertexWriter(mesh.vertices, mesh.normals, mesh.colors, mesh.intensities, mesh.confidences) {}

  void declare(PlyBuilder& ply) const;
  void put_rows(PlyBuilder& ply) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  VertexWriter(std::span<const Eigen::Vector3d> positions, std::span<const Eigen::Vector3f> normals,
               std::span<const Eigen::Vector3f> colors, std::span<const float> intensities,
               std::span<const float> confidences);

  std::span<const Eigen::Vector3d> positions_;
  std::span<const Eigen::Vector3f> normals_;
  std::span<const Eigen::Vector3f> colors_;
  std::span<const float> intensities_;
  std::span<const float> confidences_;
  bool byte_colors_;
};

}  // namespace drape::io
