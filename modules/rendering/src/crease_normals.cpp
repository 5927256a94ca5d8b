#include "crease_normals.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

namespace drape::rendering {
namespace {

constexpr double crease_deg = 50;  // between the facets of a coarse cylinder (30) and the sides of a box (90)
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// The vertices that one vertex of the mesh has become are a linked list through `next`.
struct Group {
  Eigen::Vector3d first_normal;  // unit length, or zero
  Eigen::Vector3d sum;
  std::uint32_t next = none;
};

}  // namespace

SplitVertices split_at_creases(const TriangleMesh& mesh) {
  const double least_cosine = std::cos(crease_deg * std::numbers::pi / 180);
  const bool own_normals = !mesh.normals.empty();
  SplitVertices split;
  split.faces.resize(mesh.faces.size());
  std::vector<Group> groups;
  std::vector<std::uint32_t> first_group(mesh.vertices.size(), none);

  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Eigen::Vector3d scaled = scaled_face_normal(mesh, f);
    const Eigen::Vector3d normal = scaled.stableNormalized();
    const std::uint8_t filled = !mesh.filled.empty() && mesh.filled[f] != 0 ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.faces[f][k];
      std::uint32_t* link = &first_group[vertex];
      while (*link != none) {
        const Group& group = groups[*link];
        // A face without area has no direction: it joins whatever is there, and the other way round.
        const bool joins = own_normals || normal.isZero() || group.first_normal.isZero() ||
                           std::abs(normal.dot(group.first_normal)) >= least_cosine;
        if (joins && split.filled[*link] == filled) break;
        link = &groups[*link].next;
      }
      std::uint32_t chosen = *link;
      if (chosen == none) {
        chosen = static_cast<std::uint32_t>(groups.size());
        *link = chosen;  // before groups grows: link may point into it
        groups.push_back({normal, Eigen::Vector3d::Zero(), none});
        split.sources.push_back(vertex);
        split.filled.push_back(filled);
      }
      Group& group = groups[chosen];
      if (group.first_normal.isZero()) group.first_normal = normal;
      // Faces of scans may be inconsistently oriented: they must not cancel.
      group.sum += normal.dot(group.first_normal) < 0 ? Eigen::Vector3d(-scaled) : scaled;
      split.faces[f][k] = chosen;
    }
  }
  split.normals.reserve(groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i)
    split.normals.push_back(own_normals ? mesh.normals[split.sources[i]]
                                        : Eigen::Vector3f(groups[i].sum.stableNormalized().cast<float>()));
  return split;
}

}  // namespace drape::rendering
