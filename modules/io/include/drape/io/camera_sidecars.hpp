// Cameras in the files of other programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drape/geometry/camera.hpp"

namespace drape::io {

/// One photo and the camera that took it, in the frame and unit of the model beside it.
struct SidecarCamera {
  std::string photo;  // file name as the other program is to find it
  Camera camera;
};

/// COLMAP's text model: <folder>/cameras.txt, images.txt, points3D.txt (empty). PINHOLE with two focal
/// lengths; world to camera, x right, y down, z forward, quaternion with w first; pixel centres at +0.5.
/// Files that are written, in that order.
std::vector<std::filesystem::path> write_colmap(const std::filesystem::path& folder,
                                                const std::vector<SidecarCamera>& cameras);

/// MeshLab project: `mesh` and the photos as rasters with their shots. The principal point is written as it
/// is; MeshLab is known to draw such off-centre shots wrongly in some tools (meshlab issue 84).
void write_meshlab_project(const std::filesystem::path& file, const std::string& mesh,
                           const std::vector<SidecarCamera>& cameras);

/// Metashape (PhotoScan) camera XML: sensors with f, cx, cy, b1 and b2, camera to world transforms.
void write_metashape_xml(const std::filesystem::path& file, const std::vector<SidecarCamera>& cameras);

enum class SidecarFormat { colmap, meshlab, metashape };
/// Why the format cannot hold the camera; empty if it can. The writers above throw Error{input} with it. None
/// holds an orthographic camera; only Metashape's holds shear; MeshLab's holds neither shear nor two focal
/// lengths.
[[nodiscard]] std::string reason_not_held(SidecarFormat format, const Camera& camera);

}  // namespace drape::io
