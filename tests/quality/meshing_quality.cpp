// How near the meshes of scans are to the truth (simulated scans of five shapes, before and after filling)
// and to the scans themselves (the bunny, also without one of its scans), one row each. Usage:
// meshing_quality [save=FOLDER] [noise=PERCENT,...] [shape=NAME,...] [seed=NUMBER] [places=yes] [real=no]
// [pcl=no] [meshlab=no] [option=value ...], options as in the `mesh` section. Another seed turns the scanners
// about the object and draws other noise; places=yes prints where on the mesh the error sits.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "drape/ingest/clean_scan.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "drape/meshing/mesh_scans.hpp"
#include "drape/metrics/surface_distance.hpp"
#include "drape/report/turntable.hpp"
#include "drape/simulation/range_scanner.hpp"
#include "error_places.hpp"
#include "poisson_peers.hpp"
#include "program_arguments.hpp"
#include "range_sheet.hpp"
#include "support.hpp"
#include "trimming.hpp"

namespace drape {
namespace {

struct Settings {
  std::string save;
  std::vector<std::string> shapes;
  std::uint64_t seed = 0;
  bool places = false;
  std::vector<double> noise_percents = {0.05, 0.1, 0.2};
  bool real = true;
  bool pcl = true;
  bool meshlab = true;
  meshing::MeshOptions mesh;
};

struct Scans {
  std::vector<RangeScan> scans;
  std::vector<Rigid3> world_from_scan;
  PointCloud cloud;  // all samples in the world
  double spacing = 0;
};

void append_in_world(PointCloud& cloud, const RangeScan& scan, const Rigid3& world_from_scan) {
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    cloud.positions.push_back(world_from_scan * scan.cloud.positions[i]);
    cloud.normals.push_back((world_from_scan.linear() * scan.cloud.normals[i].cast<double>()).cast<float>());
  }
}

void add_scan(Scans& all, const RangeScan& raw, const Rigid3& world_from_scan) {
  all.scans.push_back(ingest::clean_scan(raw, {}, {}).scan);
  all.world_from_scan.push_back(world_from_scan);
  append_in_world(all.cloud, all.scans.back(), world_from_scan);
}

void set_spacing(Scans& all) {
  all.spacing = 0;
  for (const RangeScan& scan : all.scans) all.spacing += scan.spacing / static_cast<double>(all.scans.size());
}

// From six sides, 250 samples across the diagonal, with noise and grazing drop-out.
Scans simulated_scans(const TriangleMesh& truth, double noise_percent, std::uint64_t seed) {
  const BoundingBox box = bounding_box(truth.vertices);
  const double diagonal = box.diagonal().norm();
  const RayCaster caster(truth);
  simulation::ScannerSpec spec;
  spec.rows = spec.columns = 400;
  const double distance = 2.5 * diagonal;
  spec.pitch_deg = 1.05 / spec.rows / 2.5 * 180 / std::numbers::pi;
  spec.noise_m = noise_percent / 100 * diagonal;
  spec.max_incidence_deg = 75;
  spec.mixed_pixel_percent = 10;
  // Not quite along the axes, which would see boxes head-on only.
  Rng random(seed);
  const Eigen::Vector3d axis = seed == 0 ? Eigen::Vector3d(1, 2, 3)
                                         : Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  const double angle = seed == 0 ? 0.35 : random.uniform(0.2, 1.2);
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(angle, axis.normalized()).matrix();
  Scans all;
  for (int k = 0; k < 6; ++k) {
    spec.seed = 100 * seed + static_cast<std::uint64_t>(k);
    const Eigen::Vector3d forward = tilt * Eigen::Vector3d::Unit(k % 3) * (k < 3 ? 1 : -1);
    Rigid3 world_from_scanner = Rigid3::Identity();
    const Eigen::Vector3d right = forward.unitOrthogonal();
    world_from_scanner.linear() << right, forward.cross(right), forward;
    world_from_scanner.translation() = box.center() - distance * forward;
    add_scan(all, simulation::scan(truth, caster, world_from_scanner, spec), world_from_scanner);
  }
  set_spacing(all);
  return all;
}

// The samples as fusion has them before it fuses.
PointCloud denoised_cloud(const Scans& all) {
  PointCloud cloud;
  for (std::size_t s = 0; s < all.scans.size(); ++s)
    for (const meshing::Sight& sight :
         meshing::sights_of(all.scans[s], all.world_from_scan[s], all.scans[s].spacing, 0.7)) {
      const auto sheet = meshing::range_sheet(all.scans[s], all.world_from_scan[s], sight, {});
      const Rigid3 world_from_sight = sheet.sight.sight_from_world.inverse();
      for (const meshing::RangeSample& sample : sheet.samples) {
        if (!(sample.weight > 0)) continue;
        cloud.positions.push_back(
            world_from_sight *
            sheet.sight.in_sight(Eigen::Vector3f(sample.column, sample.row, sample.depth).cast<double>()));
        cloud.normals.push_back(
            world_from_sight.linear().cast<float>() *
            sheet.sight.normal_of(sample.column, sample.row, sample.slope_x, sample.slope_y).normalized());
      }
    }
  return cloud;
}

// Points spread over a mesh with its faces' normals.
PointCloud spread_samples(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  test::SurfacePoints points = test::spread_points(mesh, count, seed);
  PointCloud cloud;
  cloud.positions = std::move(points.positions);
  for (const std::size_t face : points.faces)
    cloud.normals.push_back(scaled_face_normal(mesh, face).normalized().cast<float>());
  return cloud;
}

double mean_normal_difference_deg(const PointCloud& places, const TriangleMesh& truth) {
  const PointCloud true_places = spread_samples(truth, 400000, 4);
  const KdTree tree(true_places.positions);
  double sum = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Neighbor nearest{};
    tree.nearest(places.positions[i], {&nearest, 1});
    const float cosine = places.normals[i].dot(true_places.normals[nearest.index]);
    sum += std::acos(static_cast<double>(std::clamp(cosine, -1.0F, 1.0F)));
  }
  return sum / static_cast<double>(places.size()) * 180 / std::numbers::pi;
}

// Of the surface farther than three spacings from every sample.
double invented_percent(const TriangleMesh& made, const Scans& all) {
  const KdTree tree(all.cloud.positions);
  const PointCloud places = spread_samples(made, 50000, 5);
  std::size_t far = 0;
  for (const Eigen::Vector3d& p : places.positions) far += tree.nearest_within(p, 3 * all.spacing) ? 0 : 1;
  return 100 * static_cast<double>(far) / static_cast<double>(places.size());
}

void print_header() {
  fmt::print("{:<34} {:>6} {:>6} {:>6} {:>6} | {:>6} {:>6} | {:>6} {:>7} | {:>5} {:>5} {:>5} {:>8} {:>8}\n",
             "", "mean", "RMS", "95 %", "max", "mean", "RMS", "normal", "invent", "parts", "loops", "genus",
             "manifold", "faces");
  fmt::print("{:<34} {:>27} | {:>13} | {:>6} {:>7} |\n", "", "made -> truth, spacings", "seen -> made", "deg",
             "%");
}

// Distances in spacings; `seen` is what the scans saw of the truth.
void print_row(const std::string& name, const TriangleMesh& made, const TriangleMesh& truth,
               const std::vector<Eigen::Vector3d>& seen, const Scans& all) {
  const metrics::Distribution extra = metrics::surface_distance(made, truth, {50000, 1});
  const metrics::Distribution missing = metrics::surface_distance(seen, made);
  const meshing::MeshQuality quality = meshing::mesh_quality(made);
  const double s = all.spacing;
  fmt::print(
      "{:<34} {:>6.3f} {:>6.3f} {:>6.3f} {:>6.2f} | {:>6.3f} {:>6.3f} | {:>6.2f} {:>7.3f} | {:>5} {:>5} "
      "{:>5} {:>8} {:>8}"
      " {}\n",
      name, extra.mean / s, extra.rms / s, extra.percentile_95 / s, extra.max / s, missing.mean / s,
      missing.rms / s, mean_normal_difference_deg(spread_samples(made, 20000, 3), truth),
      invented_percent(made, all), quality.components, quality.boundary_loops,
      quality.genus ? std::to_string(*quality.genus) : "-", quality.manifold() ? "yes" : "NO", quality.faces,
      quality.self_intersections > 0 ? fmt::format("{} self-intersections", quality.self_intersections) : "");
  std::fflush(stdout);
}

// How near the samples are to the truth once they are denoised: what is lost before fusing.
void print_samples_row(const PointCloud& cloud, const TriangleMesh& truth, const Scans& all) {
  PointCloud some;
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / 20000);
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    some.positions.push_back(cloud.positions[i]);
    some.normals.push_back(cloud.normals[i]);
  }
  const metrics::Distribution off = metrics::surface_distance(some.positions, truth);
  fmt::print("{:<34} {:>6.3f} {:>6.3f} {:>6.3f} {:>6.2f} | {:>13} | {:>6.2f}\n", "  denoised samples",
             off.mean / all.spacing, off.rms / all.spacing, off.percentile_95 / all.spacing,
             off.max / all.spacing, "", mean_normal_difference_deg(some, truth));
}

void save(const Settings& settings, const std::string& name, const TriangleMesh& mesh) {
  if (settings.save.empty()) return;
  io::write_mesh_ply(settings.save + "/" + name + ".ply", mesh);
  io::write_image(settings.save + "/" + name + ".png", report::turntable(mesh));
}

void measure_filled(const Settings& settings, const std::string& name, const TriangleMesh& made,
                    const TriangleMesh& truth, const std::vector<Eigen::Vector3d>& seen, const Scans& all) {
  meshing::FillOptions options;
  options.simplify_triangles = 0;
  const meshing::FillResult result =
      meshing::fill_holes(made, all.spacing, options, {all.scans, all.world_from_scan});
  const auto filled = std::count_if(result.holes.begin(), result.holes.end(),
                                    [](const meshing::Hole& hole) { return hole.filled(); });
  print_row(
      fmt::format("  filled {} of {}, crossings {}", filled, result.holes.size(), result.self_intersections),
      result.mesh, truth, seen, all);
  save(settings, name, result.mesh);
}

void measure_shape(const Settings& settings, const std::string& file) {
  const std::string name = file.substr(0, file.find('.'));
  if (!test::have_data("meshes/" + file)) {
    fmt::print("{}: skipped, needs meshes/{} of DRAPE_TEST_DATA\n", name, file);
    return;
  }
  const TriangleMesh truth = io::read_mesh(test::data("meshes/" + file));
  for (const double noise : settings.noise_percents) {
    const Scans all = simulated_scans(truth, noise, settings.seed);
    const KdTree samples(all.cloud.positions);
    std::vector<Eigen::Vector3d> seen;
    for (const Eigen::Vector3d& p : test::spread_points(truth, 20000, 2).positions)
      if (samples.nearest_within(
              p, std::max(all.spacing, 3 * noise / 100 * bounding_box(truth.vertices).diagonal().norm())))
        seen.push_back(p);
    const std::string row = fmt::format("{} {} %", name, noise);
    const TriangleMesh made =
        meshing::mesh_scans({all.scans, all.world_from_scan, all.cloud, all.spacing}, settings.mesh).mesh;
    print_row(row, made, truth, seen, all);
    save(settings, fmt::format("{}_{}", name, noise), made);
    measure_filled(settings, fmt::format("{}_{}_filled", name, noise), made, truth, seen, all);
    if (settings.places) test::print_error_places(made, truth, all.world_from_scan, all.spacing);
    const PointCloud cloud = denoised_cloud(all);
    print_samples_row(cloud, truth, all);
    const auto print_peer = [&](const std::string& peer_row, const TriangleMesh& mesh) {
      print_row(peer_row, mesh, truth, seen, all);
      if (settings.places) test::print_error_places(mesh, truth, all.world_from_scan, all.spacing);
    };
    if (!settings.pcl) continue;
    for (const int depth : {8, 9})
      if (const auto peer = test::pcl_poisson_mesh(cloud, depth))
        print_peer(fmt::format("  pcl Poisson {}, trimmed", depth),
                   meshing::trimmed_to_samples(peer->mesh, cloud, 3 * all.spacing).mesh);
      else
        fmt::print("  pcl Poisson {}: skipped, needs pcl-tools\n", depth);
    if (!settings.meshlab) continue;
    for (const int depth : {8, 9})
      if (const auto peer = test::meshlab_poisson_mesh(cloud, depth))
        print_row(fmt::format("  MeshLab Poisson {}, trimmed", depth),
                  meshing::trimmed_to_samples(peer->mesh, cloud, 3 * all.spacing).mesh, truth, seen, all);
      else
        fmt::print("  MeshLab Poisson {}: skipped, needs meshlabserver and xvfb\n", depth);
  }
}

Scans bunny_scans(const std::string& left_out) {
  Scans all;
  for (const auto& [file, world_from_scan] : io::read_scan_poses(test::data("scans/bunny/bun.conf")))
    if (file != left_out)
      add_scan(all, io::read_scans(test::data("scans/bunny/" + file)).front(), world_from_scan);
  set_spacing(all);
  return all;
}

// From nine scans; distances of those points of the tenth that another scan saw too.
void measure_left_out(const Settings& settings, const Scans& whole, const std::string& file) {
  const Scans nine = bunny_scans(file);
  const TriangleMesh made =
      meshing::mesh_scans({nine.scans, nine.world_from_scan, nine.cloud, nine.spacing}, settings.mesh).mesh;
  const KdTree samples(nine.cloud.positions);
  std::size_t index = 0;
  for (const auto& [name, pose] : io::read_scan_poses(test::data("scans/bunny/bun.conf"))) {
    if (name == file) break;
    ++index;
  }
  std::vector<Eigen::Vector3d> seen;
  for (const Eigen::Vector3d& p : whole.scans[index].cloud.positions)
    if (const Eigen::Vector3d world = whole.world_from_scan[index] * p;
        samples.nearest_within(world, 2 * nine.spacing))
      seen.push_back(world);
  const metrics::Distribution d = metrics::surface_distance(seen, made);
  fmt::print(
      "bunny without {:<14} its {:>6} points seen by others -> mesh, mm: mean {:.3f} RMS {:.3f} 95 % {:.3f} "
      "max {:.2f}\n",
      file, seen.size(), 1e3 * d.mean, 1e3 * d.rms, 1e3 * d.percentile_95, 1e3 * d.max);
}

void measure_bunny(const Settings& settings) {
  if (!test::have_data("scans/bunny/bun.conf") || !test::have_data("meshes/bun_zipper.ply")) {
    fmt::print("bunny: skipped, needs scans/bunny and meshes/bun_zipper.ply of DRAPE_TEST_DATA\n");
    return;
  }
  const Scans all = bunny_scans({});
  const TriangleMesh zipper = io::read_mesh(test::data("meshes/bun_zipper.ply"));
  const auto print = [&](const std::string& name, const TriangleMesh& made) {
    print_row(name, made, zipper, all.cloud.positions, all);
    const metrics::Distribution to_zipper = metrics::surface_distance(made, zipper, {50000, 1});
    const metrics::Distribution to_mesh = metrics::surface_distance(all.cloud.positions, made);
    fmt::print(
        "{:<34} in mm: to bun_zipper mean {:.3f} RMS {:.3f}; raw points to mesh mean {:.3f} 95 % {:.3f}\n",
        "", 1e3 * to_zipper.mean, 1e3 * to_zipper.rms, 1e3 * to_mesh.mean, 1e3 * to_mesh.percentile_95);
  };
  const TriangleMesh made =
      meshing::mesh_scans({all.scans, all.world_from_scan, all.cloud, all.spacing}, settings.mesh).mesh;
  print("bunny, against bun_zipper", made);
  save(settings, "bunny", made);
  if (settings.pcl) {
    const PointCloud cloud = denoised_cloud(all);
    if (const auto peer = test::pcl_poisson_mesh(cloud, 8))
      print("  pcl Poisson 8, trimmed", meshing::trimmed_to_samples(peer->mesh, cloud, 3 * all.spacing).mesh);
  }
  for (const char* file : {"bun045.ply", "bun180.ply", "ear_back.ply"}) measure_left_out(settings, all, file);
}

// A shape's name without its ending will do.
std::vector<std::string> files_of(const std::vector<std::string>& shapes) {
  std::vector<std::string> files;
  for (const std::string& shape : shapes) {
    files.push_back(shape);
    for (const char* ending : {".obj", ".ply", ".stl"})
      if (test::have_data("meshes/" + shape + ending)) files.back() = shape + ending;
  }
  return files;
}

Settings settings_of(test::ProgramArguments& arguments) {
  Settings settings;
  settings.save = arguments.text("save").value_or("");
  settings.shapes = arguments.list("shape");
  settings.seed = std::stoull(arguments.text("seed").value_or("0"));
  settings.places = arguments.text("places").value_or("no") == "yes";
  if (const std::vector<std::string> noise = arguments.list("noise"); !noise.empty()) {
    settings.noise_percents.clear();
    for (const std::string& percent : noise) settings.noise_percents.push_back(std::stod(percent));
  }
  settings.real = arguments.text("real").value_or("yes") != "no";
  settings.meshlab = arguments.text("meshlab").value_or("yes") != "no";
  settings.pcl = arguments.text("pcl").value_or("yes") != "no";
  arguments.read(settings.mesh);
  arguments.finish();
  return settings;
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, [](drape::test::ProgramArguments& arguments) {
    const drape::Settings settings = drape::settings_of(arguments);
    drape::print_header();
    std::vector<std::string> files{"rocker-arm.obj", "Laurana50k.ply", "fandisk.obj", "spot.obj",
                                   "bun_zipper.ply"};
    if (!settings.shapes.empty()) files = drape::files_of(settings.shapes);
    for (const std::string& file : files) drape::measure_shape(settings, file);
    if (settings.real) drape::measure_bunny(settings);
  });
}
