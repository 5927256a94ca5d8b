#include "peers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <opencv2/core/optim.hpp>

#include "drape/metrics/camera_error.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/rendering/stencil_renderer.hpp"
#include "models.hpp"

namespace drape::lab {
namespace {

constexpr int compared_px = 256;
constexpr int parameters = 7;  // rotation, place in the picture, distance, focal length
constexpr int most_restarts = 4;
constexpr int evaluations_a_start = 400;
constexpr double least_gain = 1e-4;
// First steps of the simplex: radians, shares of the picture, logarithms.
constexpr std::array<double, parameters> first_step = {0.1, 0.1, 0.1, 0.03, 0.03, 0.05, 0.1};

using Objective = std::function<double(const Camera&)>;  // more is better

// The start, with square pixels, moved by the parameters; the object turns about its own centre.
class MovedCamera {
 public:
  MovedCamera(const Camera& start, const Eigen::Vector3d& object_center)
      : start_(start), center_(object_center) {
    const double focal = metrics::focal_px(start);
    start_.K(0, 0) = start_.K(1, 1) = focal;
  }

  [[nodiscard]] Camera at(const double* x) const {
    Camera camera = start_;
    const double focal = start_.K(0, 0) * std::exp(x[6]);
    camera.K(0, 0) = camera.K(1, 1) = focal;
    const Eigen::Vector3d turn(x[0], x[1], x[2]);
    const Eigen::Vector3d center = start_.camera_from_world * center_;
    const Eigen::Vector2d pixel = start_.project(center_).pixel + start_.width * Eigen::Vector2d(x[3], x[4]);
    // The distance follows the focal length, so that the size stays.
    const double depth = center.z() * std::exp(x[5] + x[6]);
    const Eigen::Vector3d place = depth * (camera.K.inverse() * pixel.homogeneous());
    camera.camera_from_world.linear() =
        Eigen::AngleAxisd(turn.norm(),
                          turn.norm() > 0 ? Eigen::Vector3d(turn.normalized()) : Eigen::Vector3d::UnitX()) *
        start_.camera_from_world.linear();
    camera.camera_from_world.translation() = place - camera.camera_from_world.linear() * center_;
    return camera;
  }

 private:
  Camera start_;
  Eigen::Vector3d center_;
};

class SimplexFunction : public cv::MinProblemSolver::Function {
 public:
  SimplexFunction(const MovedCamera& camera, const Objective& objective, int& evaluations)
      : camera_(camera), objective_(objective), evaluations_(evaluations) {}
  [[nodiscard]] int getDims() const override { return parameters; }
  double calc(const double* x) const override {
    ++evaluations_;
    return -objective_(camera_.at(x));
  }

 private:
  const MovedCamera& camera_;
  const Objective& objective_;
  int& evaluations_;
};

Refined refined(const Camera& start, const Eigen::Vector3d& center, const Objective& objective) {
  Refined result{start, objective(start), 1};
  for (int restart = 0; restart < most_restarts; ++restart) {
    const MovedCamera moved(result.camera, center);
    cv::Mat at = cv::Mat::zeros(1, parameters, CV_64F);
    const cv::Mat step(1, parameters, CV_64F, const_cast<double*>(first_step.data()));
    const auto solver = cv::DownhillSolver::create(
        cv::Ptr<SimplexFunction>(std::make_shared<SimplexFunction>(moved, objective, result.evaluations)),
        step,
        cv::TermCriteria(cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, evaluations_a_start, 1e-6));
    const double value = -solver->minimize(at);
    const double gain = value - result.objective;
    if (gain > 0) {
      result.camera = moved.at(at.ptr<double>());
      result.objective = value;
    }
    if (gain < least_gain * std::abs(value)) break;
  }
  return result;
}

Image8 shrunk(const Image8& image) {
  Image8 small(compared_px, compared_px * image.height() / image.width(), image.channels());
  for (int y = 0; y < small.height(); ++y)
    for (int x = 0; x < small.width(); ++x)
      for (int k = 0; k < image.channels(); ++k)
        small.at(x, y, k) = image.at((2 * x + 1) * image.width() / (2 * small.width()),
                                     (2 * y + 1) * image.height() / (2 * small.height()), k);
  return small;
}

double mutual_information(const std::vector<int>& joint, int rows, int columns) {
  std::vector<double> row(static_cast<std::size_t>(rows), 0);
  std::vector<double> column(static_cast<std::size_t>(columns), 0);
  double total = 0;
  for (std::size_t i = 0; i < joint.size(); ++i) {
    row[i / static_cast<std::size_t>(columns)] += joint[i];
    column[i % static_cast<std::size_t>(columns)] += joint[i];
    total += joint[i];
  }
  double sum = 0;
  for (std::size_t i = 0; i < joint.size(); ++i)
    if (joint[i] > 0)
      sum += joint[i] / total *
             std::log(joint[i] * total /
                      (row[i / static_cast<std::size_t>(columns)] *
                       column[i % static_cast<std::size_t>(columns)]));
  return sum;
}

constexpr int normal_bins = 8;  // a side
constexpr int background_bin = normal_bins * normal_bins;
constexpr int brightness_bins = 32;

int normal_bin(const Eigen::Vector3d& normal) {
  const auto bin = [](double value) {
    return std::clamp(static_cast<int>((value + 1) / 2 * normal_bins), 0, normal_bins - 1);
  };
  return bin(normal.y()) * normal_bins + bin(normal.x());
}

}  // namespace

Refined refined_by_xor(const TriangleMesh& mesh, const Image8& stencil, const Camera& start) {
  const Image8 small = shrunk(stencil);
  rendering::StencilRenderer renderer(mesh, small.width(), small.height());
  const Objective same = [&](const Camera& camera) {
    const Image8& drawn = renderer.draw(camera.resized(small.width(), small.height()));
    int differ = 0;
    for (std::size_t i = 0; i < small.data().size(); ++i) differ += drawn.data()[i] != small.data()[i];
    return 1 - static_cast<double>(differ) / static_cast<double>(small.data().size());
  };
  return refined(start, ball_about(mesh).center, same);
}

Refined refined_by_mutual_information(const TriangleMesh& mesh, const Image8& photo, const Camera& start) {
  const Image8 small = shrunk(photo);
  rendering::Renderer renderer(mesh);
  const Objective information = [&](const Camera& camera) {
    const Camera view = camera.resized(small.width(), small.height());
    const rendering::DepthMap seen = renderer.depth_map(view);
    std::vector<int> bins(mesh.faces.size(), -1);
    std::vector<int> joint((background_bin + 1) * brightness_bins, 0);
    for (int y = 0; y < small.height(); ++y)
      for (int x = 0; x < small.width(); ++x) {
        const std::int32_t face = seen.faces.at(x, y);
        int row = background_bin;
        if (face != rendering::DepthMap::no_face) {
          int& bin = bins[static_cast<std::size_t>(face)];
          if (bin < 0) {
            Eigen::Vector3d normal = view.camera_from_world.linear() *
                                     scaled_face_normal(mesh, static_cast<std::size_t>(face)).normalized();
            if (normal.z() > 0) normal = -normal;
            bin = normal_bin(normal);
          }
          row = bin;
        }
        const int grey = (small.at(x, y, 0) + small.at(x, y, 1) + small.at(x, y, 2)) / 3;
        ++joint[static_cast<std::size_t>(row * brightness_bins + grey * brightness_bins / 256)];
      }
    return mutual_information(joint, background_bin + 1, brightness_bins);
  };
  return refined(start, ball_about(mesh).center, information);
}

}  // namespace drape::lab
