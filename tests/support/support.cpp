#include "support.hpp"

#include <gtest/gtest.h>

#include <unistd.h>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace drape::test {
namespace fs = std::filesystem;
using std::numbers::pi;

fs::path source(const std::string& relative) {
  return fs::path(DRAPE_SOURCE_DIR) / relative;
}

fs::path data(const std::string& relative) {
  const char* from_environment = std::getenv("DRAPE_TEST_DATA");
  const std::string configured = DRAPE_TEST_DATA_DEFAULT;
  const fs::path root = from_environment != nullptr ? fs::path(from_environment)
                        : !configured.empty()       ? fs::path(configured)
                                                    : source("../shared/data").lexically_normal();
  return root / relative;
}

bool have_data(const std::string& relative) {
  return fs::exists(data(relative));
}

ScratchFolder::ScratchFolder() {
  static std::atomic<int> count{0};
  path_ = fs::temp_directory_path() /
          ("drape-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
  fs::remove_all(path_);
  fs::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void report_unexpected(const std::string& what) {
  ADD_FAILURE() << "expected a drape::Error, got " << what;
}

TriangleMesh sphere(double radius, int rings, const Eigen::Vector3d& center) {
  TriangleMesh mesh;
  const int segments = 2 * rings;
  const auto point = [&](int ring, int segment) {
    const double polar = pi * ring / rings;
    const double around = 2 * pi * segment / segments;
    return Eigen::Vector3d(center + radius * Eigen::Vector3d(std::sin(polar) * std::cos(around),
                                                             std::sin(polar) * std::sin(around),
                                                             std::cos(polar)));
  };
  mesh.vertices.push_back(point(0, 0));
  for (int ring = 1; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) mesh.vertices.push_back(point(ring, segment));
  mesh.vertices.push_back(point(rings, 0));
  const auto index = [&](int ring, int segment) -> std::uint32_t {
    if (ring == 0) return 0;
    if (ring == rings) return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    return static_cast<std::uint32_t>(1 + (ring - 1) * segments + segment % segments);
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      if (ring > 0)
        mesh.faces.push_back({index(ring, segment), index(ring + 1, segment), index(ring, segment + 1)});
      if (ring + 1 < rings)
        mesh.faces.push_back(
            {index(ring, segment + 1), index(ring + 1, segment), index(ring + 1, segment + 1)});
    }
  return mesh;
}

TriangleMesh box(const Eigen::Vector3d& least, const Eigen::Vector3d& most) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? most.x() : least.x(), (i & 2) != 0 ? most.y() : least.y(),
                               (i & 4) != 0 ? most.z() : least.z());
  mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh torus(double major_radius, double minor_radius, int major_steps, int minor_steps) {
  TriangleMesh mesh;
  for (int i = 0; i < major_steps; ++i)
    for (int j = 0; j < minor_steps; ++j) {
      const double u = 2 * pi * i / major_steps;
      const double v = 2 * pi * j / minor_steps;
      const double r = major_radius + minor_radius * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), minor_radius * std::sin(v));
    }
  const auto index = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % major_steps) * minor_steps + j % minor_steps);
  };
  for (int i = 0; i < major_steps; ++i)
    for (int j = 0; j < minor_steps; ++j) {
      mesh.faces.push_back({index(i, j), index(i + 1, j), index(i, j + 1)});
      mesh.faces.push_back({index(i, j + 1), index(i + 1, j), index(i + 1, j + 1)});
    }
  return mesh;
}

}  // namespace drape::test
