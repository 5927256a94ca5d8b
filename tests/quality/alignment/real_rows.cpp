#include "real_rows.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/metrics/reprojection_error.hpp"
#include "drape/rendering/renderer.hpp"
#include "program_arguments.hpp"
#include "real_photos.hpp"
#include "trials.hpp"
#include "visual_hull.hpp"

namespace drape::lab {
namespace {

using alignment::Verdict;

// A pose of a real photo is right within these.
constexpr double most_deg = 12;
constexpr double most_size_share = 0.06;  // of the object's extent in the photo, in the mean over its points

struct RealTrial {
  std::string name;
  double px = 0;  // mean distance of the mesh's vertices in the two pictures
  double about_ray_deg = 0;
  double focal_percent = 0;
  bool right = false;
  Verdict verdict = Verdict::reject;
  std::string reason;
  double cpu_seconds = 0;
};

double extent_px(const TriangleMesh& mesh, const Camera& camera) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& x : mesh.vertices) box.extend(camera.project(x).pixel);
  return box.sizes().maxCoeff();
}

RealTrial align_real(const std::string& name, const TriangleMesh& mesh, const Camera& truth,
                     const Image8& stencil, const Image8& photo, const alignment::AlignOptions& options) {
  RealTrial trial;
  trial.name = name;
  const double before = test::cpu_seconds();
  const alignment::Alignment found =
      alignment::align_photo(mesh, {stencil, std::nullopt, &photo}, options, 1, {});
  trial.cpu_seconds = test::cpu_seconds() - before;
  trial.verdict = found.verdict;
  if (!found.reasons.empty()) trial.reason = found.reasons.front();
  if (found.candidates.empty()) {
    trial.about_ray_deg = 180;
    return trial;
  }
  const metrics::CameraError error = metrics::camera_error(found.camera, truth, ball_about(mesh).center);
  trial.px = metrics::reprojection_error(mesh.vertices, found.camera, truth).distance_px.mean;
  trial.about_ray_deg = error.rotation_about_ray_deg;
  trial.focal_percent = error.focal_percent.value_or(0);
  trial.right =
      error.rotation_about_ray_deg < most_deg && trial.px < most_size_share * extent_px(mesh, truth);
  fmt::print(
      "{:12} {:8.2f} px {:8.2f} deg about the ray, focal length {:+6.1f} %, {:5} {:6} {:.2f} CPU s: {}\n",
      name, trial.px, trial.about_ray_deg, trial.focal_percent, trial.right ? "right" : "wrong",
      verdict_name(trial.verdict), trial.cpu_seconds, trial.reason);
  std::fflush(stdout);
  return trial;
}

nlohmann::json summarised(const std::string& what, const std::vector<RealTrial>& trials) {
  nlohmann::json json;
  std::vector<double> px;
  int wrong_accepted = 0;
  int right_accepted = 0;
  for (const RealTrial& trial : trials) {
    json["photos"].push_back({{"name", trial.name},
                              {"px", trial.px},
                              {"rotation_about_ray_deg", trial.about_ray_deg},
                              {"focal_error_percent", trial.focal_percent},
                              {"right", trial.right},
                              {"verdict", verdict_name(trial.verdict)}});
    if (trial.right) px.push_back(trial.px);
    (trial.right ? right_accepted : wrong_accepted) += trial.verdict == Verdict::accept;
  }
  const metrics::Distribution right = metrics::distribution(px);
  fmt::print(
      "{}: {} of {} right, {} of them accepted; of the right ones {:.2f} px in the mean, {:.2f} in the "
      "median; "
      "{} wrong and accepted\n",
      what, right.count, trials.size(), right_accepted, right.mean, right.median, wrong_accepted);
  json["right"] = right.count;
  json["of"] = trials.size();
  json["right_accepted"] = right_accepted;
  json["wrong_accepted"] = wrong_accepted;
  json["mean_px_of_right"] = right.mean;
  return json;
}

}  // namespace

nlohmann::json measure_lmo(const alignment::AlignOptions& options) {
  std::vector<RealTrial> trials;
  for (const PosedPhoto& posed : posed_photos("lmo")) {
    if (posed.mesh.empty()) continue;
    const TriangleMesh mesh = io::read_mesh(posed.mesh);
    const Image8 stencil = rendering::Renderer(mesh).stencil(posed.truth);
    trials.push_back(
        align_real(posed.name, mesh, posed.truth, stencil, io::read_photo(posed.image).rgb, options));
  }
  if (trials.empty()) return fmt::print("lmo skipped: needs photos/lmo of DRAPE_TEST_DATA\n"), nullptr;
  return summarised("lmo", trials);
}

nlohmann::json measure_dino(const alignment::AlignOptions& options) {
  const std::vector<PosedPhoto> photos = posed_photos("dino");
  if (photos.empty()) return fmt::print("dino skipped: needs photos/dino of DRAPE_TEST_DATA\n"), nullptr;
  std::vector<Outline> outlines;
  for (std::size_t i = 0; i < photos.size(); i += 2)
    outlines.push_back({photos[i].truth, dino_stencil(io::read_photo(photos[i].image).rgb)});
  // Of the object, as published, and a little around it.
  const BoundingBox box(Eigen::Vector3d(-0.046, -0.003, -0.042), Eigen::Vector3d(0.035, 0.092, 0.040));
  const TriangleMesh hull = visual_hull(outlines, box, 0.0006);
  fmt::print("dino: a hull of {} faces from {} photos\n", hull.faces.size(), outlines.size());
  std::vector<RealTrial> trials;
  for (std::size_t i = 1; i < photos.size(); i += 2) {
    const Image8 rgb = io::read_photo(photos[i].image).rgb;
    trials.push_back(align_real(photos[i].name, hull, photos[i].truth, dino_stencil(rgb), rgb, options));
  }
  return summarised("dino, one by one", trials);
}

}  // namespace drape::lab
