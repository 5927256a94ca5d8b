#include "photo_agreement.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "linear_light.hpp"

namespace drape::texturing {
namespace {

constexpr int most_side = 1400;  // of the pictures that are compared
constexpr std::size_t most_points = 30000;
constexpr std::array<double, 3> blurs_px = {3, 1.5, 0.8};
constexpr int most_turns = 8;  // at each blur
constexpr double settled_px = 0.02;
constexpr double negligible_px = 0.12;   // photos this close need no other cameras
constexpr double least_cosine = 0.3;     // flatter sight is too coarse to compare
constexpr int border_px = 4;             // inside the stencil and away from edges in depth
constexpr double correlated_points = 4;  // neighbouring points see the same errors
constexpr std::size_t least_shared = 200;
constexpr std::size_t points_per_chunk = 1024;

struct SurfacePoint {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
};

// Evenly by area, in the order of the faces: systematic sampling.
std::vector<SurfacePoint> spread_points(const TriangleMesh& mesh) {
  std::vector<SurfacePoint> points;
  const double spacing = surface_area(mesh) / static_cast<double>(most_points);
  double next = spacing / 2;
  double area = 0;
  // Halton's second base spreads the points within faces that carry several.
  std::uint32_t count = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Eigen::Vector3d scaled = scaled_face_normal(mesh, f);
    area += scaled.norm() / 2;
    for (; next < area; next += spacing) {
      double u = std::fmod(0.5 + 0.7548776662466927 * ++count, 1.0);
      double v = std::fmod(0.5 + 0.5698402909980532 * count, 1.0);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const Face& face = mesh.faces[f];
      const Eigen::Vector3d& a = mesh.vertices[face[0]];
      points.push_back({a + u * (mesh.vertices[face[1]] - a) + v * (mesh.vertices[face[2]] - a),
                        scaled.stableNormalized()});
    }
  }
  return points;
}

// Log of the luminance at one blur.
class Picture {
 public:
  Picture() = default;
  Picture(const cv::Mat& log_light, double blur_px) { cv::GaussianBlur(log_light, values_, {}, blur_px); }
  /// Value and slopes: differences of neighbours, as few places ask for them.
  [[nodiscard]] Eigen::Vector3f at(const Eigen::Vector2d& pixel) const {
    const double px = std::clamp(pixel.x() - 0.5, 0.0, values_.cols - 1.001);
    const double py = std::clamp(pixel.y() - 0.5, 0.0, values_.rows - 1.001);
    const int x = static_cast<int>(px);
    const int y = static_cast<int>(py);
    const auto fx = static_cast<float>(px - x);
    const auto fy = static_cast<float>(py - y);
    const auto light = [&](int column, int row) {
      return values_.at<float>(std::clamp(row, 0, values_.rows - 1), std::clamp(column, 0, values_.cols - 1));
    };
    const auto value = [&](int column, int row) {
      return Eigen::Vector3f(light(column, row), (light(column + 1, row) - light(column - 1, row)) / 2,
                             (light(column, row + 1) - light(column, row - 1)) / 2);
    };
    return (1 - fy) * ((1 - fx) * value(x, y) + fx * value(x + 1, y)) +
           fy * ((1 - fx) * value(x, y + 1) + fx * value(x + 1, y + 1));
  }

 private:
  cv::Mat values_;
};

cv::Mat log_light_of(const Image8& rgb, int width, int height) {
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = linear_from_byte(static_cast<std::uint8_t>(i));
  cv::Mat light(rgb.height(), rgb.width(), CV_32F);
  for (int y = 0; y < rgb.height(); ++y)
    for (int x = 0; x < rgb.width(); ++x)
      light.at<float>(y, x) =
          (linear[rgb.at(x, y, 0)] + 2 * linear[rgb.at(x, y, 1)] + linear[rgb.at(x, y, 2)]) / 4;
  if (light.cols != width) cv::resize(light, light, {width, height}, 0, 0, cv::INTER_AREA);
  // The floor keeps the noise of dark colours small.
  light += 0.02F;
  cv::log(light, light);
  return light;
}

// Where a photo's pixels can be compared: well inside the stencil, and of a depth without steps.
class Comparable {
 public:
  Comparable(const AgreementView& view, int width, int height)
      : scale_x_(static_cast<double>(width) / view.camera.width),
        scale_y_(static_cast<double>(height) / view.camera.height),
        inside_(height, width, CV_8U, cv::Scalar(255)) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (!view.stencil.empty() &&
            view.stencil.at(std::min(static_cast<int>((x + 0.5) / scale_x_), view.camera.width - 1),
                            std::min(static_cast<int>((y + 0.5) / scale_y_), view.camera.height - 1)) !=
                stencil::object)
          inside_.at<std::uint8_t>(y, x) = 0;
    const cv::Mat round =
        cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * border_px + 1, 2 * border_px + 1});
    cv::erode(inside_, inside_, round, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  }
  [[nodiscard]] bool at(const Eigen::Vector2d& pixel) const {
    const int x = static_cast<int>(pixel.x() * scale_x_);
    const int y = static_cast<int>(pixel.y() * scale_y_);
    return pixel.x() >= 0 && pixel.y() >= 0 && x < inside_.cols && y < inside_.rows &&
           inside_.at<std::uint8_t>(y, x) != 0;
  }

 private:
  double scale_x_;
  double scale_y_;
  cv::Mat inside_;
};

// Whether the depth picture shows the point's own surface all round it.
bool in_plain_sight(const AgreementView& view, const SurfacePoint& p, double tolerance) {
  if (!(p.normal.dot(view.camera.towards_camera(p.point)) > least_cosine)) return false;
  const Camera::Projected seen = view.camera.project(p.point);
  if (view.camera.projection == Camera::Projection::perspective && !(seen.depth > 0)) return false;
  const double scale_x = static_cast<double>(view.depth.width()) / view.camera.width;
  const double scale_y = static_cast<double>(view.depth.height()) / view.camera.height;
  const double reach = border_px * std::max(1.0, view.depth.width() / static_cast<double>(most_side));
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const double px = seen.pixel.x() * scale_x + dx * reach;
      const double py = seen.pixel.y() * scale_y + dy * reach;
      if (!(px >= 0 && py >= 0 && px < view.depth.width() && py < view.depth.height())) return false;
      const double depth = view.depth.at(static_cast<int>(px), static_cast<int>(py));
      if (!(std::abs(depth - seen.depth) < tolerance)) return false;
    }
  return true;
}

// The points that a photo can say something about.
struct Sightings {
  std::vector<std::vector<std::uint32_t>> of_view;
  std::vector<std::uint8_t> counts;  // of views, per point
};

Sightings sightings_of(const std::vector<SurfacePoint>& points, std::span<const AgreementView> views,
                       double extent) {
  Sightings out;
  out.counts.assign(points.size(), 0);
  for (const AgreementView& view : views) {
    const double factor =
        std::min(1.0, static_cast<double>(most_side) / std::max(view.camera.width, view.camera.height));
    const Comparable comparable(view, std::max(1, static_cast<int>(view.camera.width * factor)),
                                std::max(1, static_cast<int>(view.camera.height * factor)));
    std::vector<std::uint8_t> seen(points.size(), 0);
    parallel_for(points.size(), points_per_chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        seen[i] = in_plain_sight(view, points[i], 0.02 * extent) &&
                  comparable.at(view.camera.project(points[i].point).pixel);
    });
    auto& list = out.of_view.emplace_back();
    for (std::uint32_t i = 0; i < points.size(); ++i)
      if (seen[i] != 0) {
        list.push_back(i);
        ++out.counts[i];
      }
  }
  for (auto& list : out.of_view) std::erase_if(list, [&](std::uint32_t i) { return out.counts[i] < 2; });
  return out;
}

// One photo on its way.
struct Moving {
  Camera camera;  // of the reduced picture
  Camera given;
  std::vector<Eigen::Vector3f> samples;  // value and slopes, of its sightings
  double exposure = 0;
  PoseStep total = PoseStep::Zero();  // of the steps so far
};

float median_of(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class Agreement {
 public:
  Agreement(const std::vector<SurfacePoint>& points, std::span<const AgreementView> views,
            const Sightings& sightings, const Eigen::Vector3d& middle)
      : points_(points), views_(views), sightings_(sightings), middle_(middle) {
    for (const AgreementView& view : views) {
      const double factor =
          std::min(1.0, static_cast<double>(most_side) / std::max(view.camera.width, view.camera.height));
      Moving m;
      m.given = factor == 1 ? view.camera
                            : view.camera.resized(std::max(1, static_cast<int>(view.camera.width * factor)),
                                                  std::max(1, static_cast<int>(view.camera.height * factor)));
      m.camera = m.given;
      moving_.push_back(std::move(m));
    }
    lights_.resize(views.size());
    parallel_for(views.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        lights_[v] = log_light_of(views[v].rgb, moving_[v].given.width, moving_[v].given.height);
    });
  }

  // The typical difference before and after, at the finest blur.
  std::pair<double, double> run(const Progress& progress) {
    set_blur(blurs_px.back());
    sample();
    const double before = typical_difference();
    const std::vector<Moving> given = moving_;
    if (step() < negligible_px) return {before, before};
    moving_ = given;
    for (std::size_t level = 0; level < blurs_px.size(); ++level) {
      set_blur(blurs_px[level]);
      for (int turn = 0; turn < most_turns; ++turn) {
        progress.update(
            (static_cast<double>(level) + turn / static_cast<double>(most_turns)) / blurs_px.size(),
            "making the photos agree");
        sample();
        if (step() < settled_px) break;
      }
    }
    sample();
    return {before, typical_difference()};
  }

  [[nodiscard]] const std::vector<Moving>& moving() const { return moving_; }
  [[nodiscard]] double moved_px(std::size_t v) const {
    std::vector<float> shifts;
    for (const std::uint32_t i : sightings_.of_view[v])
      shifts.push_back(static_cast<float>((moving_[v].camera.project(points_[i].point).pixel -
                                           moving_[v].given.project(points_[i].point).pixel)
                                              .norm()));
    const double enlarged = static_cast<double>(views_[v].camera.width) / moving_[v].given.width;
    return shifts.empty() ? 0 : enlarged * median_of(std::move(shifts));
  }

 private:
  void set_blur(double blur_px) {
    pictures_.resize(lights_.size());
    parallel_for(lights_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) pictures_[v] = Picture(lights_[v], blur_px);
    });
  }

  void sample() {
    for (std::size_t v = 0; v < moving_.size(); ++v) {
      Moving& m = moving_[v];
      const auto& list = sightings_.of_view[v];
      m.samples.resize(list.size());
      parallel_for(list.size(), points_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          m.samples[k] = pictures_[v].at(m.camera.project(points_[list[k]].point).pixel);
      });
    }
    match_exposures();
    means_.assign(points_.size(), Eigen::Vector2f::Zero());
    for (std::size_t v = 0; v < moving_.size(); ++v)
      for (std::size_t k = 0; k < moving_[v].samples.size(); ++k)
        means_[sightings_.of_view[v][k]] +=
            Eigen::Vector2f(moving_[v].samples[k][0] + static_cast<float>(moving_[v].exposure), 1);
    for (Eigen::Vector2f& m : means_)
      if (m[1] > 0) m[0] /= m[1];
  }

  // In turns with the means: a few rounds are enough, as they start from the last ones.
  void match_exposures() {
    for (int round = 0; round < 4; ++round) {
      std::vector<Eigen::Vector2d> sums(points_.size(), Eigen::Vector2d::Zero());
      for (std::size_t v = 0; v < moving_.size(); ++v)
        for (std::size_t k = 0; k < moving_[v].samples.size(); ++k)
          sums[sightings_.of_view[v][k]] +=
              Eigen::Vector2d(moving_[v].samples[k][0] + moving_[v].exposure, 1);
      for (std::size_t v = 0; v < moving_.size(); ++v) {
        std::vector<float> differences;
        for (std::size_t k = 0; k < moving_[v].samples.size(); ++k) {
          const Eigen::Vector2d& s = sums[sightings_.of_view[v][k]];
          differences.push_back(static_cast<float>(s[0] / s[1]) - moving_[v].samples[k][0]);
        }
        if (!differences.empty()) moving_[v].exposure = median_of(std::move(differences));
      }
    }
  }

  [[nodiscard]] float difference(std::size_t v, std::size_t k) const {
    return means_[sightings_.of_view[v][k]][0] - static_cast<float>(moving_[v].exposure) -
           moving_[v].samples[k][0];
  }

  [[nodiscard]] double typical_difference() const {
    std::vector<float> all;
    for (std::size_t v = 0; v < moving_.size(); ++v)
      for (std::size_t k = 0; k < moving_[v].samples.size(); ++k) all.push_back(std::abs(difference(v, k)));
    return all.empty() ? 0 : 1.4826 * median_of(std::move(all));
  }

  // Moves every camera that shares enough with others; returns the most that one moved, typically.
  double step() {
    const double sigma = std::max(0.01, typical_difference());
    double most = 0;
    for (std::size_t v = 0; v < moving_.size(); ++v) {
      Moving& m = moving_[v];
      const auto& list = sightings_.of_view[v];
      if (list.size() < least_shared) continue;
      const PoseFrame frame(m.camera, middle_);
      PoseMatrix normal = PoseMatrix::Zero();
      PoseStep right = PoseStep::Zero();
      for (std::size_t k = 0; k < list.size(); ++k) {
        const double miss = difference(v, k) / sigma;
        const double trust = 1 / (1 + miss * miss / 4);
        const double weight = trust * trust / (sigma * sigma * correlated_points);
        const PoseStep row =
            frame.jacobian(points_[list[k]].point).transpose() * m.samples[k].tail<2>().cast<double>();
        normal.noalias() += weight * row * row.transpose();
        right += weight * difference(v, k) * row;
      }
      // Steps as small as these add up.
      const PoseMatrix hold = views_[v].hold + prior_on_steps();
      right -= hold * m.total;
      const PoseStep step = (normal + hold).ldlt().solve(right);
      m.total += step;
      const Camera next = frame.moved(step);
      std::vector<float> shifts;
      for (const std::uint32_t i : list)
        shifts.push_back(static_cast<float>(
            (next.project(points_[i].point).pixel - m.camera.project(points_[i].point).pixel).norm()));
      most = std::max<double>(most, median_of(std::move(shifts)));
      m.camera = next;
    }
    return most;
  }

  const std::vector<SurfacePoint>& points_;
  std::span<const AgreementView> views_;
  const Sightings& sightings_;
  Eigen::Vector3d middle_;
  std::vector<Moving> moving_;
  std::vector<cv::Mat> lights_;
  std::vector<Picture> pictures_;
  std::vector<Eigen::Vector2f> means_;  // log light of the points and how many photos it is from
};

}  // namespace

AgreeingCameras agreeing_cameras(const TriangleMesh& mesh, std::span<const AgreementView> views,
                                 double most_px, const Progress& progress) {
  AgreeingCameras out;
  for (const AgreementView& view : views) out.cameras.push_back(view.camera);
  out.moved_px.assign(views.size(), 0);
  if (views.size() < 2 || most_px <= 0) return out;
  const Eigen::AlignedBox3d box = bounding_box(mesh.vertices);
  const std::vector<SurfacePoint> points = spread_points(mesh);
  const Sightings sightings = sightings_of(points, views, box.diagonal().norm());
  Agreement agreement(points, views, sightings, box.center());
  const auto [before, after] = agreement.run(progress);
  constexpr double worth_it = 0.97;  // of the difference before
  if (!(after < worth_it * before)) return out;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const double moved = agreement.moved_px(v);
    if (moved > most_px) continue;
    const Camera& found = agreement.moving()[v].camera;
    out.moved_px[v] = moved;
    out.cameras[v] = found.width == views[v].camera.width
                         ? found
                         : found.resized(views[v].camera.width, views[v].camera.height);
  }
  return out;
}

}  // namespace drape::texturing
