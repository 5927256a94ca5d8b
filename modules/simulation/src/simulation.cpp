#include "drape/simulation/simulation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "stanford_files.hpp"
#include "truth_file.hpp"

namespace drape::simulation {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using std::numbers::pi;

// Work items of one seed: scans and photos count up from 0, these from elsewhere.
constexpr std::uint64_t photo_items = 1U << 20U;
constexpr std::uint64_t pose_items = 1U << 21U;
constexpr int jpeg_quality = 92;

double metres_per_unit(const SimulationSpec& spec) {
  return spec.units == FileUnits::millimetres ? 0.001 : 1.0;
}

std::string scan_name(std::size_t i) {
  return fmt::format("{:03}.ply", i);
}
std::string photo_name(std::size_t i) {
  return fmt::format("{:03}.jpg", i);
}
std::string stencil_name(std::size_t i) {
  return fmt::format("{:03}_stencil.png", i);
}

/// Where the scanner stands for each scan, true.
std::vector<Rigid3> scanner_poses(const SimulationSpec& spec, const Vector3d& center) {
  std::vector<Rigid3> poses;
  for (std::size_t round = 0; round < spec.scan_elevations_deg.size(); ++round)
    for (int step = 0; step < spec.turntable_steps; ++step) {
      const double turn = (step + (round % 2 == 0 ? 0.0 : 0.5)) / spec.turntable_steps;
      const double azimuth = 2 * pi * turn - pi / 2;  // from the object's front on
      const double elevation = spec.scan_elevations_deg[round] * pi / 180;
      const Vector3d away(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                          std::sin(elevation));
      const Vector3d right(-std::sin(azimuth), std::cos(azimuth), 0);
      Rigid3 world_from_scanner;
      world_from_scanner.linear() << right, away.cross(right).eval() * -1.0, -away;
      world_from_scanner.translation() = center + spec.distance_m * away;
      poses.push_back(world_from_scanner);
    }
  return poses;
}

/// Half the lattice's extent to each side that the object needs: rows, columns.
Eigen::Vector2d needed_half_extent(const TriangleMesh& mesh, const Rigid3& world_from_scanner, Rays rays) {
  const Rigid3 scanner_from_world = world_from_scanner.inverse();
  Eigen::Vector2d most(0, 0);
  for (const Vector3d& vertex : mesh.vertices) {
    const Vector3d p = scanner_from_world * vertex;
    const Eigen::Vector2d at =
        rays == Rays::parallel
            ? Eigen::Vector2d(p.y(), p.x())
            : Eigen::Vector2d(std::atan2(p.y(), std::hypot(p.x(), p.z())), std::atan2(p.x(), p.z()));
    most = most.cwiseMax(at.cwiseAbs());
  }
  return most;
}

ScannerSpec scanner_of(const SimulationSpec& spec, const TriangleMesh& mesh, const Rigid3& world_from_scanner,
                       std::size_t scan) {
  ScannerSpec scanner;
  scanner.rays = spec.rays;
  scanner.pitch_m = spec.pitch_m;
  scanner.pitch_deg = spec.pitch_m / spec.distance_m * 180 / pi;
  const double pitch = spec.rays == Rays::parallel ? spec.pitch_m : spec.pitch_m / spec.distance_m;
  const Eigen::Vector2d half = needed_half_extent(mesh, world_from_scanner, spec.rays);
  scanner.rows = spec.scan_rows.value_or(static_cast<int>(std::ceil(2 * half.x() / pitch)) + 3);
  scanner.columns = spec.scan_columns.value_or(static_cast<int>(std::ceil(2 * half.y() / pitch)) + 3);
  scanner.noise_m = spec.noise_m;
  scanner.max_incidence_deg = spec.max_incidence_deg;
  scanner.mixed_pixel_percent = spec.mixed_pixel_percent;
  scanner.intensity = spec.scan_intensity;
  scanner.color = spec.scan_color;
  scanner.seed = item_seed(static_cast<std::uint64_t>(spec.seed), scan);
  return scanner;
}

Vector3d random_direction(Rng& random) {
  const double z = random.uniform(-1, 1);
  const double around = random.uniform(0, 2 * pi);
  return {std::sqrt(1 - z * z) * std::cos(around), std::sqrt(1 - z * z) * std::sin(around), z};
}

/// What was measured of a pose: turned about the object's middle and shifted, each by what the spec says in a
/// random direction. The first scan defines the frame.
Rigid3 measured_pose(const SimulationSpec& spec, const Rigid3& world_from_scan, const Vector3d& center,
                     std::size_t scan) {
  if (scan == 0) return world_from_scan;
  Rng random(item_seed(static_cast<std::uint64_t>(spec.seed), pose_items + scan));
  const Eigen::AngleAxisd turn(spec.pose_error_deg * pi / 180, random_direction(random));
  const Vector3d shift = spec.pose_error_m * random_direction(random);
  return Rigid3(Eigen::Translation3d(center + shift) * turn * Eigen::Translation3d(-center) *
                world_from_scan);
}

/// Returns the true poses.
io::PosesRecord write_scans(const SimulationSpec& spec, const TriangleMesh& mesh, const fs::path& folder,
                            const Progress& progress) {
  const Vector3d center = bounding_box(mesh.vertices).center();
  const RayCaster caster(mesh);
  const std::vector<Rigid3> poses = scanner_poses(spec, center);
  std::vector<NamedPose> measured;
  io::PosesRecord truth;
  truth.frame.metres_per_input_unit = metres_per_unit(spec);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(poses.size()), "scans");
    const RangeScan taken = scan(mesh, caster, poses[i], scanner_of(spec, mesh, poses[i], i));
    write_range_ply(folder / "scans" / scan_name(i), taken, metres_per_unit(spec));
    measured.push_back({scan_name(i), measured_pose(spec, poses[i], center, i)});
    io::PoseRecord record;
    record.file = scan_name(i);
    record.world_from_scan = poses[i];
    record.reason = "simulated";
    truth.scans.push_back(record);
  }
  const std::string conf = object_name(spec.object) + ".conf";
  write_stanford_conf(folder / "scans" / conf, measured, metres_per_unit(spec));
  return truth;
}

/// Returns the true cameras.
io::CamerasRecord write_photos(const SimulationSpec& spec, const Subject& subject, const fs::path& folder,
                               const Progress& progress) {
  io::CamerasRecord truth;
  truth.frame.metres_per_input_unit = metres_per_unit(spec);
  const std::size_t count = spec.photo_azimuths_deg.size();
  for (std::size_t i = 0; i < count; ++i) {
    // Nobody aims at the very middle.
    Rng random(item_seed(static_cast<std::uint64_t>(spec.seed), photo_items + i));
    const Eigen::Vector2d off_center(random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04));
    const double elevation =
        spec.photo_elevations_deg.size() == 1 ? spec.photo_elevations_deg[0] : spec.photo_elevations_deg[i];
    const Camera camera = camera_round(subject.mesh, spec.photo_width, spec.photo_height, spec.photo_fov_deg,
                                       spec.photo_azimuths_deg[i], elevation, spec.photo_roll_deg,
                                       spec.photo_fill_percent, off_center);
    const PhotoStyle style{spec.photo_table, spec.photo_clutter, spec.photo_noise_percent, random.next()};
    const SimulatedPhoto photo =
        take_photo(subject, camera, style,
                   progress.part(static_cast<double>(i) / static_cast<double>(count),
                                 static_cast<double>(i + 1) / static_cast<double>(count)));
    io::write_image(folder / "photos" / photo_name(i), photo.image, jpeg_quality);
    io::write_image(folder / "photos" / stencil_name(i), photo.stencil);
    io::CameraRecord record;
    record.photo = photo_name(i);
    record.camera = camera;
    record.overlap_percent = 100;
    record.verdict = io::Verdict::accept;
    record.method = "given";
    record.stencil = "photos/" + stencil_name(i);
    truth.cameras.push_back(record);
  }
  return truth;
}

void check(const SimulationSpec& spec, const TriangleMesh& mesh) {
  const std::size_t photos = spec.photo_azimuths_deg.size();
  const std::size_t elevations = spec.photo_elevations_deg.size();
  if (photos > 0 && elevations != 1 && elevations != photos)
    throw config_error(
        "photo_elevations_deg has {} values; it needs one, or as many as photo_azimuths_deg ({})", elevations,
        photos);
  const double radius = bounding_box(mesh.vertices).diagonal().norm() / 2;
  if (spec.distance_m <= radius)
    throw config_error(
        "distance_m = {}: the scanner would stand inside the object, which reaches {} m from its middle",
        spec.distance_m, radius);
}

/// Scans and photos of another simulation would be taken for ones of this.
void check_folder(const SimulationSpec& spec, const fs::path& folder) {
  std::set<fs::path> ours;
  const std::size_t scans = spec.scan_elevations_deg.size() * static_cast<std::size_t>(spec.turntable_steps);
  for (std::size_t i = 0; i < scans; ++i) ours.insert(folder / "scans" / scan_name(i));
  for (std::size_t i = 0; i < spec.photo_azimuths_deg.size(); ++i) {
    ours.insert(folder / "photos" / photo_name(i));
    ours.insert(folder / "photos" / stencil_name(i));
  }
  for (const char* part : {"scans", "photos"}) {
    if (!fs::is_directory(folder / part)) continue;
    for (const auto& entry : fs::directory_iterator(folder / part))
      if (entry.path().extension() != ".conf" && !ours.contains(entry.path()))
        throw input_error("{}: not a file of this simulation; name another folder, or remove it first",
                          entry.path().string());
  }
}

}  // namespace

void simulate(const SimulationSpec& spec, const fs::path& folder, const Progress& progress) {
  check_folder(spec, folder);
  progress.update(0, "object");
  const Subject subject = make_subject({spec.object, spec.scale, spec.mesh_detail});
  check(spec, subject.mesh);
  for (const char* part : {"scans", "photos"}) make_folder(folder / part);
  const io::PosesRecord poses = write_scans(spec, subject.mesh, folder, progress.part(0.1, 0.3));
  const io::CamerasRecord cameras = write_photos(spec, subject, folder, progress.part(0.3, 1));
  write_truth(folder / "truth.json", poses, cameras);
  TriangleMesh mesh = subject.mesh;
  mesh.normals.clear();
  for (Vector3d& vertex : mesh.vertices) vertex /= metres_per_unit(spec);
  io::write_mesh_ply(folder / "truth_mesh.ply", mesh);
  progress.update(1);
}

}  // namespace drape::simulation
