#include "drape/io/records.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"

namespace drape::io {
namespace {

using Json = nlohmann::ordered_json;

// --- reading: a value and the path by which it was reached, so that an error can name it

class Node {
 public:
  Node(const std::string& file, const Json& value, std::string path)
      : file_(file), value_(value), path_(std::move(path)) {}

  [[nodiscard]] Error error(const std::string& what) const {
    return input_error("{}: {}: {}", file_, path_.empty() ? "the file" : path_, what);
  }

  [[nodiscard]] bool has(const char* name) const {
    return value_.is_object() && value_.contains(name) && !value_[name].is_null();
  }
  [[nodiscard]] Node operator[](const char* name) const {
    if (!value_.is_object()) throw error("is no object");
    const Node member(file_, value_.contains(name) ? value_[name] : missing(),
                      path_.empty() ? name : path_ + "." + name);
    if (!value_.contains(name)) throw member.error("is missing");
    return member;
  }

  [[nodiscard]] std::size_t size() const {
    if (!value_.is_array()) throw error("is no list");
    return value_.size();
  }
  [[nodiscard]] Node at(std::size_t i) const {
    return {file_, value_[i], path_ + "[" + std::to_string(i) + "]"};
  }

  [[nodiscard]] double number() const {
    if (!value_.is_number()) throw error("is no number");
    const auto number = value_.get<double>();
    if (!std::isfinite(number)) throw error("is not finite");
    return number;
  }
  [[nodiscard]] std::int64_t integer(std::int64_t least, std::int64_t most) const {
    const double value = number();
    if (value != std::floor(value) || value < static_cast<double>(least) || value > static_cast<double>(most))
      throw error(fmt::format("is no whole number within {} and {}", least, most));
    return static_cast<std::int64_t>(value);
  }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(integer(0, std::int64_t{1} << 53));
  }
  [[nodiscard]] bool flag() const {
    if (!value_.is_boolean()) throw error("is neither true nor false");
    return value_.get<bool>();
  }
  [[nodiscard]] std::string text() const {
    if (!value_.is_string()) throw error("is no text");
    return value_.get<std::string>();
  }
  [[nodiscard]] std::map<std::string, std::size_t> counts() const {
    if (!value_.is_object()) throw error("is no object");
    std::map<std::string, std::size_t> counts;
    for (const auto& [name, value] : value_.items())
      counts[name] = Node(file_, value, path_ + "." + name).count();
    return counts;
  }

  template <int Rows, int Columns>
  [[nodiscard]] Eigen::Matrix<double, Rows, Columns> matrix() const {
    if (size() != Rows) throw error(fmt::format("should have {} rows", Rows));
    Eigen::Matrix<double, Rows, Columns> m;
    for (int row = 0; row < Rows; ++row) {
      const Node line = at(static_cast<std::size_t>(row));
      if (line.size() != Columns) throw line.error(fmt::format("should have {} numbers", Columns));
      for (int column = 0; column < Columns; ++column)
        m(row, column) = line.at(static_cast<std::size_t>(column)).number();
    }
    return m;
  }
  [[nodiscard]] Eigen::Vector3d vector() const {
    if (size() != 3) throw error("should have 3 numbers");
    return {at(0).number(), at(1).number(), at(2).number()};
  }
  [[nodiscard]] Rigid3 rigid() const {
    const Eigen::Matrix4d m = matrix<4, 4>();
    const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
    const bool last_row = m.row(3) == Eigen::RowVector4d(0, 0, 0, 1);
    if (!last_row || (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-6 ||
        R.determinant() < 0)
      throw error("is no rigid motion (rotation and translation)");
    Rigid3 rigid = Rigid3::Identity();
    rigid.matrix() = m;
    return rigid;
  }

 private:
  static const Json& missing() {
    static const Json nothing;
    return nothing;
  }

  const std::string& file_;
  const Json& value_;
  std::string path_;
};

Json parsed(const std::string& file) {
  const std::string text = read_file(file);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& problem) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(problem.byte, text.size()));
    throw input_error("{}:{}: is no valid JSON", file, 1 + std::count(text.begin(), end, '\n'));
  }
}

WorkspaceFrame frame_of(const Node& root) {
  if (root["units"].text() != "m") throw root["units"].error("should be \"m\"");
  WorkspaceFrame frame;
  frame.world_offset_m = root["world_offset_m"].vector();
  if (root.has("metres_per_input_unit")) frame.metres_per_input_unit = root["metres_per_input_unit"].number();
  if (frame.metres_per_input_unit <= 0) throw root["metres_per_input_unit"].error("should be more than 0");
  return frame;
}

// --- writing

/// Refuses what JSON cannot hold. A number that is not finite here is a mistake of the caller's.
Json json_of(double number, const char* name) {
  if (!std::isfinite(number))
    throw Error(ErrorCode::bug, fmt::format("{} is not finite and cannot be recorded", name));
  return number;
}

template <class Vector>
Json list_of(const Vector& values, const char* name) {
  Json list = Json::array();
  for (const double value : values) list.push_back(json_of(value, name));
  return list;
}

template <class Matrix>
Json rows_of(const Matrix& m, const char* name) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < m.rows(); ++row) {
    Json line = Json::array();
    for (Eigen::Index column = 0; column < m.cols(); ++column) line.push_back(json_of(m(row, column), name));
    rows.push_back(std::move(line));
  }
  return rows;
}

Json json_of(const std::optional<double>& number, const char* name) {
  return number ? json_of(*number, name) : Json();
}

Json start(const WorkspaceFrame& frame) {
  return {{"units", "m"},
          {"world_offset_m", list_of(frame.world_offset_m, "world_offset_m")},
          {"metres_per_input_unit", json_of(frame.metres_per_input_unit, "metres_per_input_unit")}};
}

void save(const std::filesystem::path& file, const Json& root) {
  // File names need not be UTF-8; JSON must be.
  write_file(file, root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

// --- parts

Json json_of(const ScanView& view) {
  if (view.kind == ScanView::Kind::unknown) return {};
  return {{view.kind == ScanView::Kind::origin ? "origin" : "direction", list_of(view.vector, "view")}};
}

ScanView view_of(const Node& record) {
  if (!record.has("view")) {
    (void)record["view"];
    return {};
  }
  const Node view = record["view"];
  if (view.has("origin")) return {ScanView::Kind::origin, view["origin"].vector()};
  return {ScanView::Kind::direction, view["direction"].vector()};
}

std::optional<std::array<int, 2>> grid_of(const Node& record) {
  if (!record.has("grid")) {
    (void)record["grid"];
    return std::nullopt;
  }
  const Node grid = record["grid"];
  if (grid.size() != 2) throw grid.error("should be [rows, columns]");
  const auto extent = [&](std::size_t i) { return static_cast<int>(grid.at(i).integer(1, 1 << 30)); };
  return std::array<int, 2>{extent(0), extent(1)};
}

Verdict verdict_of(const Node& node) {
  const std::string text = node.text();
  for (const Verdict verdict : {Verdict::accept, Verdict::review, Verdict::reject})
    if (text == to_string(verdict)) return verdict;
  throw node.error("should be accept, review or reject");
}

/// One number for two focal lengths: their geometric mean. An orthographic camera has none.
Json focal_of(const Camera& camera) {
  if (camera.projection == Camera::Projection::orthographic) return {};
  return json_of(std::sqrt(std::abs(camera.K(0, 0) * camera.K(1, 1))), "focal_px");
}

Json json_of(const CameraRecord& record) {
  const Camera& camera = record.camera;
  const bool orthographic = camera.projection == Camera::Projection::orthographic;
  Json json = {{"photo", record.photo},
               {"width", camera.width},
               {"height", camera.height},
               {"projection", orthographic ? "orthographic" : "perspective"},
               {"P", rows_of(camera.P(), "P")},
               {"K", rows_of(camera.K, "K")},
               {"camera_from_world", rows_of(camera.camera_from_world.matrix(), "camera_from_world")},
               {"focal_px", focal_of(camera)},
               {"distortion", nullptr},
               {"overlap_percent", json_of(record.overlap_percent, "overlap_percent")},
               {"boundary_error_px", json_of(record.boundary_error_px, "boundary_error_px")},
               {"edge_support", json_of(record.edge_support, "edge_support")},
               {"verdict", to_string(record.verdict)},
               {"reasons", record.reasons},
               {"evidence", record.evidence},
               {"method", record.method},
               {"stencil", record.stencil},
               {"sigma", nullptr},
               {"candidates", Json::array()}};
  if (record.sigma)
    json["sigma"] = {{"rotation_deg", json_of(record.sigma->rotation_deg, "rotation_deg")},
                     {"direction_deg", json_of(record.sigma->direction_deg, "direction_deg")},
                     {"focal_percent", json_of(record.sigma->focal_percent, "focal_percent")}};
  for (const CameraCandidate& candidate : record.candidates)
    json["candidates"].push_back(
        {{"P", rows_of(candidate.P, "candidates.P")},
         {"overlap_percent", json_of(candidate.overlap_percent, "candidates.overlap_percent")},
         {"score", json_of(candidate.score, "candidates.score")},
         {"verdict", to_string(candidate.verdict)}});
  return json;
}

Camera camera_of(const Node& node) {
  Camera camera;
  camera.width = static_cast<int>(node["width"].integer(1, 1 << 24));
  camera.height = static_cast<int>(node["height"].integer(1, 1 << 24));
  const std::string projection = node["projection"].text();
  if (projection != "perspective" && projection != "orthographic")
    throw node["projection"].error("should be perspective or orthographic");
  camera.projection =
      projection == "perspective" ? Camera::Projection::perspective : Camera::Projection::orthographic;
  camera.K = node["K"].matrix<3, 3>();
  if (camera.K.row(2) != Eigen::RowVector3d(0, 0, 1) || camera.K(0, 0) == 0 || camera.K(1, 1) == 0)
    throw node["K"].error("is no camera matrix");
  camera.camera_from_world = node["camera_from_world"].rigid();
  if (node.has("distortion"))
    throw node["distortion"].error("should be null: cameras belong to undistorted pixels");
  // P is there for other tools; a file in which the two disagree was edited by halves.
  const Eigen::Matrix<double, 3, 4> P = node["P"].matrix<3, 4>();
  if ((P - camera.P()).norm() > 1e-6 * camera.P().norm())
    throw node["P"].error("is not the product of K and camera_from_world");
  return camera;
}

CameraRecord camera_record_of(const Node& node) {
  CameraRecord record;
  record.photo = node["photo"].text();
  record.camera = camera_of(node);
  record.overlap_percent = node["overlap_percent"].number();
  if (node.has("boundary_error_px")) record.boundary_error_px = node["boundary_error_px"].number();
  if (node.has("edge_support")) record.edge_support = node["edge_support"].number();
  record.verdict = verdict_of(node["verdict"]);
  const Node reasons = node["reasons"];
  for (std::size_t i = 0; i < reasons.size(); ++i) record.reasons.push_back(reasons.at(i).text());
  record.evidence = node["evidence"].text();
  record.method = node["method"].text();
  record.stencil = node["stencil"].text();
  if (node.has("sigma")) {
    const Node sigma = node["sigma"];
    record.sigma = CameraSigma{sigma["rotation_deg"].number(), sigma["direction_deg"].number(),
                               sigma["focal_percent"].number()};
  }
  const Node candidates = node["candidates"];
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Node c = candidates.at(i);
    record.candidates.push_back({c["P"].matrix<3, 4>(), c["overlap_percent"].number(), c["score"].number(),
                                 verdict_of(c["verdict"])});
  }
  return record;
}

}  // namespace

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::accept:
      return "accept";
    case Verdict::review:
      return "review";
    case Verdict::reject:
      return "reject";
  }
  return {};
}

void write_scans(const std::filesystem::path& file, const ScansRecord& record) {
  Json root = start(record.frame);
  root["scans"] = Json::array();
  for (const ScanRecord& scan : record.scans) {
    Json dropped = Json::object();
    for (const auto& [filter, points] : scan.dropped) dropped[filter] = points;
    root["scans"].push_back({{"file", scan.file},
                             {"index_in_file", scan.index_in_file},
                             {"points", scan.points},
                             {"grid", scan.grid ? Json(*scan.grid) : Json()},
                             {"view", json_of(scan.view)},
                             {"spacing_m", json_of(scan.spacing_m, "spacing_m")},
                             {"dropped", std::move(dropped)},
                             {"scan_offset_m", list_of(scan.scan_offset_m, "scan_offset_m")}});
  }
  save(file, root);
}

ScansRecord read_scans_record(const std::filesystem::path& file) {
  const std::string name = file.string();
  const Json json = parsed(name);
  const Node root(name, json, "");
  ScansRecord record;
  record.frame = frame_of(root);
  const Node scans = root["scans"];
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Node scan = scans.at(i);
    record.scans.push_back({scan["file"].text(), static_cast<int>(scan["index_in_file"].integer(0, 1 << 30)),
                            scan["points"].count(), grid_of(scan), view_of(scan), scan["spacing_m"].number(),
                            scan["dropped"].counts(), scan["scan_offset_m"].vector()});
  }
  return record;
}

void write_poses(const std::filesystem::path& file, const PosesRecord& record) {
  Json root = start(record.frame);
  root["scans"] = Json::array();
  for (const PoseRecord& pose : record.scans)
    root["scans"].push_back({{"file", pose.file},
                             {"index_in_file", pose.index_in_file},
                             {"world_from_scan", rows_of(pose.world_from_scan.matrix(), "world_from_scan")},
                             {"status", pose.placed ? "placed" : "unplaced"},
                             {"reason", pose.reason},
                             {"rms_m", json_of(pose.rms_m, "rms_m")},
                             {"overlap", json_of(pose.overlap, "overlap")}});
  root["pairs"] = Json::array();
  for (const PairRecord& pair : record.pairs)
    root["pairs"].push_back({{"first", pair.first},
                             {"second", pair.second},
                             {"rms_m", json_of(pair.rms_m, "rms_m")},
                             {"overlap", json_of(pair.overlap, "overlap")},
                             {"seen_through", json_of(pair.seen_through, "seen_through")},
                             {"in_void", json_of(pair.in_void, "in_void")},
                             {"hold", json_of(pair.hold, "hold")},
                             {"verdict", pair.accepted ? "accept" : "reject"},
                             {"reason", pair.reason}});
  save(file, root);
}

PosesRecord read_poses(const std::filesystem::path& file) {
  const std::string name = file.string();
  const Json json = parsed(name);
  const Node root(name, json, "");
  PosesRecord record;
  record.frame = frame_of(root);
  const Node scans = root["scans"];
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Node scan = scans.at(i);
    const std::string status = scan["status"].text();
    if (status != "placed" && status != "unplaced")
      throw scan["status"].error("should be placed or unplaced");
    record.scans.push_back({scan["file"].text(), static_cast<int>(scan["index_in_file"].integer(0, 1 << 30)),
                            scan["world_from_scan"].rigid(), status == "placed", scan["reason"].text(),
                            scan["rms_m"].number(), scan["overlap"].number()});
  }
  if (!root.has("pairs")) return record;  // older truth files have none
  const Node pairs = root["pairs"];
  const auto count = static_cast<std::int64_t>(record.scans.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Node pair = pairs.at(i);
    const std::string verdict = pair["verdict"].text();
    if (verdict != "accept" && verdict != "reject") throw pair["verdict"].error("should be accept or reject");
    record.pairs.push_back({static_cast<std::size_t>(pair["first"].integer(0, count - 1)),
                            static_cast<std::size_t>(pair["second"].integer(0, count - 1)),
                            pair["rms_m"].number(), pair["overlap"].number(), pair["seen_through"].number(),
                            pair["in_void"].number(), pair["hold"].number(), verdict == "accept",
                            pair["reason"].text()});
  }
  return record;
}

void write_holes(const std::filesystem::path& file, const HolesRecord& record) {
  Json root = start(record.frame);
  root["spacing_m"] = json_of(record.spacing_m, "spacing_m");
  root["holes"] = Json::array();
  for (const HoleRecord& hole : record.holes)
    root["holes"].push_back({{"boundary_edges", hole.boundary_edges},
                             {"length_m", json_of(hole.length_m, "length_m")},
                             {"length_spacings", json_of(hole.length_spacings, "length_spacings")},
                             {"area_m2", json_of(hole.area_m2, "area_m2")},
                             {"flatness_m", json_of(hole.flatness_m, "flatness_m")},
                             {"center", list_of(hole.center, "center")},
                             {"action", hole.action},
                             {"why", hole.why},
                             {"faces_added", hole.faces_added}});
  save(file, root);
}

HolesRecord read_holes(const std::filesystem::path& file) {
  const std::string name = file.string();
  const Json json = parsed(name);
  const Node root(name, json, "");
  HolesRecord record;
  record.frame = frame_of(root);
  record.spacing_m = root["spacing_m"].number();
  const Node holes = root["holes"];
  for (std::size_t i = 0; i < holes.size(); ++i) {
    const Node hole = holes.at(i);
    record.holes.push_back({hole["boundary_edges"].count(), hole["length_m"].number(),
                            hole["length_spacings"].number(), hole["area_m2"].number(),
                            hole["flatness_m"].number(), hole["center"].vector(), hole["action"].text(),
                            hole["why"].text(), hole["faces_added"].count()});
  }
  return record;
}

void write_cameras(const std::filesystem::path& file, const CamerasRecord& record) {
  Json root = start(record.frame);
  root["cameras"] = Json::array();
  for (const CameraRecord& camera : record.cameras) root["cameras"].push_back(json_of(camera));
  save(file, root);
}

CamerasRecord read_cameras(const std::filesystem::path& file) {
  const std::string name = file.string();
  const Json json = parsed(name);
  const Node root(name, json, "");
  CamerasRecord record;
  record.frame = frame_of(root);
  const Node cameras = root["cameras"];
  for (std::size_t i = 0; i < cameras.size(); ++i) record.cameras.push_back(camera_record_of(cameras.at(i)));
  return record;
}

}  // namespace drape::io
