#include "shading_refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace drape::alignment {
namespace {

constexpr std::array<int, 3> first_steps_px = {3, 2, 2};  // of the coarsest level; then one
constexpr std::size_t most_rounds = 20;
constexpr double at_rest_sigmas = 0.05;
constexpr double most_turn_rad = 0.05;

}  // namespace

InsideOfPhoto inside_of_photo(const Image8& rgb, const PhotoPlane& plane, const StencilLevel& level,
                              double margin_px) {
  InsideOfPhoto photo;
  photo.window = level.window;
  const int width = level.window.width;
  const int height = level.window.height;
  photo.brightness.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  photo.inside.assign(photo.brightness.size(), 0);
  const int step = std::max(1, static_cast<int>(std::lround(1 / level.window.px_per_photo_px)));
  const int margin = static_cast<int>(std::ceil(margin_px));
  const auto sure = [&](int x, int y) {
    for (int j = -margin; j <= margin; ++j)
      for (int i = -margin; i <= margin; ++i)
        if (i * i + j * j <= margin * margin &&
            (!level.object.at(x + i, y + j) || !level.known.at(x + i, y + j)))
          return false;
    return true;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!sure(x, y)) continue;
      double sum = 0;
      int count = 0;
      for (int j = 0; j < step; ++j)
        for (int i = 0; i < step; ++i) {
          const Eigen::Vector2d at = plane.to_photo(
              level.window.to_photo(Eigen::Vector2d(x + (i + 0.5) / step, y + (j + 0.5) / step)));
          const int u = static_cast<int>(std::floor(at.x()));
          const int v = static_cast<int>(std::floor(at.y()));
          if (!rgb.contains(u, v)) continue;
          sum += rgb.at(u, v, 0) + rgb.at(u, v, 1) + rgb.at(u, v, 2);
          ++count;
        }
      if (count == 0) continue;
      const auto p =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      photo.brightness[p] = static_cast<float>(sum / (765.0 * count));
      photo.inside[p] = 1;
    }
  return photo;
}

SurfaceLight PhotoShading::light_at(const OutlinePose& pose) {
  drawing_.draw(mesh_, pose, photo_.window);
  return {drawing_.pixels(), photo_.window.width, photo_.brightness, photo_.inside};
}

std::optional<ShadingFit> PhotoShading::fit(const OutlinePose& pose) {
  const SurfaceLight light = light_at(pose);
  return light.sees_enough() ? std::optional<ShadingFit>(light.fit()) : std::nullopt;
}

std::optional<PhotoShading::Equations> PhotoShading::equations(const OutlinePose& pose,
                                                               const Eigen::MatrixXd& directions,
                                                               int step_px) {
  const SurfaceLight light = light_at(pose);
  if (!light.sees_enough()) return std::nullopt;
  const Eigen::MatrixXd jacobian = brightness_changes(drawing_.pixels(), photo_.window, pose, light.pixels(),
                                                      light.coefficients(), step_px) *
                                   directions;
  // The light goes along with the pose: its coefficients are eliminated (Schur's complement).
  Equations result;
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(directions.cols(), light_terms);
  LightTerms pull = LightTerms::Zero();
  result.matrix = Eigen::MatrixXd::Zero(directions.cols(), directions.cols());
  result.vector = Eigen::VectorXd::Zero(directions.cols());
  for (std::size_t i = 0; i < light.pixels().size(); ++i) {
    const Eigen::VectorXd row = jacobian.row(static_cast<Eigen::Index>(i)).transpose();
    const double weight = light.weight(i);
    result.matrix += weight * row * row.transpose();
    mixed += weight * row * light.look(i).transpose();
    result.vector += weight * light.residual(i) * row;
    pull += weight * light.residual(i) * light.look(i);
  }
  const auto solver = light.matrix().ldlt();
  const ShadingFit fit = light.fit();
  const double confidence = fit.independent / fit.pixels / (fit.sigma * fit.sigma);
  result.vector = confidence * (result.vector - mixed * solver.solve(pull));
  result.matrix = (confidence * (result.matrix - mixed * solver.solve(mixed.transpose()))).eval();
  return result;
}

std::optional<ShadedPose> pose_by_shading(NoisyOutline& outline, const LitMesh& mesh,
                                          const std::vector<InsideOfPhoto>& coarse_to_fine,
                                          const RefinedPose& start) {
  if (coarse_to_fine.empty()) return std::nullopt;
  const LensPrior& lens = outline.lens();
  const Eigen::MatrixXd directions = free_directions(lens, false);
  // Shading's coordinates among the pose's own: where the lens ties perspective to scale, by scale alone.
  const Eigen::MatrixXd coordinates = (directions.array() == 1.0).cast<double>();
  ShadedPose result;
  OutlinePose pose = start.pose;
  for (std::size_t level = 0; level < coarse_to_fine.size(); ++level) {
    PhotoShading shading(mesh, coarse_to_fine[level]);
    for (std::size_t round = 0; round < most_rounds; ++round) {
      const int step_px = level == 0 && round < first_steps_px.size() ? first_steps_px[round] : 1;
      const NormalEquations sum = outline.equations(pose);
      const auto light = shading.equations(pose, directions, step_px);
      if (!light || !outline.matched()) return std::nullopt;
      if (level == 0 && round == 0) result.chi_squared_before = sum.chi_squared;
      result.refined.pose = pose;
      result.refined.agreement = outline.agreement();
      result.refined.chi_squared = sum.chi_squared;
      result.refined.information = sum.matrix + coordinates * light->matrix * coordinates.transpose();
      Eigen::MatrixXd matrix = directions.transpose() * sum.matrix * directions + light->matrix;
      matrix.diagonal() *= 1 + 1e-6;
      const Eigen::VectorXd solution =
          matrix.ldlt().solve(directions.transpose() * sum.vector + light->vector);
      PoseVector step = directions * solution;
      if (!step.allFinite() || solution.dot(matrix * solution) < at_rest_sigmas * at_rest_sigmas) break;
      const double turn = step.head<3>().norm();
      if (turn > most_turn_rad) step *= most_turn_rad / turn;
      pose = within_lens(moved(pose, step), lens);
    }
  }
  PhotoShading finest(mesh, coarse_to_fine.back());
  const auto before = finest.fit(start.pose);
  const auto after = finest.fit(result.refined.pose);
  if (!before || !after) return std::nullopt;
  result.before = *before;
  result.after = *after;
  return result;
}

}  // namespace drape::alignment
