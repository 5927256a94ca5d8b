// Hole filling on real meshes: what became of every loop, and, for holes that are cut out of a complete mesh,
// how far the patches are from what was cut, beside planar ones. Usage: filling_quality [save=FOLDER]
// [seed=NUMBER] [option=value ...], options as in the `fill` section.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "drape/base/error.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "drape/meshing/simplify.hpp"
#include "drape/metrics/surface_distance.hpp"
#include "program_arguments.hpp"
#include "support.hpp"

namespace drape {
namespace {

struct Settings {
  meshing::FillOptions options;
  std::filesystem::path save;  // empty: nothing
  std::uint64_t seed = 7;      // of the places where holes are cut
};

Settings settings_of(test::ProgramArguments& arguments) {
  Settings settings;
  settings.options.simplify_triangles = 0;
  settings.save = arguments.text("save").value_or("");
  settings.seed = std::stoull(arguments.text("seed").value_or("7"));
  arguments.read(settings.options);
  arguments.finish();
  return settings;
}

using test::cpu_seconds;

// Vertices of kept faces at places where there was none before: 0 is promised.
std::size_t moved_vertices(const TriangleMesh& before, const TriangleMesh& after) {
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::vector<Eigen::Vector3d> places = before.vertices;
  std::sort(places.begin(), places.end(), less);
  std::vector<std::uint8_t> moved(after.vertices.size(), 0);
  for (std::size_t i = 0; i < after.faces.size(); ++i)
    for (const std::uint32_t v : after.faces[i])
      if (after.filled[i] == 0 && !std::binary_search(places.begin(), places.end(), after.vertices[v], less))
        moved[v] = 1;
  return static_cast<std::size_t>(std::count(moved.begin(), moved.end(), 1));
}

void every_loop(const std::string& name, const Settings& settings) {
  if (!test::have_data("meshes/" + name)) {
    fmt::print("{}: not there\n", name);
    return;
  }
  const TriangleMesh mesh = io::read_mesh(test::data("meshes/" + name));
  const double spacing = median_edge_length(mesh);
  const double start = cpu_seconds();
  const meshing::FillResult result = meshing::fill_holes(mesh, spacing, settings.options);
  const double seconds = cpu_seconds() - start;
  const MeshTopology before = mesh_topology(mesh);
  const meshing::MeshQuality after = meshing::mesh_quality(result.mesh);
  const std::size_t crossings_before = meshing::self_intersecting_pairs(mesh).size();
  std::size_t silent = 0;
  for (const meshing::Hole& hole : result.holes)
    if (hole.why.empty() ||
        (hole.filled() && hole.faces_added == 0 && hole.why.find("inside") == std::string::npos))
      ++silent;
  const auto filled = static_cast<std::size_t>(
      std::count_if(result.holes.begin(), result.holes.end(), [](const auto& h) { return h.filled(); }));
  fmt::print(
      "{}: {} raw loops in {} borders, {} after repair; {} filled, {} left by rule, {} silent failures; {} "
      "open "
      "after; {:.3f} CPU s\n  self-intersecting pairs {} before, {} after, {} with an added face; manifold "
      "{}, "
      "genus {}; {} vertices moved\n",
      name, before.boundary_loops, before.borders, result.holes.size(), filled, result.holes.size() - filled,
      silent, after.boundary_loops, seconds, crossings_before, after.self_intersections,
      result.self_intersections, after.manifold() ? "yes" : "NO",
      after.genus ? std::to_string(*after.genus) : "none", moved_vertices(mesh, result.mesh));
  for (const meshing::Hole& hole : result.holes)
    fmt::print("  {:5} edges, length {:8.1f}, area {:9.1f}, flatness {:6.2f} spacings: {:5} ({})\n",
               hole.boundary_edges, hole.length / spacing, hole.area / (spacing * spacing),
               hole.flatness / spacing, meshing::to_string(hole.action), hole.why);
  if (!settings.save.empty())
    io::write_mesh_ply(settings.save / (std::filesystem::path(name).stem().string() + "_filled.ply"),
                       result.mesh);
}

// The faces within `radius` of a vertex, cut out, and what was cut.
struct Cut {
  TriangleMesh open;
  TriangleMesh piece;
};

Cut cut_out(const TriangleMesh& mesh, std::uint32_t seed, double radius) {
  std::vector<std::uint8_t> near(mesh.vertices.size(), 0);
  for (std::size_t v = 0; v < near.size(); ++v)
    near[v] = (mesh.vertices[v] - mesh.vertices[seed]).norm() < radius ? 1 : 0;
  // Only what hangs together with the seed: the other side of a thin wall stays.
  std::vector<std::uint8_t> reached(mesh.vertices.size(), 0);
  reached[seed] = 1;
  for (bool grown = true; grown;) {
    grown = false;
    for (const Face& f : mesh.faces) {
      const bool touches = reached[f[0]] != 0 || reached[f[1]] != 0 || reached[f[2]] != 0;
      for (const std::uint32_t v : f)
        if (touches && near[v] != 0 && reached[v] == 0) {
          reached[v] = 1;
          grown = true;
        }
    }
  }
  std::vector<std::uint8_t> keep;
  std::vector<std::uint8_t> cut;
  for (const Face& f : mesh.faces) {
    const bool inside = reached[f[0]] != 0 || reached[f[1]] != 0 || reached[f[2]] != 0;
    keep.push_back(inside ? 0 : 1);
    cut.push_back(inside ? 1 : 0);
  }
  return {with_faces(mesh, keep), with_faces(mesh, cut)};
}

TriangleMesh added_faces(const TriangleMesh& mesh) {
  return with_faces(mesh, mesh.filled);
}

// A planar fill to compare with: triangles between the boundary and its mean.
TriangleMesh planar_patch(const TriangleMesh& open) {
  TriangleMesh patch;
  for (const BoundaryLoop& loop : boundary_loops(open)) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : loop.vertices)
      mean += open.vertices[v] / static_cast<double>(loop.vertices.size());
    const auto first = static_cast<std::uint32_t>(patch.vertices.size());
    const auto count = static_cast<std::uint32_t>(loop.vertices.size());
    for (const std::uint32_t v : loop.vertices) patch.vertices.push_back(open.vertices[v]);
    patch.vertices.push_back(mean);
    for (std::uint32_t i = 0; i < count; ++i)
      patch.faces.push_back({first + i, first + (i + 1) % count, first + count});
  }
  return patch;
}

struct Score {
  std::size_t holes = 0;
  std::size_t filled = 0;
  std::size_t better = 0;  // than half the planar error
  double squares = 0;
  double planar_squares = 0;
  double sum = 0;
  double planar_sum = 0;
  std::size_t crossings = 0;
  std::size_t moved = 0;

  void add(const Score& other) {
    holes += other.holes;
    filled += other.filled;
    better += other.better;
    squares += other.squares;
    planar_squares += other.planar_squares;
    sum += other.sum;
    planar_sum += other.planar_sum;
    crossings += other.crossings;
    moved += other.moved;
  }
};

void print_score(const std::string& name, const std::string& radius, const Score& score) {
  const auto n = static_cast<double>(std::max<std::size_t>(score.filled, 1));
  fmt::print(
      "{:16} {:2} holes of radius {:>4}: {:2} filled, mean error {:.3f} (planar {:.3f}, ratio {:.2f}), RMS "
      "{:.3f} ({:.3f}, {:.2f}), under half of planar {}, self-intersections {}, vertices moved {}\n",
      name, score.holes, radius, score.filled, score.sum / n, score.planar_sum / n,
      score.sum / score.planar_sum, std::sqrt(score.squares / n), std::sqrt(score.planar_squares / n),
      std::sqrt(score.squares / score.planar_squares), score.better, score.crossings, score.moved);
  std::fflush(stdout);
}

void measure(const Cut& cut, double spacing, const meshing::FillOptions& options, Score& score) {
  const std::size_t before = meshing::self_intersecting_pairs(cut.open).size();
  const meshing::FillResult result = meshing::fill_holes(cut.open, spacing, options);
  score.holes += 1;
  const bool all =
      std::all_of(result.holes.begin(), result.holes.end(), [](const auto& h) { return h.filled(); });
  if (!all) return;
  score.filled += 1;
  score.crossings += meshing::self_intersecting_pairs(result.mesh).size() - before;
  score.moved += moved_vertices(cut.open, result.mesh);
  const metrics::SurfacePoints points{2000, 1};
  const auto made = metrics::two_way_distance(added_faces(result.mesh), cut.piece, points);
  const auto flat = metrics::two_way_distance(planar_patch(cut.open), cut.piece, points);
  const double mean = (made.extra.mean + made.missing.mean) / 2 / spacing;
  const double flat_mean = (flat.extra.mean + flat.missing.mean) / 2 / spacing;
  score.sum += mean;
  score.planar_sum += flat_mean;
  score.squares += std::pow(std::max(made.extra.rms, made.missing.rms) / spacing, 2);
  score.planar_squares += std::pow(std::max(flat.extra.rms, flat.missing.rms) / spacing, 2);
  if (mean <= 0.5 * flat_mean) score.better += 1;
}

void transplanted_holes(const std::string& name, const Settings& settings, std::size_t number,
                        double radius_spacings, std::uint64_t seed, Score& pooled) {
  if (!test::have_data("meshes/" + name)) return;
  const TriangleMesh mesh = io::read_mesh(test::data("meshes/" + name));
  const double spacing = median_edge_length(mesh);
  // Cut only where the mesh is whole, far from its own holes.
  std::vector<Eigen::Vector3d> border;
  for (const BoundaryLoop& loop : boundary_loops(mesh))
    for (const std::uint32_t v : loop.vertices) border.push_back(mesh.vertices[v]);
  TriangleMesh whole = mesh;
  if (!border.empty()) whole = meshing::fill_holes(mesh, spacing, {}).mesh;
  whole.filled.clear();
  Rng rng(seed);
  Score score;
  const double radius = radius_spacings * spacing;
  for (int tries = 0; score.holes < number && tries < 1000; ++tries) {
    const auto v = static_cast<std::uint32_t>(rng.uniform(0, static_cast<double>(mesh.vertices.size())));
    if (std::any_of(border.begin(), border.end(), [&](const Eigen::Vector3d& p) {
          return (p - mesh.vertices[v]).norm() < radius + 4 * spacing;
        }))
      continue;
    const Cut cut = cut_out(whole, v, radius);
    if (mesh_topology(cut.open).boundary_loops != 1 || mesh_topology(cut.open).components != 1) continue;
    measure(cut, spacing, settings.options, score);
  }
  print_score(name, fmt::format("{:.1f}", radius_spacings), score);
  pooled.add(score);
}

// A band of a sphere between a loop of 4,000 edges and one of 2,000: both are filled.
void long_loop(const Settings& settings) {
  const TriangleMesh sphere = test::sphere(10, 1000);
  std::vector<std::uint8_t> keep;
  for (const Face& f : sphere.faces) {
    const double z = (sphere.vertices[f[0]].z() + sphere.vertices[f[1]].z() + sphere.vertices[f[2]].z()) / 3;
    keep.push_back(z > 8 && z < 9 ? 1 : 0);
  }
  const TriangleMesh band = with_faces(sphere, keep);
  meshing::FillOptions options = settings.options;
  options.keep_outer_border = false;
  const double spacing = median_edge_length(band);
  options.max_hole_size_spacings = 1e6;
  const double start = cpu_seconds();
  const meshing::FillResult result = meshing::fill_holes(band, spacing, options);
  fmt::print("Long loops: {:.2f} CPU s\n", cpu_seconds() - start);
  for (const meshing::Hole& hole : result.holes)
    fmt::print("  {} edges: {}, {} faces ({})\n", hole.boundary_edges, meshing::to_string(hole.action),
               hole.faces_added, hole.why);
}

void simplification() {
  if (!test::have_data("meshes/bun_zipper.ply")) return;
  const TriangleMesh mesh = io::read_mesh(test::data("meshes/bun_zipper.ply"));
  const double spacing = median_edge_length(mesh);
  const double start = cpu_seconds();
  const TriangleMesh tenth = meshing::simplified(mesh, {mesh.faces.size() / 10, 0});
  const double seconds = cpu_seconds() - start;
  const auto distance = metrics::two_way_distance(tenth, mesh, {20000, 1});
  fmt::print("Simplified: {} to {} faces in {:.3f} CPU s, {:.3f} spacings off in the mean\n",
             mesh.faces.size(), tenth.faces.size(), seconds,
             (distance.extra.mean + distance.missing.mean) / 2 / spacing);
  for (const double error : {0.1, 0.5, 2.0}) {
    const TriangleMesh fewer = meshing::simplified(mesh, {0, error * spacing});
    const auto off = metrics::two_way_distance(fewer, mesh, {20000, 1});
    fmt::print("  error bound {:.1f} spacings: {} faces, {:.2f} spacings off at most\n", error,
               fewer.faces.size(), off.hausdorff() / spacing);
  }
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, [](drape::test::ProgramArguments& arguments) {
    const drape::Settings settings = drape::settings_of(arguments);
    for (const char* name : {"bun_zipper.ply", "Laurana50k.ply", "teapot.obj", "many_small_holes.ply"})
      drape::every_loop(name, settings);
    drape::long_loop(settings);
    drape::simplification();
    fmt::print("Holes cut out of complete meshes; errors in spacings\n");
    drape::Settings cutting = settings;
    cutting.options.keep_outer_border = false;
    drape::Score pooled;
    for (const double radius : {4.0, 8.0, 16.0})
      for (const char* name : {"bun_zipper.ply", "Laurana50k.ply", "rocker-arm.obj"})
        drape::transplanted_holes(name, cutting, 6, radius, settings.seed, pooled);
    drape::print_score("all", "any", pooled);
  });
}
