#include "peer_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "drape/metrics/distribution.hpp"
#include "peers.hpp"
#include "program_arguments.hpp"
#include "trials.hpp"

namespace drape::lab {
namespace {

std::vector<Camera> start_candidates(const Model& model, const Shot& shot) {
  alignment::AlignOptions options;
  options.method = alignment::Method::exhaustive;
  options.exhaustive.first_pass_step_deg = 45;
  options.exhaustive.min_step_deg = 180;  // no refinement
  options.exhaustive.max_candidates_percent = 20;
  options.exhaustive.fov_range_deg = 0;
  const auto listed = alignment::align_photo(model.scanned, {shot.stencil, std::nullopt}, options, 1, {});
  std::vector<Camera> cameras;
  for (const alignment::AlignmentCandidate& candidate : listed.candidates) {
    Camera camera = candidate.camera;
    // The thesis scales x and y apart; a lens does not.
    camera.K(0, 0) = camera.K(1, 1) = metrics::focal_px(camera);
    cameras.push_back(camera);
  }
  return cameras;
}

Refined refined_by_silhouette(const TriangleMesh& mesh, const Image8& stencil, const Camera& start) {
  alignment::PhotoEvidence evidence{stencil, std::nullopt};
  evidence.initial_camera = start;
  const alignment::Alignment found = alignment::align_photo(mesh, evidence, {}, 1, {});
  return {found.camera, found.candidates.empty() ? -1 : found.candidates.front().score, 0};
}

struct Method {
  std::string name;
  std::function<Refined(const Model&, const Shot&, const Camera&)> refine;
};

std::vector<Method> methods() {
  return {
      {"silhouette (drape)",
       [](const Model& model, const Shot& shot, const Camera& start) {
         return refined_by_silhouette(model.scanned, shot.stencil, start);
       }},
      {"XOR, downhill simplex (Lensch et al. 2001)",
       [](const Model& model, const Shot& shot, const Camera& start) {
         return refined_by_xor(model.scanned, shot.stencil, start);
       }},
      {"MI on normals (Corsini et al. 2009)", [](const Model& model, const Shot& shot, const Camera& start) {
         return refined_by_mutual_information(model.scanned, *shot.photo, start);
       }}};
}

struct Figures {
  std::vector<double> error, cpu;
  int right = 0;

  void add(double deg, double seconds) {
    error.push_back(deg);
    cpu.push_back(seconds);
    right += deg < right_deg;
  }
  void print(const std::string& name) const {
    const auto deg = metrics::distribution(error);
    const auto seconds = metrics::distribution(cpu);
    fmt::print("  {:44} {:3} of {:3} {:8.2f} {:8.2f} {:9.3f} {:9.3f}\n", name, right, error.size(),
               deg.median, deg.max, seconds.median, seconds.max);
    std::fflush(stdout);
  }
  [[nodiscard]] nlohmann::json json() const {
    return {{"right", right}, {"error_deg", error}, {"cpu_seconds", cpu}};
  }
};

double error_of(const Camera& found, const Shot& shot, const Model& model) {
  return error_modulo_symmetry(found, shot.truth, model).rotation_about_ray_deg;
}

// Rows: the candidates themselves, the methods, and the silhouette method without candidates.
std::vector<std::string> row_names() {
  std::vector<std::string> names = {"the nearest of the candidates"};
  for (const Method& method : methods()) names.push_back(method.name);
  names.emplace_back("silhouette (drape), no candidates given");
  return names;
}

void compare(const Model& model, const Cell& cell, int photos, std::vector<Figures>& rows) {
  for (int i = 0; i < photos; ++i) {
    const Shot shot = take_shot(model, cell, 1, i);
    const std::vector<Camera> starts = start_candidates(model, shot);
    double nearest = 180;
    for (const Camera& start : starts) nearest = std::min(nearest, error_of(start, shot, model));
    auto row = rows.begin();
    (row++)->add(nearest, 0);
    for (const Method& method : methods()) {
      const double before = test::cpu_seconds();
      Refined best{};
      for (const Camera& start : starts) {
        const Refined refined = method.refine(model, shot, start);
        if (best.camera.width == 0 || refined.objective > best.objective) best = refined;
      }
      (row++)->add(error_of(best.camera, shot, model), test::cpu_seconds() - before);
    }
    const Trial trial = align_shot(model, cell, shot, {});
    row->add(trial.about_ray_deg, trial.cpu_seconds);
  }
}

// Every face in four.
TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [place, added] = middles.try_emplace(std::minmax(a, b), fine.vertices.size());
    if (added) fine.vertices.emplace_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.faces) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

}  // namespace

nlohmann::json print_peer_table(int photos) {
  const Cell cell = cells_named({"20-60_photo"}).front();
  const std::vector<std::string> names = row_names();
  std::vector<Figures> rows(names.size());
  for (const Model& model : load_models({"teapot", "head", "machine_part"}))
    compare(model, cell, photos, rows);
  fmt::print("From the same start candidates, {} photos of each of 3 models:\n", photos);
  fmt::print("  {:44} {:>10} {:>8} {:>8} {:>9} {:>9}\n", "method", "under 2 deg", "median", "worst", "CPU s",
             "worst");
  nlohmann::json json;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].print(names[i]);
    json[names[i]] = rows[i].json();
  }
  fmt::print("\n");
  return json;
}

nlohmann::json print_times(int photos) {
  const Cell cell = cells_named({"20-60"}).front();
  nlohmann::json json;
  fmt::print("From a mesh in memory to the pose, CPU s:\n");
  const auto measure = [&](const Model& model) {
    std::vector<double> cpu;
    for (int i = 0; i <= photos; ++i)
      cpu.push_back(align_shot(model, cell, take_shot(model, cell, 1, i), {}).cpu_seconds);
    const double first = cpu.front();
    cpu.erase(cpu.begin());
    const metrics::Distribution later = metrics::distribution(cpu);
    fmt::print("  {:15} {:7} triangles: first {:.3f}, later {:.3f} in the median, {:.3f} at worst (n = {})\n",
               model.name, model.scanned.faces.size(), first, later.median, later.max, later.count);
    std::fflush(stdout);
    json.push_back({{"model", model.name},
                    {"triangles", model.scanned.faces.size()},
                    {"first_s", first},
                    {"later_s", cpu}});
  };
  for (const std::string name : {"teapot.obj", "fandisk.obj", "rocker-arm.obj"}) {
    std::optional<Model> model = load_model(name);
    if (!model) continue;
    if (name == "rocker-arm.obj") model->object = model->scanned = subdivided(model->scanned);
    measure(*model);
  }
  fmt::print("\n");
  return json;
}

}  // namespace drape::lab
