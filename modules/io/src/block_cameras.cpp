#include "drape/io/block_cameras.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <pugixml.hpp>
#include <string_view>

#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "rigid_part.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

namespace fs = std::filesystem;

std::string file_name(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  return std::string(slash == std::string_view::npos ? path : path.substr(slash + 1));
}

double number(const std::string& file, std::size_t line, std::string_view word) {
  const auto value = parse_value(word);
  if (!value || !std::isfinite(*value)) throw line_error(file, line, "{} is no number", shown(word));
  return *value;
}

std::vector<double> all_numbers(const std::string& file, std::size_t line, std::string_view text) {
  std::vector<double> numbers;
  Words words(text);
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    numbers.push_back(number(file, line, word));
  return numbers;
}

Eigen::Matrix3d intrinsics(double fx, double fy, double cx, double cy) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  return K;
}

// ---- COLMAP ("Output format" of its documentation)

struct ColmapModel {
  std::string_view name;
  std::size_t parameters;
  bool one_focal;
};
constexpr std::array<ColmapModel, 5> colmap_models{{{"SIMPLE_PINHOLE", 3, true},
                                                    {"PINHOLE", 4, false},
                                                    {"SIMPLE_RADIAL", 4, true},
                                                    {"RADIAL", 5, true},
                                                    {"OPENCV", 8, false}}};

BlockCamera colmap_lens(const std::string& file, std::size_t line, std::string_view model_name,
                        const std::vector<double>& sizes_and_parameters) {
  const auto model = std::find_if(colmap_models.begin(), colmap_models.end(),
                                  [&](const ColmapModel& m) { return m.name == model_name; });
  if (model == colmap_models.end())
    throw line_error(file, line,
                     "the camera model {} is not read (SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL and "
                     "OPENCV are); undistort the photos with colmap image_undistorter",
                     shown(model_name));
  if (sizes_and_parameters.size() != 2 + model->parameters)
    throw line_error(file, line, "{} needs width, height and {} parameters", model->name, model->parameters);
  BlockCamera camera;
  camera.width = static_cast<int>(sizes_and_parameters[0]);
  camera.height = static_cast<int>(sizes_and_parameters[1]);
  if (camera.width <= 0 || camera.height <= 0) throw line_error(file, line, "the photo has no pixels");
  std::vector<double> p(sizes_and_parameters.begin() + 2, sizes_and_parameters.end());
  if (model->one_focal) p.insert(p.begin(), p.front());
  camera.K = intrinsics(p[0], p[1], p[2], p[3]);
  p.erase(p.begin(), p.begin() + 4);
  if (!p.empty()) p.resize(4, 0.0);
  camera.distortion = p;
  return camera;
}

std::map<std::string, BlockCamera> read_colmap_lenses(const fs::path& path) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  std::map<std::string, BlockCamera> lenses;
  TextLines lines(bytes);
  while (lines.next_filled()) {
    if (lines.line().starts_with('#')) continue;
    Words words(lines.line());
    const std::string id(words.next());
    const std::string_view model = words.next();
    lenses[id] = colmap_lens(file, lines.number(), model, all_numbers(file, lines.number(), words.rest()));
  }
  return lenses;
}

std::vector<BlockCamera> read_colmap(const fs::path& path) {
  const std::string file = path.string();
  const auto lenses = read_colmap_lenses(path.parent_path() / "cameras.txt");
  const std::string bytes = read_file(path);
  std::vector<BlockCamera> cameras;
  TextLines lines(bytes);
  while (lines.next_filled()) {
    if (lines.line().starts_with('#')) continue;
    Words words(lines.line());
    (void)words.next();  // the image's number
    std::array<double, 7> n{};
    for (double& value : n) value = number(file, lines.number(), words.next());
    const auto lens = lenses.find(std::string(words.next()));
    if (lens == lenses.end()) throw line_error(file, lines.number(), "its camera is not in cameras.txt");
    BlockCamera camera = lens->second;
    camera.photo = std::string(words.rest());
    if (camera.photo.empty()) throw line_error(file, lines.number(), "the image has no name");
    const Eigen::Quaterniond q(n[0], n[1], n[2], n[3]);
    if (!(q.norm() > 0.5 && q.norm() < 2))
      throw line_error(file, lines.number(), "the quaternion has length {}, not 1", q.norm());
    camera.camera_from_block.linear() = q.normalized().toRotationMatrix();
    camera.camera_from_block.translation() = Eigen::Vector3d(n[4], n[5], n[6]);
    cameras.push_back(std::move(camera));
    lines.next();  // the image's points: may be an empty line
  }
  return cameras;
}

// ---- Bundler ("Bundler v0.4 User's Manual"): the camera looks along -z, y is up in the picture

std::vector<std::string> read_bundler_list(const fs::path& path) {
  const std::string bytes = read_file(path);
  std::vector<std::string> names;
  TextLines lines(bytes);
  while (lines.next_filled()) names.emplace_back(Words(lines.line()).next());
  return names;
}

std::vector<BlockCamera> read_bundler(const fs::path& path) {
  const std::string file = path.string();
  const std::vector<std::string> names = read_bundler_list(path.parent_path() / "list.txt");
  const std::string bytes = read_file(path);
  TextLines lines(bytes);
  const auto next = [&](std::size_t count) {
    do {
      if (!lines.next_filled())
        throw line_error(file, lines.number(), "the file ends before its last camera");
    } while (lines.line().starts_with('#'));
    std::vector<double> numbers = all_numbers(file, lines.number(), lines.line());
    if (numbers.size() != count) throw line_error(file, lines.number(), "{} numbers are expected", count);
    return numbers;
  };
  const double count = next(2)[0];
  if (count != static_cast<double>(names.size()))
    throw input_error("{}: has {} cameras, and list.txt beside it {} photos", file, count, names.size());
  std::vector<BlockCamera> cameras;
  for (const std::string& name : names) {
    const std::vector<double> lens = next(3);
    const std::size_t line = lines.number();
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    for (int row = 0; row < 3; ++row) {
      const std::vector<double> numbers = next(3);
      matrix.block<1, 3>(row, 0) = Eigen::RowVector3d(numbers[0], numbers[1], numbers[2]);
    }
    const std::vector<double> t = next(3);
    if (!(lens[0] > 0)) continue;  // not placed
    matrix.topRightCorner<3, 1>() = Eigen::Vector3d(t[0], t[1], t[2]);
    if (!is_rotation(matrix.topLeftCorner<3, 3>(), 1e-3))
      throw line_error(file, line, "the matrix of {} is no rotation", shown(name));
    BlockCamera camera;
    camera.photo = name;
    camera.K = intrinsics(lens[0], lens[0], 0, 0);
    if (lens[1] != 0 || lens[2] != 0) camera.distortion = {lens[1], lens[2], 0, 0};
    camera.camera_from_block =
        nearest_rigid(Eigen::Matrix4d(Eigen::Vector4d(1, -1, -1, 1).asDiagonal() * matrix));
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

// ---- Metashape ("Metashape Professional User Manual", camera models)

double value_of(const pugi::xml_node& node, const char* name) {
  return node.child(name).text().as_double(0);
}

// The adjusted calibration is what the cameras were placed with.
pugi::xml_node calibration_of(const pugi::xml_node& sensor) {
  const pugi::xml_node adjusted = sensor.find_child_by_attribute("calibration", "class", "adjusted");
  return adjusted ? adjusted : sensor.child("calibration");
}

BlockCamera metashape_lens(const std::string& file, const pugi::xml_node& sensor) {
  const std::string label = sensor.attribute("label").value();
  const pugi::xml_node calibration = calibration_of(sensor);
  const std::string type = calibration.attribute("type").value();
  if (type != "frame")
    throw input_error("{}: sensor {}: a calibration of type {} is not read (frame is)", file, shown(label),
                      shown(type));
  BlockCamera camera;
  const pugi::xml_node size = calibration.child("resolution");
  camera.width = size.attribute("width").as_int();
  camera.height = size.attribute("height").as_int();
  const double f = value_of(calibration, "f");
  if (camera.width <= 0 || camera.height <= 0 || !(f > 0))
    throw input_error("{}: sensor {} has no size or no focal length", file, shown(label));
  camera.K = intrinsics(f + value_of(calibration, "b1"), f, camera.width / 2.0 + value_of(calibration, "cx"),
                        camera.height / 2.0 + value_of(calibration, "cy"));
  camera.K(0, 1) = value_of(calibration, "b2");
  for (const char* further : {"k4", "p3", "p4"})
    if (value_of(calibration, further) != 0)
      throw input_error(
          "{}: sensor {} has the distortion {}, which is not known here; export with K1 to K3, "
          "P1 and P2",
          file, shown(label), further);
  // P1 and P2 are the other way round than OpenCV's.
  const std::vector<double> distortion = {value_of(calibration, "k1"), value_of(calibration, "k2"),
                                          value_of(calibration, "p2"), value_of(calibration, "p1"),
                                          value_of(calibration, "k3")};
  if (std::any_of(distortion.begin(), distortion.end(), [](double d) { return d != 0; }))
    camera.distortion = distortion;
  return camera;
}

std::vector<BlockCamera> read_metashape(const fs::path& path) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  pugi::xml_document document;
  if (const auto result = document.load_buffer(bytes.data(), bytes.size()); !result)
    throw byte_error(file, static_cast<std::uint64_t>(result.offset), "the XML is damaged: {}",
                     result.description());
  std::vector<BlockCamera> cameras;
  const pugi::xml_node chunk = document.child("document").child("chunk");
  const pugi::xml_node sensors = chunk.child("sensors");
  const std::function<void(const pugi::xml_node&)> read_group = [&](const pugi::xml_node& group) {
    for (const pugi::xml_node inner : group.children("group")) read_group(inner);
    for (const pugi::xml_node node : group.children("camera")) {
      const std::string label = node.attribute("label").value();
      const pugi::xml_node transform = node.child("transform");
      if (!transform) continue;  // not placed
      const std::vector<double> numbers = all_numbers(file, 1, transform.text().get());
      if (numbers.size() != 16)
        throw input_error("{}: the transform of {} has {} numbers, not 16", file, shown(label),
                          numbers.size());
      const Eigen::Matrix4d block_from_camera =
          Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
      if (!is_rotation(block_from_camera.topLeftCorner<3, 3>(), 1e-3))
        throw input_error("{}: the transform of {} is no rigid motion", file, shown(label));
      const pugi::xml_node sensor =
          sensors.find_child_by_attribute("sensor", "id", node.attribute("sensor_id").value());
      if (!sensor) throw input_error("{}: the sensor of {} is missing", file, shown(label));
      BlockCamera camera = metashape_lens(file, sensor);
      camera.photo = label;
      camera.camera_from_block = nearest_rigid(block_from_camera).inverse();
      cameras.push_back(std::move(camera));
    }
  };
  read_group(chunk.child("cameras"));
  return cameras;
}

struct BlockFormat {
  std::string_view extension;
  std::vector<BlockCamera> (*read)(const fs::path& file);
};
constexpr std::array<BlockFormat, 3> formats{
    {{"txt", read_colmap}, {"out", read_bundler}, {"xml", read_metashape}}};

}  // namespace

Eigen::Matrix3d BlockCamera::K_at(int photo_width, int photo_height) const {
  Eigen::Matrix3d result = K;
  if (width == 0) {
    result(0, 2) += photo_width / 2.0;
    result(1, 2) += photo_height / 2.0;
    return result;
  }
  result.row(0) *= static_cast<double>(photo_width) / width;
  result.row(1) *= static_cast<double>(photo_height) / height;
  return result;
}

bool is_block_file(const fs::path& file) {
  const std::string ending = extension(file);
  return std::any_of(formats.begin(), formats.end(),
                     [&](const BlockFormat& format) { return format.extension == ending; });
}

std::vector<BlockCamera> read_block_cameras(const fs::path& file) {
  const std::string ending = extension(file);
  for (const BlockFormat& format : formats) {
    if (format.extension != ending) continue;
    std::vector<BlockCamera> cameras = format.read(file);
    if (cameras.empty()) throw input_error("{}: holds no camera that was placed", file.string());
    return cameras;
  }
  throw input_error(
      "{}: is no file of cameras that can be read (COLMAP's images.txt, Bundler's .out, "
      "Metashape's .xml)",
      file.string());
}

const BlockCamera* find_camera(const std::vector<BlockCamera>& cameras, const std::string& photo) {
  for (const BlockCamera& camera : cameras)
    if (file_name(camera.photo) == photo) return &camera;
  const auto stem = [](const std::string& name) { return fs::path(name).stem().string(); };
  const BlockCamera* found = nullptr;
  for (const BlockCamera& camera : cameras) {
    const std::string name = file_name(camera.photo);
    if (name != stem(photo) && stem(name) != stem(photo)) continue;
    if (found != nullptr) return nullptr;
    found = &camera;
  }
  return found;
}

}  // namespace drape::io
