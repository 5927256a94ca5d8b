// What tests of every module share: real data, scratch folders, analytic shapes.
#pragma once

#include <filesystem>
#include <string>

#include "drape/base/error.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::test {

/// A file or folder of the real test data. Ask `have_data` first, and skip by name if it is not there:
///   if (!have_data("scans/bunny")) GTEST_SKIP() << "needs scans/bunny of DRAPE_TEST_DATA";
[[nodiscard]] std::filesystem::path data(const std::string& relative);
[[nodiscard]] bool have_data(const std::string& relative);

/// A file or folder of the project itself.
[[nodiscard]] std::filesystem::path source(const std::string& relative);

/// An empty folder that is removed with the object.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The message of the drape::Error with `code` that `call` throws; anything else fails the running test and
/// gives "".
template <class Call>
std::string error_message(ErrorCode code, Call call);

/// A sphere with vertices exactly on it, about 2 * rings^2 outward faces.
[[nodiscard]] TriangleMesh sphere(double radius, int rings = 32,
                                  const Eigen::Vector3d& center = Eigen::Vector3d::Zero());
/// A closed box between two corners, 12 outward faces.
[[nodiscard]] TriangleMesh box(const Eigen::Vector3d& least, const Eigen::Vector3d& most);
/// A torus round z, outward faces, genus 1.
[[nodiscard]] TriangleMesh torus(double major_radius, double minor_radius, int major_steps = 48,
                                 int minor_steps = 24);

void report_unexpected(const std::string& what);

template <class Call>
std::string error_message(ErrorCode code, Call call) {
  try {
    call();
  } catch (const Error& error) {
    if (error.code() == code) return error.what();
    report_unexpected(std::string("an Error with another code: ") + error.what());
    return {};
  } catch (const std::exception& error) {
    report_unexpected(std::string("another exception: ") + error.what());
    return {};
  }
  report_unexpected("no exception");
  return {};
}

}  // namespace drape::test
