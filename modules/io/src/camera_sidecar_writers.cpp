// Formats as their programs read them: COLMAP documentation, "Output format"; MeshLab's shot_qt.h; Metashape
// Pro manual, appendix on camera models.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/io/camera_sidecars.hpp"

namespace drape::io {
namespace {

void check(const std::filesystem::path& file, SidecarFormat format,
           const std::vector<SidecarCamera>& cameras) {
  for (const SidecarCamera& c : cameras) {
    const std::string reason = reason_not_held(format, c.camera);
    if (!reason.empty()) throw input_error("{}: the camera of {} {}", file.string(), c.photo, reason);
    if (c.photo.find_first_of("\r\n") != std::string::npos)
      throw input_error("{}: a photo's name has a line break", file.string());
  }
}

/// Every number reads back to the same bits.
std::string text_of(double value) {
  return fmt::format("{}", value);
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string intrinsics_of(const Camera& camera) {
  return fmt::format("PINHOLE {} {} {} {} {} {}", camera.width, camera.height, text_of(camera.K(0, 0)),
                     text_of(camera.K(1, 1)), text_of(camera.K(0, 2)), text_of(camera.K(1, 2)));
}

template <class Matrix>
std::string values_of(const Matrix& matrix) {
  std::string text;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c)
      text += (text.empty() ? "" : " ") + text_of(matrix(r, c));
  return text;
}

}  // namespace

std::string reason_not_held(SidecarFormat format, const Camera& camera) {
  if (camera.projection == Camera::Projection::orthographic)
    return "is orthographic, which this format does not know";
  const double shear = std::abs(camera.K(0, 1));
  const double focal = std::abs(camera.K(0, 0));
  constexpr double negligible = 1e-9;
  if (format != SidecarFormat::metashape && shear > negligible * focal)
    return "has shear, which this format does not know";
  if (format == SidecarFormat::meshlab && std::abs(camera.K(0, 0) - camera.K(1, 1)) > 1e-4 * focal)
    return "has two different focal lengths, and a MeshLab project holds one";
  return {};
}

std::vector<std::filesystem::path> write_colmap(const std::filesystem::path& folder,
                                                const std::vector<SidecarCamera>& cameras) {
  check(folder, SidecarFormat::colmap, cameras);
  std::map<std::string, std::size_t> known;  // photos of one camera share its line
  std::string list =
      "# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  std::string images =
      "# Image list with two lines of data per image:\n"
      "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n#   POINTS2D[] as (X, Y, POINT3D_ID)\n";
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera& camera = cameras[i].camera;
    const auto [entry, added] = known.try_emplace(intrinsics_of(camera), known.size() + 1);
    if (added) list += fmt::format("{} {}\n", entry->second, entry->first);
    Eigen::Quaterniond q(camera.camera_from_world.linear());
    q.normalize();
    const Eigen::Vector3d t = camera.camera_from_world.translation();
    images += fmt::format("{} {} {} {} {} {} {} {} {} {}\n\n", i + 1, text_of(q.w()), text_of(q.x()),
                          text_of(q.y()), text_of(q.z()), text_of(t.x()), text_of(t.y()), text_of(t.z()),
                          entry->second, cameras[i].photo);
  }
  std::vector<std::filesystem::path> written = {folder / "cameras.txt", folder / "images.txt",
                                                folder / "points3D.txt"};
  make_folder(folder);
  write_file(written[0], list);
  write_file(written[1], images);
  write_file(written[2],
             "# 3D point list with one line of data per point:\n"
             "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n");
  return written;
}

void write_meshlab_project(const std::filesystem::path& file, const std::string& mesh,
                           const std::vector<SidecarCamera>& cameras) {
  check(file, SidecarFormat::meshlab, cameras);
  std::string text = "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n <MeshGroup>\n";
  text += fmt::format(
      "  <MLMesh label=\"{0}\" filename=\"{0}\">\n   <MLMatrix44>\n1 0 0 0 \n0 1 0 0 \n0 0 1 0 \n0 0 0 1 \n"
      "</MLMatrix44>\n  </MLMesh>\n </MeshGroup>\n <RasterGroup>\n",
      escaped(mesh));
  for (const SidecarCamera& c : cameras) {
    // Rows: right, up, backward. The translation is minus the camera's centre.
    Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
    rotation.topLeftCorner<3, 3>() =
        Eigen::Vector3d(1, -1, -1).asDiagonal() * c.camera.camera_from_world.linear();
    const Eigen::Vector3d center = -c.camera.center();
    text += fmt::format(
        "  <MLRaster label=\"{0}\">\n   <VCGCamera CameraType=\"0\" BinaryData=\"0\" TranslationVector=\"{1} "
        "1\" "
        "RotationMatrix=\"{2} \" ViewportPx=\"{3} {4}\" PixelSizeMm=\"1 1\" CenterPx=\"{5} {6}\" "
        "FocalMm=\"{7}\" LensDistortion=\"0 0\"/>\n   <Plane semantic=\"RGB\" fileName=\"{0}\"/>\n  "
        "</MLRaster>\n",
        escaped(c.photo), values_of(center), values_of(rotation), c.camera.width, c.camera.height,
        text_of(c.camera.K(0, 2)), text_of(c.camera.K(1, 2)),
        text_of((c.camera.K(0, 0) + c.camera.K(1, 1)) / 2));
  }
  write_file(file, text + " </RasterGroup>\n</MeshLabProject>\n");
}

void write_metashape_xml(const std::filesystem::path& file, const std::vector<SidecarCamera>& cameras) {
  check(file, SidecarFormat::metashape, cameras);
  std::string sensors;
  std::string list;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera& c = cameras[i].camera;
    // x = width / 2 + cx + (f + b1) X + b2 Y, y = height / 2 + cy + f Y.
    sensors += fmt::format(
        "   <sensor id=\"{0}\" label=\"{1}\" type=\"frame\">\n    <resolution width=\"{2}\" "
        "height=\"{3}\"/>\n"
        "    <calibration type=\"frame\" class=\"adjusted\">\n     <resolution width=\"{2}\" "
        "height=\"{3}\"/>\n"
        "     <f>{4}</f>\n     <cx>{5}</cx>\n     <cy>{6}</cy>\n     <b1>{7}</b1>\n     <b2>{8}</b2>\n"
        "    </calibration>\n   </sensor>\n",
        i, escaped(cameras[i].photo), c.width, c.height, text_of(c.K(1, 1)),
        text_of(c.K(0, 2) - c.width / 2.0), text_of(c.K(1, 2) - c.height / 2.0),
        text_of(c.K(0, 0) - c.K(1, 1)), text_of(c.K(0, 1)));
    list += fmt::format(
        "   <camera id=\"{0}\" sensor_id=\"{0}\" label=\"{1}\" enabled=\"true\">\n    "
        "<transform>{2}</transform>\n"
        "   </camera>\n",
        i, escaped(cameras[i].photo), values_of(c.camera_from_world.inverse().matrix()));
  }
  write_file(file,
             fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<document version=\"1.4.0\">\n"
                         " <chunk label=\"drape\" enabled=\"true\">\n  <sensors next_id=\"{0}\">\n{1}  "
                         "</sensors>\n  <cameras next_id=\"{0}\">\n{2}  </cameras>\n </chunk>\n</document>\n",
                         cameras.size(), sensors, list));
}

}  // namespace drape::io
