#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "implicit_shape.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// The distance at the points of a cubic lattice, in blocks; what is far from the surface has the right sign
/// only.
class Lattice {
 public:
  Lattice(const ImplicitShape& shape, double pitch)
      : pitch_(pitch),
        least_(shape.box.min() - Vector3d::Constant(2 * pitch)),
        blocks_(((shape.box.sizes() / pitch).array() + 4.0).ceil().cast<int>() / block + 1),
        size_(blocks_ * block),
        values_(static_cast<std::size_t>(size_.prod())) {
    parallel_for(static_cast<std::size_t>(blocks_.prod()), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) fill(shape, unravel(i, blocks_) * block);
    });
  }

  [[nodiscard]] const Vector3i& size() const { return size_; }
  [[nodiscard]] Vector3d position(const Vector3i& point) const {
    return least_ + pitch_ * point.cast<double>();
  }
  [[nodiscard]] std::size_t index(const Vector3i& p) const {
    return (static_cast<std::size_t>(p.z()) * static_cast<std::size_t>(size_.y()) +
            static_cast<std::size_t>(p.y())) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(p.x());
  }
  [[nodiscard]] double value(const Vector3i& point) const { return values_[index(point)]; }

 private:
  static constexpr int block = 8;

  static Vector3i unravel(std::size_t i, const Vector3i& size) {
    const auto n = static_cast<int>(i);
    return {n % size.x(), n / size.x() % size.y(), n / (size.x() * size.y())};
  }

  void fill(const ImplicitShape& shape, const Vector3i& first) {
    const double middle = shape.distance(position(first) + Vector3d::Constant(pitch_ * (block - 1) / 2));
    // Half the block's diagonal, and as much again because the distances are not exact.
    const bool far = std::abs(middle) > 2 * std::sqrt(3.0) * pitch_ * block / 2;
    for (int i = 0; i < block * block * block; ++i) {
      const Vector3i point = first + unravel(static_cast<std::size_t>(i), Vector3i::Constant(block));
      values_[index(point)] = far ? middle : shape.distance(position(point));
    }
  }

  double pitch_;
  Vector3d least_;
  Vector3i blocks_;
  Vector3i size_;
  std::vector<double> values_;
};

/// Marching tetrahedra (Doi and Koide 1991) with six tetrahedra round the diagonal of each cube (Kuhn):
/// unlike marching cubes it has no ambiguous cases, so the surface is a closed manifold whatever the field.
class TetrahedraMarch {
 public:
  explicit TetrahedraMarch(const Lattice& lattice) : lattice_(lattice) {
    Vector3i cube;
    for (cube.z() = 0; cube.z() + 1 < lattice.size().z(); ++cube.z())
      for (cube.y() = 0; cube.y() + 1 < lattice.size().y(); ++cube.y())
        for (cube.x() = 0; cube.x() + 1 < lattice.size().x(); ++cube.x())
          if (crosses(cube)) march(cube);
  }
  [[nodiscard]] TriangleMesh take() { return std::move(mesh_); }

 private:
  [[nodiscard]] bool inside(const Vector3i& point) const { return lattice_.value(point) < 0; }

  [[nodiscard]] bool crosses(const Vector3i& cube) const {
    int count = 0;
    for (int k = 0; k < 8; ++k) count += inside(cube + Vector3i(k & 1, (k >> 1) & 1, k >> 2)) ? 1 : 0;
    return count > 0 && count < 8;
  }

  void march(const Vector3i& cube) {
    static constexpr int orders[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 2}, {1, 0}, {2, 1}};
    for (const auto& order : orders) {
      const Vector3i second = cube + Vector3i::Unit(order[0]);
      tetrahedron({cube, second, second + Vector3i::Unit(order[1]), cube + Vector3i::Ones()});
    }
  }

  void tetrahedron(const std::array<Vector3i, 4>& corners) {
    std::array<Vector3i, 4> in;
    std::array<Vector3i, 4> out;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (inside(corners[k]))
        in[count++] = corners[k];
      else
        out[k - count] = corners[k];
    }
    if (count == 1) {
      triangle({in[0], in[0], in[0]}, {out[0], out[1], out[2]});
    } else if (count == 2) {
      triangle({in[0], in[0], in[1]}, {out[0], out[1], out[0]});
      triangle({in[1], in[0], in[1]}, {out[0], out[1], out[1]});
    } else if (count == 3) {
      triangle({in[0], in[1], in[2]}, {out[0], out[0], out[0]});
    }
  }

  /// Corner k lies on the lattice edge from in[k] to out[k].
  void triangle(const std::array<Vector3i, 3>& in, const std::array<Vector3i, 3>& out) {
    // Which way round it goes follows exactly from the middles (times two) of the edges.
    const Vector3i a = in[0] + out[0];
    const Vector3i normal = Vector3i(in[1] + out[1] - a).cross(Vector3i(in[2] + out[2] - a));
    const Vector3i outwards = out[0] + out[1] + out[2] - in[0] - in[1] - in[2];
    Face face = {vertex(in[0], out[0]), vertex(in[1], out[1]), vertex(in[2], out[2])};
    if (normal.dot(outwards) < 0) std::swap(face[1], face[2]);
    mesh_.faces.push_back(face);
  }

  std::uint32_t vertex(const Vector3i& in, const Vector3i& out) {
    const bool upwards = (out - in).sum() > 0;
    const Vector3i step = upwards ? Vector3i(out - in) : Vector3i(in - out);
    const std::uint64_t key = lattice_.index(upwards ? in : out) * 8 +
                              static_cast<std::uint64_t>(step.x() + 2 * step.y() + 4 * step.z());
    const auto [entry, fresh] = vertices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (fresh) {
      const double a = lattice_.value(in);
      // Not at the lattice point itself, where several edges would put a vertex on the same place.
      const double t = std::clamp(a / (a - lattice_.value(out)), 0.02, 0.98);
      mesh_.vertices.push_back((1 - t) * lattice_.position(in) + t * lattice_.position(out));
    }
    return entry->second;
  }

  const Lattice& lattice_;
  TriangleMesh mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
};

/// Edges collapsed (meshoptimizer's quadrics) while faces stay within `deviation` of where they were.
TriangleMesh simplified(const TriangleMesh& march, double deviation) {
  TriangleMesh mesh = march;
  std::vector<float> positions;
  positions.reserve(3 * mesh.vertices.size());
  for (const Vector3d& p : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(p[axis]));
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * mesh.faces.size());
  for (const Face& face : mesh.faces) indices.insert(indices.end(), face.begin(), face.end());
  const std::size_t stride = 3 * sizeof(float);
  const float scale = meshopt_simplifyScale(positions.data(), mesh.vertices.size(), stride);
  const std::size_t kept =
      meshopt_simplify(indices.data(), indices.data(), indices.size(), positions.data(), mesh.vertices.size(),
                       stride, 0, static_cast<float>(deviation) / scale, 0, nullptr);
  mesh.faces.resize(kept / 3);
  for (std::size_t i = 0; i < kept; ++i) mesh.faces[i / 3][i % 3] = indices[i];
  return without_unused_vertices(mesh);
}

/// Collapsing can fold a few faces into a pouch that hangs on the surface by one edge, which then has four
/// faces. Without the connections at such edges the pouches are pieces of their own: the largest piece stays.
TriangleMesh without_pouches(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> faces_at;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      faces_at[std::minmax(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3])].push_back(f);

  std::vector<std::uint32_t> parent(mesh.faces.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  for (const auto& [edge, faces] : faces_at)
    if (faces.size() == 2) parent[root(faces[0])] = root(faces[1]);

  std::vector<std::uint32_t> sizes(mesh.faces.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) ++sizes[root(f)];
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<std::uint8_t> keep(mesh.faces.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) keep[f] = root(f) == largest ? 1 : 0;
  return with_faces(mesh, keep);
}

/// Newton's steps along the gradient, each no longer than half a lattice pitch.
void project(TriangleMesh& mesh, const ImplicitShape& shape, double pitch) {
  parallel_for(mesh.vertices.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int step = 0; step < 3; ++step) {
        const double distance = std::clamp(shape.distance(mesh.vertices[i]), -pitch / 2, pitch / 2);
        mesh.vertices[i] -= distance * outward_normal(shape, mesh.vertices[i]);
      }
  });
}

}  // namespace

TriangleMesh mesh_of(const ImplicitShape& shape, double detail) {
  const double pitch = shape.pitch * detail;
  const TriangleMesh march = TetrahedraMarch(Lattice(shape, pitch)).take();
  TriangleMesh mesh;
  // meshoptimizer does not promise to keep the topology, so it is asked for less until it does.
  for (double deviation = shape.deviation * detail; deviation > 0.01 * shape.deviation; deviation /= 2) {
    mesh = without_pouches(simplified(march, deviation));
    if (mesh_topology(mesh).closed_manifold()) break;
    mesh = march;
  }
  project(mesh, shape, pitch);
  const MeshTopology topology = mesh_topology(mesh);
  if (mesh.empty() || !topology.closed_manifold() || topology.components != 1)
    throw Error(ErrorCode::bug, "the mesh of a simulated object is not one closed surface");
  return mesh;
}

}  // namespace drape::simulation
