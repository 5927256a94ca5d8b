#include "unseen_surface.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "linear_light.hpp"

namespace drape::texturing {
namespace {

const Eigen::Vector3f neutral_color(0.62F, 0.62F, 0.6F);

}  // namespace

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

Material unseen_material(TriangleMesh& mesh, Unseen unseen, const SeenColors& seen) {
  Material material;
  if (unseen == Unseen::neutral) mesh.colors.clear();
  if (unseen == Unseen::intensity) {
    mesh.colors.clear();
    for (const float i : mesh.intensities)
      mesh.colors.emplace_back(Eigen::Vector3f::Constant(std::clamp(i, 0.F, 1.F)));
  }
  if (unseen == Unseen::inpaint) {
    const bool any = std::any_of(seen.begin(), seen.end(), [](const auto& c) { return c.has_value(); });
    if (!any) {
      mesh.colors.clear();
    } else {
      mesh.colors = harmonic_colors(mesh, seen, linear_from_stored(neutral_color));
      for (Eigen::Vector3f& c : mesh.colors) c = stored_from_linear(c);
    }
  }
  if (mesh.colors.empty()) material.flat_color = neutral_color;
  return material;
}

}  // namespace drape::texturing
