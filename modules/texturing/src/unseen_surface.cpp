#include "unseen_surface.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <utility>

#include "linear_light.hpp"

namespace drape::texturing {
std::vector<Eigen::Vector3f> harmonic_colors(const TriangleMesh& mesh, const SeenColors& known,
                                             const Eigen::Vector3f& elsewhere) {
  // So weak that it matters only where nothing else does.
  constexpr double anchor = 1e-9;
  std::vector<int> unknown(mesh.vertices.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < unknown.size(); ++v)
    if (!known[v]) unknown[v] = count++;
  std::vector<Eigen::Triplet<double>> normal;
  Eigen::MatrixXd right = anchor * Eigen::VectorXd::Ones(count) * elsewhere.cast<double>().transpose();
  for (int i = 0; i < count; ++i) normal.emplace_back(i, i, anchor);
  const auto pull = [&](std::uint32_t a, std::uint32_t b) {  // a towards b
    const int i = unknown[a];
    if (i < 0) return;
    normal.emplace_back(i, i, 1.0);
    if (unknown[b] < 0)
      right.row(i) += known[b]->cast<double>().transpose();
    else if (unknown[b] < i)
      normal.emplace_back(i, unknown[b], -1.0);
  };
  for (const Face& f : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      pull(f[k], f[(k + 1) % 3]);
      pull(f[(k + 1) % 3], f[k]);
    }
  Eigen::MatrixXd solved(count, 3);
  if (count > 0) {
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(normal.begin(), normal.end());
    solved = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  }
  std::vector<Eigen::Vector3f> colors;
  for (std::size_t v = 0; v < unknown.size(); ++v)
    colors.push_back(known[v] ? *known[v]
                              : Eigen::Vector3f(solved.row(unknown[v]).transpose().cast<float>()));
  return colors;
}

namespace {

// Visits the sides of the unpainted faces, each from its end of the lesser distance.
template <class Visit>
void each_unpainted_edge(const TriangleMesh& mesh, const std::vector<std::uint8_t>& painted,
                         const std::vector<double>& distance, Visit visit) {
  for (std::size_t f = 0; f < painted.size(); ++f) {
    if (painted[f] != 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t near = mesh.faces[f][k];
      std::uint32_t beyond = mesh.faces[f][(k + 1) % 3];
      if (distance[near] > distance[beyond]) std::swap(near, beyond);
      visit(near, beyond);
    }
  }
}

// Of each vertex to painted surface, along unpainted edges; infinite beyond `reach`.
std::vector<double> distances_to_painted(const TriangleMesh& mesh, const std::vector<std::uint8_t>& painted,
                                         double reach) {
  constexpr double far = std::numeric_limits<double>::infinity();
  std::vector<double> distance(mesh.vertices.size(), far);
  for (std::size_t f = 0; f < painted.size(); ++f)
    if (painted[f] != 0)
      for (const std::uint32_t v : mesh.faces[f]) distance[v] = 0;
  // Bellman and Ford: within a few edges of the start nothing changes any more.
  for (bool changed = true; changed;) {
    changed = false;
    each_unpainted_edge(mesh, painted, distance, [&](std::uint32_t near, std::uint32_t beyond) {
      const double along = distance[near] + (mesh.vertices[near] - mesh.vertices[beyond]).norm();
      if (along > reach || distance[beyond] <= along) return;
      distance[beyond] = along;
      changed = true;
    });
  }
  return distance;
}

}  // namespace

std::vector<std::uint8_t> faces_within_reach(const TriangleMesh& mesh,
                                             const std::vector<std::uint8_t>& painted, double reach) {
  const std::vector<double> distance = distances_to_painted(mesh, painted, reach);
  std::vector<std::uint8_t> within(painted.size(), 0);
  for (std::size_t f = 0; f < painted.size(); ++f)
    within[f] = painted[f] == 0 && std::all_of(mesh.faces[f].begin(), mesh.faces[f].end(),
                                               [&](std::uint32_t v) { return distance[v] <= reach; });
  return within;
}

std::vector<EdgeSplit> ends_of_reach(const TriangleMesh& mesh, const std::vector<std::uint8_t>& painted,
                                     double reach) {
  constexpr double just_within = 0.999;  // of the reach, so that rounding leaves the cuts within it
  constexpr double least_part = 0.05;    // of the reach: shorter parts are not worth a cut
  const std::vector<double> distance = distances_to_painted(mesh, painted, reach);
  std::vector<EdgeSplit> splits;
  each_unpainted_edge(mesh, painted, distance, [&](std::uint32_t near, std::uint32_t beyond) {
    if (!(distance[near] < reach) || distance[beyond] <= reach) return;
    const double length = (mesh.vertices[near] - mesh.vertices[beyond]).norm();
    const double part = just_within * (reach - distance[near]);
    if (std::min(part, length - part) < least_part * reach) return;
    const double share = part / length;
    if (near < beyond)
      splits.push_back({near, beyond, share});
    else
      splits.push_back({beyond, near, 1 - share});
  });
  return splits;
}

std::vector<Eigen::Vector3f> unseen_colors(const TriangleMesh& mesh, Unseen unseen, const SeenColors& seen) {
  std::vector<Eigen::Vector3f> colors;
  switch (unseen) {
    case Unseen::neutral:
      break;
    case Unseen::scan_colour:
      colors = mesh.colors;
      break;
    case Unseen::intensity:
      for (const float i : mesh.intensities)
        colors.emplace_back(Eigen::Vector3f::Constant(std::clamp(i, 0.F, 1.F)));
      break;
    case Unseen::inpaint:
      if (std::none_of(seen.begin(), seen.end(), [](const auto& c) { return c.has_value(); })) break;
      colors = harmonic_colors(mesh, seen, linear_from_stored(neutral_color));
      for (Eigen::Vector3f& c : colors) c = stored_from_linear(c);
      break;
  }
  return colors;
}

}  // namespace drape::texturing
