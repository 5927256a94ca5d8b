#include "color_appearance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "distinct_poses.hpp"
#include "surface_light.hpp"

namespace drape::alignment {
namespace {

constexpr double object_px = 128;  // the object's size in the picture that is compared
constexpr int least_pixels = 100;
constexpr double most_explained = 0.98;  // beyond, what is left is the photo's noise

// A constant, and the light to the second order.
using Regressors = Eigen::Matrix<double, 10, 1>;

Regressors regressors(const Eigen::Vector3d& n, double albedo) {
  Regressors r;
  r << 1, albedo * light_harmonics(n).head<9>();
  return r;
}

// The part of the camera's picture that shows the mesh, with pixels `factor` times as many a side.
struct Part {
  Camera camera;
  double left = 0, top = 0, factor = 1;
};

Part part_of(const TriangleMesh& mesh, const Camera& camera) {
  Eigen::Vector2d least(camera.width, camera.height);
  Eigen::Vector2d most(0, 0);
  for (const Eigen::Vector3d& x : mesh.vertices) {
    const Eigen::Vector2d pixel = camera.project(x).pixel;
    least = least.cwiseMin(pixel);
    most = most.cwiseMax(pixel);
  }
  least = least.cwiseMax(Eigen::Vector2d::Zero());
  most = most.cwiseMin(Eigen::Vector2d(camera.width, camera.height));
  const Eigen::Vector2d size = (most - least).cwiseMax(1.0);
  Part part;
  part.left = least.x();
  part.top = least.y();
  part.factor = std::min(1.0, object_px / size.maxCoeff());
  part.camera = camera;
  part.camera.width = std::max(1, static_cast<int>(std::lround(size.x() * part.factor)));
  part.camera.height = std::max(1, static_cast<int>(std::lround(size.y() * part.factor)));
  Eigen::Matrix3d to_part = Eigen::Matrix3d::Identity();
  to_part.diagonal() << part.factor, part.factor, 1;
  to_part(0, 2) = -part.factor * part.left;
  to_part(1, 2) = -part.factor * part.top;
  part.camera.K = to_part * camera.K;
  return part;
}

struct Fit {
  Eigen::Matrix<double, 10, 10> matrix = Eigen::Matrix<double, 10, 10>::Identity() * 1e-4;
  Regressors vector = Regressors::Zero();
  double sum = 0;
  double squares = 0;
  int count = 0;

  void add(const Regressors& r, double value) {
    matrix += r * r.transpose();
    vector += value * r;
    sum += value;
    squares += value * value;
    ++count;
  }
  [[nodiscard]] double spread() const { return squares - sum * sum / std::max(1, count); }
  [[nodiscard]] double left_over() const {
    return std::clamp(squares - vector.dot(matrix.ldlt().solve(vector)), 0.0, spread());
  }
};

}  // namespace

double explained_colors(const TriangleMesh& mesh, rendering::Renderer& renderer, const Image8& rgb,
                        const PhotoPlane& plane, const Camera& camera) {
  const Part part = part_of(mesh, camera);
  const rendering::DepthMap seen = renderer.depth_map(part.camera);
  std::array<Fit, 3> fits;
  for (int y = 0; y < part.camera.height; ++y)
    for (int x = 0; x < part.camera.width; ++x) {
      const std::int32_t face = seen.faces.at(x, y);
      if (face == rendering::DepthMap::no_face) continue;
      const Eigen::Vector2d ideal(part.left + (x + 0.5) / part.factor, part.top + (y + 0.5) / part.factor);
      const Eigen::Vector2d pixel =
          plane.plain() ? ideal : plane.to_photo(ideal - Eigen::Vector2d(plane.principal_px()));
      const int u = static_cast<int>(std::floor(pixel.x()));
      const int v = static_cast<int>(std::floor(pixel.y()));
      if (!rgb.contains(u, v)) continue;
      const auto f = static_cast<std::size_t>(face);
      Eigen::Vector3d normal =
          part.camera.camera_from_world.linear() * scaled_face_normal(mesh, f).normalized();
      if (normal.z() > 0) normal = -normal;  // whichever side of a face is seen looks at the camera
      Eigen::Vector3f albedo = Eigen::Vector3f::Ones();
      if (!mesh.colors.empty())
        albedo =
            (mesh.colors[mesh.faces[f][0]] + mesh.colors[mesh.faces[f][1]] + mesh.colors[mesh.faces[f][2]]) /
            3;
      for (int c = 0; c < 3; ++c)
        fits[static_cast<std::size_t>(c)].add(regressors(normal, static_cast<double>(albedo[c])),
                                              rgb.at(u, v, c) / 255.0);
    }
  double spread = 0;
  double left_over = 0;
  for (const Fit& fit : fits) {
    spread += fit.spread();
    left_over += fit.left_over();
  }
  if (fits[0].count < least_pixels || !(spread > 1e-6 * fits[0].count)) return 0;
  return 1 - left_over / spread;
}

void rank_by_appearance(std::vector<RefinedPose>& poses,
                        const std::function<double(const OutlinePose&)>& explained) {
  for (RefinedPose& pose : poses) pose.agreement.lit = std::min(most_explained, explained(pose.pose));
  for (RefinedPose& pose : poses) {
    double most = pose.agreement.lit;
    for (const RefinedPose& other : poses)
      if (in_one_place(pose.pose, other.pose)) most = std::max(most, other.agreement.lit);
    pose.agreement.ranking = pose.agreement.score() * std::sqrt((1 - most) / (1 - pose.agreement.lit));
  }
  std::stable_sort(poses.begin(), poses.end(), [](const RefinedPose& a, const RefinedPose& b) {
    return a.agreement.score() > b.agreement.score();
  });
}

}  // namespace drape::alignment
