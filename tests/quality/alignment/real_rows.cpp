#include "real_rows.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "drape/alignment/align_block.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/metrics/reprojection_error.hpp"
#include "drape/rendering/renderer.hpp"
#include "models.hpp"
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

// What came of a photo, against its true camera.
RealTrial judged_trial(const std::string& name, const TriangleMesh& mesh, const Camera& truth,
                       const alignment::Alignment& found, double cpu_seconds) {
  RealTrial trial;
  trial.name = name;
  trial.cpu_seconds = cpu_seconds;
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
  return trial;
}

void print(const RealTrial& trial) {
  fmt::print(
      "{:12} {:8.2f} px {:8.2f} deg about the ray, focal length {:+6.1f} %, {:5} {:6} {:.2f} CPU s: {}\n",
      trial.name, trial.px, trial.about_ray_deg, trial.focal_percent, trial.right ? "right" : "wrong",
      verdict_name(trial.verdict), trial.cpu_seconds, trial.reason);
  std::fflush(stdout);
}

RealTrial align_real(const std::string& name, const TriangleMesh& mesh, const Camera& truth,
                     const Image8& stencil, const Image8& photo, const alignment::AlignOptions& options) {
  const double before = test::cpu_seconds();
  const alignment::Alignment found =
      alignment::align_photo(mesh, {stencil, std::nullopt, &photo}, options, 1, {});
  RealTrial trial = judged_trial(name, mesh, truth, found, test::cpu_seconds() - before);
  print(trial);
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

namespace {

/// A hull of every second photo, and the others.
struct Dino {
  TriangleMesh hull;
  std::vector<PosedPhoto> photos;
  std::vector<Image8> rgbs;
  std::vector<Image8> stencils;
};

Dino make_dino(const std::vector<PosedPhoto>& photos) {
  Dino dino;
  std::vector<Outline> outlines;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    Image8 rgb = io::read_photo(photos[i].image).rgb;
    Image8 stencil = dino_stencil(rgb);
    if (i % 2 == 0) {
      outlines.push_back({photos[i].truth, std::move(stencil)});
      continue;
    }
    dino.photos.push_back(photos[i]);
    dino.rgbs.push_back(std::move(rgb));
    dino.stencils.push_back(std::move(stencil));
  }
  dino.hull = dino_hull(outlines);
  fmt::print("dino: a hull of {} faces from {} photos\n", dino.hull.faces.size(), outlines.size());
  return dino;
}

// Any frame and unit, as a photogrammetry program's.
alignment::Similarity some_block() {
  return {
      7.5, Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(), {30, -4, 12}};
}

// Blocks of `size` photos from all round; each photo is in one of them.
std::vector<RealTrial> align_blocks(const Dino& dino, const TriangleMesh& mesh, std::size_t size,
                                    const alignment::AlignOptions& options) {
  std::vector<RealTrial> trials;
  const std::size_t blocks = dino.photos.size() / size;
  const alignment::Similarity block_from_world = some_block();
  for (std::size_t b = 0; b < blocks; ++b) {
    std::vector<alignment::BlockPhoto> members;
    std::vector<std::size_t> indices;
    for (std::size_t k = 0; k < size; ++k) {
      const std::size_t i = b + k * blocks;
      const Camera& truth = dino.photos[i].truth;
      alignment::PhotoEvidence evidence{dino.stencils[i], std::nullopt, &dino.rgbs[i]};
      evidence.lens = alignment::KnownLens{truth.K, {}};
      Rigid3 camera_from_block = Rigid3::Identity();
      camera_from_block.linear() = truth.camera_from_world.linear() * block_from_world.rotation.transpose();
      camera_from_block.translation() = block_from_world.scale * truth.camera_from_world.translation() -
                                        camera_from_block.linear() * block_from_world.translation;
      members.push_back({evidence, camera_from_block});
      indices.push_back(i);
    }
    const double before = test::cpu_seconds();
    const alignment::BlockAlignment found = alignment::align_block(mesh, members, options, 1, {});
    const double seconds = (test::cpu_seconds() - before) / static_cast<double>(size);
    for (std::size_t k = 0; k < size; ++k)
      trials.push_back(judged_trial(dino.photos[indices[k]].name, dino.hull, dino.photos[indices[k]].truth,
                                    found.photos[k], seconds));
    const RealTrial& first = trials[trials.size() - size];
    fmt::print("block of {}: {} {:8.2f} px {:8.2f} deg, {:5} {:6} {:.2f} CPU s a photo: {}\n", size,
               first.name, first.px, first.about_ray_deg, first.right ? "right" : "wrong",
               verdict_name(found.verdict), seconds, first.reason);
  }
  return trials;
}

}  // namespace

nlohmann::json measure_dino(const alignment::AlignOptions& options) {
  const std::vector<PosedPhoto> photos = posed_photos("dino");
  if (photos.empty()) return fmt::print("dino skipped: needs photos/dino of DRAPE_TEST_DATA\n"), nullptr;
  const Dino dino = make_dino(photos);
  nlohmann::json json;
  std::vector<RealTrial> alone;
  for (std::size_t i = 0; i < dino.photos.size(); ++i)
    alone.push_back(align_real(dino.photos[i].name, dino.hull, dino.photos[i].truth, dino.stencils[i],
                               dino.rgbs[i], options));
  json["one by one"] = summarised("dino, one by one", alone);
  for (const std::size_t size : {2, 4, 6}) {
    const std::string name = fmt::format("dino, blocks of {}", size);
    json[name] = summarised(name, align_blocks(dino, dino.hull, size, options));
  }
  // Of objects that the photos do not show no pose is right.
  int accepted = 0;
  std::size_t photos_of_others = 0;
  for (const std::string mesh : {"teapot.obj", "fandisk.obj", "rocker-arm.obj"}) {
    const std::optional<Model> other = load_model(mesh);
    if (!other) continue;
    for (const RealTrial& trial : align_blocks(dino, other->scanned, 4, options)) {
      accepted += trial.verdict == Verdict::accept;
      ++photos_of_others;
    }
  }
  fmt::print("dino, blocks of 4 with other objects: {} of {} photos accepted\n", accepted, photos_of_others);
  json["blocks of other objects"] = {{"accepted", accepted}, {"of", photos_of_others}};
  return json;
}

}  // namespace drape::lab
