// Time and memory of texturing a mesh from eight photos all round it.
// Usage: texture_benchmark [large]: 1024 x 1024 pixels and 69,000 faces; large: 12 megapixels, 200,000 faces.
#include <fmt/core.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <string_view>

#include "painted_object.hpp"
#include "support.hpp"

int main(int count, char** arguments) {
  using namespace drape;
  const bool large = count > 1 && std::string_view(arguments[1]) == "large";
  const int width = large ? 4000 : 1024;
  const int height = large ? 3000 : 1024;
  // A torus hides parts of itself.
  const TriangleMesh mesh = large ? test::torus(1, 0.42, 500, 200) : test::torus(1, 0.42, 294, 118);
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // phases as they come: a time limit may end it
  std::vector<texturing::Shot> shots;
  for (int i = 0; i < 8; ++i) {
    const double azimuth = i * std::numbers::pi / 4;
    const double height_of_eye = i % 2 == 0 ? 2.2 : -1.4;
    const Eigen::Vector3d eye(4 * std::cos(azimuth), 4 * std::sin(azimuth), height_of_eye);
    shots.push_back(texturing::photographed(
        mesh, look_at(eye, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), width, height, 45),
        texturing::waves(0.3)));
  }
  std::vector<texturing::TextureView> views;
  for (const texturing::Shot& shot : shots) views.push_back(shot.view());
  rusage before{};
  getrusage(RUSAGE_SELF, &before);
  const auto start = std::chrono::steady_clock::now();
  std::string doing;
  auto since = start;
  const auto tick = [&](std::string_view next) {
    const auto now = std::chrono::steady_clock::now();
    if (!doing.empty())
      fmt::print("  {:6.2f} s  {}\n", std::chrono::duration<double>(now - since).count(), doing);
    doing = next;
    since = now;
  };
  const Progress progress(
      [&](double, std::string_view what) {
        if (!what.empty() && what != doing) tick(what);
      },
      nullptr);
  const texturing::TextureResult result = texturing::texture_mesh(mesh, mesh, views, {}, progress);
  tick("");
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  rusage after{};
  getrusage(RUSAGE_SELF, &after);
  const auto cpu = [](const rusage& r) {
    return static_cast<double>(r.ru_utime.tv_sec + r.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
  };
  fmt::print(
      "{} photos of {} x {}, {} faces -> {} faces, {} pages: {:.1f} s, {:.1f} CPU s, peak {} MB (of which {} "
      "MB "
      "before: the photos and what drew them)\n",
      shots.size(), width, height, mesh.faces.size(), result.model.mesh.faces.size(),
      result.atlas_coverage.size(), seconds, cpu(after) - cpu(before), after.ru_maxrss / 1024,
      before.ru_maxrss / 1024);
  return 0;
}
