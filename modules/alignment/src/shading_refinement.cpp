#include "shading_refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace drape::alignment {
namespace {

constexpr int terms = 16;  // spherical harmonics to the third order
constexpr int least_pixels = 200;
constexpr double least_sigma = 0.004;  // of brightness: what eight bits leave
constexpr double kernel_deviations = 3;
constexpr int reweightings = 3;
constexpr double ridge = 1e-4;  // per pixel, of the light's coefficients
// Of the differences, at the body's rim. Where an edge moves, a step goes no further than that: from far to
// near.
constexpr std::array<double, 4> coarse_steps_px = {3, 2, 1.5, 1};
constexpr std::array<double, 4> fine_steps_px = {2, 1.5, 1, 1};
// Light that no harmonics describe, gloss and shadows go with the shape: more samples do not make them
// smaller.
constexpr double most_independent = 300;
constexpr int most_lag = 16;
constexpr double faded = 0.1;
constexpr double most_turn_rad = 0.05;

using Harmonics = Eigen::Matrix<double, terms, 1>;

Harmonics harmonics(const Eigen::Vector3f& normal) {
  const double x = normal.x();
  const double y = normal.y();
  const double z = normal.z();
  Harmonics h;
  h << 1, x, y, z, x * y, y * z, z * x, x * x - y * y, 3 * z * z - 1, y * (3 * x * x - y * y), x * y * z,
      y * (5 * z * z - 1), z * (5 * z * z - 3), x * (5 * z * z - 1), z * (x * x - y * y),
      x * (x * x - 3 * y * y);
  return h;
}

// The change of each free direction that moves a point at the body's rim by so much.
Eigen::VectorXd steps_of(const Eigen::MatrixXd& directions, const OutlinePose& pose, const Window& window,
                         double step_px) {
  const double px = step_px / window.px_per_photo_px;
  Eigen::VectorXd steps(directions.cols());
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    int row = 0;
    directions.col(k).cwiseAbs().maxCoeff(&row);
    steps[k] = row < 3 || row == 6 ? px / pose.scale : px;
  }
  return steps;
}

double sigma_of(const std::vector<double>& residuals) {
  std::vector<double> sorted;
  sorted.reserve(residuals.size());
  for (const double r : residuals) sorted.push_back(std::abs(r));
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return std::max(least_sigma, 1.4826 * *middle);
}

}  // namespace

struct PhotoShading::Light {
  std::vector<std::size_t> pixels;  // that are seen and count
  std::vector<Harmonics> looks;     // of each: the harmonics times the scan's brightness
  std::vector<double> residuals;
  std::vector<double> weights;
  Harmonics coefficients = Harmonics::Zero();
  Eigen::Matrix<double, terms, terms> matrix;
  double sigma = 0;
  double area = 1;  // of what shares its error, in pixels
  double spread = 0;

  void solve(const std::vector<float>& brightness);
  void find_area(int width);
  [[nodiscard]] ShadingFit fit() const {
    ShadingFit fit;
    fit.sigma = sigma;
    fit.pixels = static_cast<double>(pixels.size());
    fit.independent = std::min(most_independent, fit.pixels / area);
    double left = 0;
    for (const double r : residuals) left += std::min(r * r, 9 * sigma * sigma);
    fit.explained = spread > 0 ? std::clamp(1 - left / spread, 0.0, 1.0) : 0.0;
    return fit;
  }
};

void PhotoShading::Light::solve(const std::vector<float>& brightness) {
  const auto count = static_cast<double>(pixels.size());
  weights.assign(pixels.size(), 1);
  residuals.resize(pixels.size());
  double sum = 0;
  double squares = 0;
  for (const std::size_t p : pixels) {
    sum += static_cast<double>(brightness[p]);
    squares += static_cast<double>(brightness[p]) * static_cast<double>(brightness[p]);
  }
  spread = squares - sum * sum / count;
  for (int round = 0; round <= reweightings; ++round) {
    matrix = Eigen::Matrix<double, terms, terms>::Identity() * (ridge * count);
    matrix(0, 0) = 1e-9 * count;
    Harmonics vector = Harmonics::Zero();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      matrix.selfadjointView<Eigen::Lower>().rankUpdate(looks[i], weights[i]);
      vector += weights[i] * static_cast<double>(brightness[pixels[i]]) * looks[i];
    }
    matrix = Eigen::Matrix<double, terms, terms>(matrix.selfadjointView<Eigen::Lower>());
    coefficients = matrix.ldlt().solve(vector);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      residuals[i] = static_cast<double>(brightness[pixels[i]]) - looks[i].dot(coefficients);
    sigma = sigma_of(residuals);
    const double kernel = kernel_deviations * kernel_deviations * sigma * sigma;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double k = kernel / (kernel + residuals[i] * residuals[i]);
      weights[i] = k * k;
    }
  }
}

// By the autocorrelation along rows and columns, up to where it has faded.
void PhotoShading::Light::find_area(int width) {
  std::vector<std::int32_t> number;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (number.size() <= pixels[i]) number.resize(pixels[i] + 1, -1);
    number[pixels[i]] = static_cast<std::int32_t>(i);
  }
  const auto clipped = [&](std::size_t i) { return std::clamp(residuals[i], -3 * sigma, 3 * sigma); };
  double variance = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) variance += clipped(i) * clipped(i);
  variance /= static_cast<double>(pixels.size());
  area = 1;
  for (const std::size_t stride : {std::size_t{1}, static_cast<std::size_t>(width)}) {
    double length = 1;
    for (int lag = 1; lag <= most_lag; ++lag) {
      double products = 0;
      double count = 0;
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const std::size_t other = pixels[i] + static_cast<std::size_t>(lag) * stride;
        if (other >= number.size() || number[other] < 0) continue;
        products += clipped(i) * clipped(static_cast<std::size_t>(number[other]));
        count += 1;
      }
      const double correlation = count > 0 && variance > 0 ? products / count / variance : 0;
      if (correlation < faded) break;
      length += 2 * correlation;
    }
    area *= length;
  }
}

double ShadingFit::log_likelihood() const {
  return -independent * std::log(sigma);
}

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

bool PhotoShading::fit_light(const OutlinePose& pose, Light& light) {
  drawing_.draw(mesh_, pose, photo_.window);
  const std::vector<SurfacePixel>& view = drawing_.pixels();
  for (std::size_t p = 0; p < view.size(); ++p) {
    if (!view[p].seen || photo_.inside[p] == 0) continue;
    light.pixels.push_back(p);
    light.looks.emplace_back(static_cast<double>(view[p].brightness) * harmonics(view[p].normal));
  }
  if (light.pixels.size() < least_pixels) return false;
  light.solve(photo_.brightness);
  light.find_area(photo_.window.width);
  return true;
}

std::optional<ShadingFit> PhotoShading::fit(const OutlinePose& pose) {
  Light light;
  if (!fit_light(pose, light)) return std::nullopt;
  return light.fit();
}

std::optional<PhotoShading::Equations> PhotoShading::equations(const OutlinePose& pose, const LensPrior& lens,
                                                               const Eigen::MatrixXd& directions,
                                                               double step_px) {
  Light light;
  if (!fit_light(pose, light)) return std::nullopt;
  const Eigen::VectorXd steps = steps_of(directions, pose, photo_.window, step_px);
  const auto count = static_cast<Eigen::Index>(light.pixels.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(count, directions.cols());
  for (Eigen::Index k = 0; k < directions.cols(); ++k)
    for (const double sign : {1.0, -1.0}) {
      const PoseVector step = sign * steps[k] * directions.col(k);
      drawing_.draw(mesh_, within_lens(moved(pose, step), lens), photo_.window);
      const std::vector<SurfacePixel>& view = drawing_.pixels();
      for (Eigen::Index i = 0; i < count; ++i) {
        const auto n = static_cast<std::size_t>(i);
        const SurfacePixel& pixel = view[light.pixels[n]];
        const double value = pixel.seen ? static_cast<double>(pixel.brightness) *
                                              harmonics(pixel.normal).dot(light.coefficients)
                                        : light.looks[n].dot(light.coefficients);
        jacobian(i, k) += sign * value / (2 * steps[k]);
      }
    }
  // The light goes along with the pose: its coefficients are eliminated (Schur's complement).
  Equations result;
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(directions.cols(), terms);
  Harmonics pull = Harmonics::Zero();
  result.matrix = Eigen::MatrixXd::Zero(directions.cols(), directions.cols());
  result.vector = Eigen::VectorXd::Zero(directions.cols());
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Eigen::VectorXd row = jacobian.row(i).transpose();
    const double weight = light.weights[n];
    result.matrix += weight * row * row.transpose();
    mixed += weight * row * light.looks[n].transpose();
    result.vector += weight * light.residuals[n] * row;
    pull += weight * light.residuals[n] * light.looks[n];
  }
  const auto solver = light.matrix.ldlt();
  const double share = light.fit().independent / static_cast<double>(light.pixels.size());
  const double confidence = share / (light.sigma * light.sigma);
  result.vector = confidence * (result.vector - mixed * solver.solve(pull));
  result.matrix = (confidence * (result.matrix - mixed * solver.solve(mixed.transpose()))).eval();
  result.fit = light.fit();
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
    for (const double step_px : level == 0 ? coarse_steps_px : fine_steps_px) {
      const NormalEquations sum = outline.equations(pose);
      const auto light = shading.equations(pose, lens, directions, step_px);
      if (!light || !outline.matched()) return std::nullopt;
      result.refined.pose = pose;
      result.refined.agreement = outline.agreement();
      result.refined.chi_squared = sum.chi_squared;
      result.refined.information = sum.matrix + coordinates * light->matrix * coordinates.transpose();
      result.after = light->fit;
      Eigen::MatrixXd matrix = directions.transpose() * sum.matrix * directions + light->matrix;
      matrix.diagonal() *= 1 + 1e-6;
      const Eigen::VectorXd solution =
          matrix.ldlt().solve(directions.transpose() * sum.vector + light->vector);
      PoseVector step = directions * solution;
      if (!step.allFinite()) break;
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
