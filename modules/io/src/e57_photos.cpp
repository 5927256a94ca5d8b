// The photos of an E57 file (ASTM E2807): images2D.
#include <cmath>
#include <iterator>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/io/scan_files.hpp"
#include "e57_file.hpp"
#include "e57_pose.hpp"
#include "picture_codec.hpp"
#include "picture_header.hpp"
#include "scan_formats.hpp"

namespace drape::io {
namespace {

/// Focal length and pixel size are metres, the principal point pixels. An E57 camera looks along -z with y
/// up.
std::optional<Camera> camera_of(const std::string& file, pugi::xml_node picture, pugi::xml_node pinhole,
                                const Image8& pixels) {
  const auto number = [&](const char* name) { return e57_number(file, pinhole, name).value_or(0); };
  Camera camera;
  camera.width = pixels.width();
  camera.height = pixels.height();
  camera.K(0, 0) = number("focalLength") / number("pixelWidth");
  camera.K(1, 1) = number("focalLength") / number("pixelHeight");
  camera.K(0, 2) = number("principalPointX");
  camera.K(1, 2) = number("principalPointY");
  if (!camera.K.allFinite() || !(camera.K(0, 0) > 0) || !(camera.K(1, 1) > 0)) return std::nullopt;
  if (const auto world_from_camera = e57_pose(file, picture))
    camera.camera_from_world = world_from_camera->inverse();
  camera.camera_from_world = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()) * camera.camera_from_world;
  return camera;
}

}  // namespace

std::vector<EmbeddedPhoto> read_embedded_photos(const std::filesystem::path& path) {
  const FileBytes bytes(path);
  std::vector<EmbeddedPhoto> photos;
  if (!looks_like_e57(bytes.view())) return photos;
  const std::string file = path.string();
  const E57Document document(file, bytes.view());
  for (const pugi::xml_node picture : document.root().child("images2D").children("vectorChild")) {
    const pugi::xml_node pinhole = picture.child("pinholeRepresentation");
    const pugi::xml_node form = pinhole ? pinhole : picture.child("visualReferenceRepresentation");
    const pugi::xml_node blob = form.child("jpegImage") ? form.child("jpegImage") : form.child("pngImage");
    if (!blob) continue;
    const std::string coded = e57_blob(document.pages(), blob);
    if (!coded.starts_with("\x89PNG") && !coded.starts_with("\xFF\xD8")) {
      log::warn("{}: an embedded picture is neither JPEG nor PNG and is left out", file);
      continue;
    }
    (void)read_picture_header(file, coded);
    EmbeddedPhoto& photo = photos.emplace_back();
    photo.pixels = decode_picture(file, coded).pixels;
    if (pinhole) photo.camera = camera_of(file, picture, pinhole, photo.pixels);
  }
  return photos;
}

std::size_t count_embedded_photos(const std::filesystem::path& path) {
  const FileBytes bytes(path);
  if (!looks_like_e57(bytes.view())) return 0;
  const std::string file = path.string();
  const E57Document document(file, bytes.view());
  const auto pictures = document.root().child("images2D").children("vectorChild");
  return static_cast<std::size_t>(std::distance(pictures.begin(), pictures.end()));
}

}  // namespace drape::io
