// Cameras that a photogrammetry program found: known among themselves, in a frame and unit of its own.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drape/geometry/rigid3.hpp"

namespace drape::io {

struct BlockCamera {
  std::string photo;  // as the program names it: a file name, a path, or a name without its ending
  int width = 0;      // 0: the file does not tell; K is then about the photo's middle
  int height = 0;
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  std::vector<double> distortion;  // k1 k2 p1 p2 [k3], as OpenCV; empty: none
  Rigid3 camera_from_block = Rigid3::Identity();

  /// K of a photo of this size: of the same shape, if the file tells one.
  [[nodiscard]] Eigen::Matrix3d K_at(int photo_width, int photo_height) const;
};

/// Whether the file's extension is one of those that read_block_cameras knows.
[[nodiscard]] bool is_block_file(const std::filesystem::path& file);

/// COLMAP's text model (images.txt, with cameras.txt beside it; SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL,
/// RADIAL and OPENCV), Bundler (.out, with list.txt beside it; Snavely et al. 2006) and Metashape (.xml),
/// after their programs' documentation. Photos that the program could not place are left out. Error{input}
/// naming file and line for what cannot be read: other camera models and distortion that OpenCV's five
/// numbers do not hold.
[[nodiscard]] std::vector<BlockCamera> read_block_cameras(const std::filesystem::path& file);

/// The camera of the photo: of the same file name, or of the same name without its ending if just one is so
/// called.
[[nodiscard]] const BlockCamera* find_camera(const std::vector<BlockCamera>& cameras,
                                             const std::string& photo);

}  // namespace drape::io
