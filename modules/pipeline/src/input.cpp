#include "input_section.hpp"
#include "map_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/base/options.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

void describe_units(Binder& binder, Units& units) {
  binder.choice("units", units,
                {{"auto", Units::guess},
                 {"m", Units::metres},
                 {"cm", Units::centimetres},
                 {"mm", Units::millimetres},
                 {"in", Units::inches},
                 {"ft", Units::feet}},
                "");
}

/// The options of `binder` that the section has.
void assign_options(Binder& binder, MapReader& reader) {
  for (const Option& option : binder.options()) {
    const ConfigNode* value = reader.find(option.name);
    if (value == nullptr) continue;
    const auto parsed = parse_option(option, value->text);
    if (std::holds_alternative<std::string>(parsed))
      reader.wrong(*value, option.name, std::get<std::string>(parsed));
    else
      option.assign(std::get<OptionValue>(parsed));
  }
}

/// Row by row; nothing if the numbers are no rigid motion.
std::optional<std::array<double, 16>> rigid_matrix(const std::vector<double>& numbers) {
  std::array<double, 16> m{};
  m[15] = 1;
  if (numbers.size() == 7) {
    double norm = 0;
    for (std::size_t k = 3; k < 7; ++k) norm += numbers[k] * numbers[k];
    if (!(norm > 0.25 && norm < 4)) return std::nullopt;
    const double s = 2 / norm, w = numbers[3], x = numbers[4], y = numbers[5], z = numbers[6];
    const std::array<double, 9> r{1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
                                  s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
                                  s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
    for (std::size_t i = 0; i < 3; ++i) {
      std::copy_n(r.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                  m.begin() + static_cast<std::ptrdiff_t>(4 * i));
      m[4 * i + 3] = numbers[i];
    }
    return m;
  }
  std::copy(numbers.begin(), numbers.end(), m.begin());
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      double dot = 0;
      for (std::size_t k = 0; k < 3; ++k) dot += m[4 * i + k] * m[4 * j + k];
      if (!(std::abs(dot - (i == j ? 1 : 0)) < 1e-3)) return std::nullopt;
    }
  const double determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                             m[2] * (m[4] * m[9] - m[5] * m[8]);
  return determinant > 0 ? std::optional(m) : std::nullopt;
}

void read_scan_motion(MapReader& reader, ScanInput& scan) {
  for (const auto& [key, least, most] : {std::tuple{"pose", 7U, 7U}, {"transform", 12U, 16U}}) {
    const std::vector<double> numbers = reader.numbers(key, least, most);
    if (numbers.empty()) continue;
    if (scan.world_from_scan)
      reader.wrong(*reader.find(key), key, "stands beside a pose; leave one of them out");
    else if (scan.world_from_scan = rigid_matrix(numbers); !scan.world_from_scan || numbers.size() % 4 == 1)
      reader.wrong(*reader.find(key), key, "is no rigid motion");
  }
}

/// A name or pattern, or a section for one.
void read_scan_input(const ConfigNode& node, const std::string& path, const fs::path& folder, Input& input,
                     InputProblems& problems) {
  ConfigNode map = node;
  if (node.kind == ConfigNode::Kind::scalar) {
    map = ConfigNode{};
    map.kind = ConfigNode::Kind::map;
    map.where = node.where;
    map.keys.push_back({"file", node.where});
    map.items.push_back(node);
  }
  MapReader reader(map, path, scan_keys(), problems);
  ScanInput scan;
  read_scan_motion(reader, scan);
  if (const ConfigNode* units = reader.find("units"); units != nullptr) {
    Units own = Units::guess;
    Binder binder;
    describe_units(binder, own);
    assign_options(binder, reader);
    scan.metres_per_unit = metres_per_unit(own);
    if (input.units == Units::guess) reader.wrong(*units, "units", "needs input.units as well");
  }
  if (reader.find("file") == nullptr && map.kind == ConfigNode::Kind::map)
    problems.wrong.push_back(fmt::format("{}: {}: has no file", node.where.text(), path));
  for (const fs::path& file : reader.files("file", folder)) {
    scan.file = file;
    input.scans.push_back(scan);
  }
}

DepthInput read_depth_input(const ConfigNode& node, InputProblems& problems) {
  MapReader reader(node, "input.depth", depth_keys(), problems);
  DepthInput depth;
  if (const auto focal = reader.numbers("focal_px", 1, 2); focal.empty())
    problems.wrong.push_back(fmt::format("{}: input.depth: has no focal_px", node.where.text()));
  else if (!(focal.front() > 0 && focal.back() > 0))
    reader.wrong(*reader.find("focal_px"), "focal_px", "must be more than 0");
  else
    depth.focal_px = {focal.front(), focal.back()};
  if (const auto center = reader.numbers("center_px", 2, 2); !center.empty())
    depth.center_px = {center[0], center[1]};
  if (const auto values = reader.numbers("values_per_unit", 1, 1); !values.empty()) {
    depth.values_per_unit = values[0];
    if (!(values[0] > 0))
      reader.wrong(*reader.find("values_per_unit"), "values_per_unit", "must be more than 0");
  }
  const ConfigNode* kind = reader.find("depth");
  if (kind == nullptr || (kind->text != "z" && kind->text != "range"))
    problems.wrong.push_back(fmt::format("{}: input.depth.depth: must be z or range", node.where.text()));
  else
    depth.along_ray = kind->text == "range";
  return depth;
}

}  // namespace

const std::vector<InputKey>& input_keys() {
  static const std::vector<InputKey> keys = {
      {"scans",
       "scan files or patterns (scans/*.ply), relative to the configuration, or sections with file and what "
       "is known "
       "of it"},
      {"columns",
       "columns of scans as text, where the guess is wrong: x, y, z, nx, ny, nz, red, green, blue, "
       "intensity, confidence, - for others"},
      {"depth", "what depth pictures among the scans mean"},
      {"max_points_per_scan",
       "a scan with more points is thinned on a voxel grid while it is read; 0 keeps all; default: 50000000"},
      {"poses", "poses of the scans: a Stanford .conf, a MeshLab .aln or .mlp"},
      {"units", "units of the scans or the mesh: m, cm, mm, in, ft; auto guesses from their size"},
      {"up", "axis of the input that points up: x, y or z"},
      {"mesh", "a mesh to start from, instead of scans"},
      {"cameras",
       "cameras of the photos: drape's cameras.json, or a photogrammetry program's: COLMAP's images.txt "
       "(with "
       "cameras.txt beside it), Bundler's .out (with list.txt), Metashape's .xml; see align.block"},
      {"photos", "the photos: file names, or sections with image and what is known of it"},
  };
  return keys;
}

const std::vector<InputKey>& scan_keys() {
  static const std::vector<InputKey> keys = {
      {"file", "the scan file, or a pattern"},
      {"units", "units of this file: m, cm, mm, in, ft; input.units must be set too"},
      {"pose", "tx, ty, tz, qw, qx, qy, qz from the scan's frame to the world's, in the units of the input"},
      {"transform", "the same as twelve or sixteen numbers of a matrix, row by row"},
  };
  return keys;
}

const std::vector<InputKey>& depth_keys() {
  static const std::vector<InputKey> keys = {
      {"focal_px", "focal length in pixels: one number, or two for x and y"},
      {"center_px", "principal point in pixels, counted from the picture's corner; default: its centre"},
      {"values_per_unit",
       "the picture's numbers that make one unit of the input (1000 for millimetres in a picture and metres "
       "in the input); default: 1"},
      {"depth", "z for distances along the camera's axis, range for distances from the camera"},
  };
  return keys;
}

const std::vector<InputKey>& photo_keys() {
  static const std::vector<InputKey> keys = {
      {"image", "the photo"},
      {"mask",
       "a picture of the photo's size: white where the object is, black elsewhere, grey (128) unknown"},
      {"scribbles",
       "a picture of the photo's size: white strokes on the object, black on the background, grey (128) "
       "elsewhere"},
      {"background", "a photo of the same view without the object, by the same camera"},
      {"box_px", "x, y, width, height of a box around the object, in upright pixels"},
      {"click_px", "x, y of a point inside the object, in upright pixels"},
      {"strokes", "lines drawn over the object and over the background"},
      {"segments", "labels of segments.json: exactly these are the object in this photo"},
      {"camera",
       "what is known of the camera: focal_px or K, distortion; and about where it is: initial or points"},
  };
  return keys;
}

const std::vector<InputKey>& photo_camera_keys() {
  static const std::vector<InputKey> keys = {
      {"focal_px", "focal length in pixels of the upright photo"},
      {"K", "nine numbers of the 3x3 camera matrix, row by row"},
      {"distortion", "k1, k2, p1, p2 and perhaps k3, as OpenCV defines them"},
      {"initial",
       "twelve numbers of a projection from the input's coordinates to upright pixels, row by row: only "
       "poses near it "
       "are tried"},
      {"points",
       "four or more pairs of a place in the photo and on the object, five numbers each: x, y in upright "
       "pixels and X, "
       "Y, Z in the input's coordinates; only poses near the one that they tell are tried"},
  };
  return keys;
}

const std::vector<InputKey>& stroke_keys() {
  static const std::vector<InputKey> keys = {
      {"is", "object or background"},
      {"width_px", "width of the line; default: 1"},
      {"points_px", "x and y of its corners in upright pixels, one after the other"},
  };
  return keys;
}

std::optional<double> metres_per_unit(Units units) {
  switch (units) {
    case Units::guess:
      return std::nullopt;
    case Units::metres:
      return 1.0;
    case Units::centimetres:
      return 0.01;
    case Units::millimetres:
      return 0.001;
    case Units::inches:
      return 0.0254;
    case Units::feet:
      return 0.3048;
  }
  return std::nullopt;
}

// Without it the file of cameras cannot be read; which is told where that is tried.
fs::path file_beside(const fs::path& cameras) {
  const std::string ending = extension(cameras);
  const fs::path beside = ending == "txt"   ? cameras.parent_path() / "cameras.txt"
                          : ending == "out" ? cameras.parent_path() / "list.txt"
                                            : fs::path();
  std::error_code ignored;
  return !beside.empty() && fs::is_regular_file(beside, ignored) ? beside : fs::path();
}

Input read_input_section(const ConfigNode& node, const fs::path& folder, InputProblems& problems) {
  MapReader reader(node, "input", input_keys(), problems);
  Input input;
  input.poses = reader.file("poses", folder);
  input.mesh = reader.file("mesh", folder);
  input.cameras = reader.file("cameras", folder);
  input.cameras_beside = file_beside(input.cameras);

  struct Scalars {
    Units units = Units::guess;
    char up = 'z';
  } scalars;
  Binder binder;
  describe_units(binder, scalars.units);
  binder.number("max_points_per_scan", input.max_points_per_scan, {0, 2e9}, "");
  binder.choice("up", scalars.up, {{"x", 'x'}, {"y", 'y'}, {"z", 'z'}}, "");
  assign_options(binder, reader);
  input.units = scalars.units;
  input.up = scalars.up;
  if (const ConfigNode* scans = reader.find("scans"); scans != nullptr) {
    if (scans->kind == ConfigNode::Kind::sequence)
      for (std::size_t i = 0; i < scans->items.size(); ++i)
        read_scan_input(scans->items[i], fmt::format("input.scans[{}]", i), folder, input, problems);
    else
      read_scan_input(*scans, "input.scans", folder, input, problems);
  }
  if (const ConfigNode* columns = reader.find("columns"); columns != nullptr)
    input.columns = reader.texts(*columns, "columns");
  if (const ConfigNode* depth = reader.find("depth"); depth != nullptr)
    input.depth = read_depth_input(*depth, problems);

  if (const ConfigNode* photos = reader.find("photos"); photos != nullptr) {
    if (photos->kind != ConfigNode::Kind::sequence)
      reader.wrong(*photos, "photos", "must be a list");
    else
      for (std::size_t i = 0; i < photos->items.size(); ++i)
        input.photos.push_back(
            read_photo_input(photos->items[i], fmt::format("input.photos[{}]", i), folder, problems));
  }
  if (input.scans.empty() && input.mesh.empty() && problems.wrong.empty() && problems.missing.empty())
    problems.wrong.push_back(fmt::format("{}: input has neither scans nor a mesh", node.where.text()));
  if (!input.scans.empty() && !input.mesh.empty())
    problems.wrong.push_back(
        fmt::format("{}: input has both scans and a mesh; leave one of them out", node.where.text()));
  return input;
}

std::string unknown_key(const ConfigNode::Key& key, const std::string& section,
                        const std::vector<std::string>& names) {
  const std::string guess = closest(key.name, names);
  return fmt::format("{}: {}{}: no such key{}", key.where.text(), section.empty() ? "" : section + ".",
                     key.name, guess.empty() ? "" : "; did you mean " + guess + "?");
}

}  // namespace drape::pipeline
