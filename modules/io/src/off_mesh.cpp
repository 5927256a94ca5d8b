// OFF (Geomview manual, "Object File Format"), ASCII.
#include <array>
#include <cmath>

#include "attribute_scale.hpp"
#include "drape/base/log.hpp"
#include "drape/base/numbers.hpp"
#include "mesh_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

class OffReader {
 public:
  OffReader(const std::string& file, std::string_view bytes) : file_(file), lines_(bytes) {}

  TriangleMesh read() {
    read_header();
    for (std::uint64_t i = 0; i < vertices_; ++i) vertex();
    for (std::uint64_t i = 0; i < faces_; ++i) face();
    if (!lines_.ended()) log::warn("{}: the last line has no line end: the file may be truncated", file_);
    if (next())
      throw line_error(file_, lines_.number(), "data go on after the last face that the header declares");
    if (skipped_ > 0)
      log::info("{}: {} faces with fewer than three different corners are left out", file_, skipped_);
    mesh_.normals = unit_normals(vertex_normals_);
    if (colors_.size() == mesh_.vertices.size()) mesh_.colors = scaled_colors(colors_);
    return std::move(mesh_);
  }

 private:
  /// The next line that holds more than a comment.
  bool next() {
    while (lines_.next_filled()) {
      const std::string_view line = lines_.line().substr(0, lines_.line().find('#'));
      words_ = Words(line);
      if (!words_.rest().empty()) return true;
    }
    return false;
  }

  void need_line(std::string_view what) {
    if (!next())
      throw line_error(file_, lines_.number(), "the file ends before the last {}: it is truncated", what);
  }

  void read_header() {
    need_line("count");
    Words ahead = words_;
    std::string_view key = ahead.next();
    if (key.ends_with("OFF")) {
      words_ = ahead;
      key.remove_suffix(3);
      for (const char letter : {'S', 'C', 'N'}) {  // STCN: texture, colours, normals
        if (!key.starts_with(letter)) continue;
        key.remove_prefix(1);
        if (letter == 'S' && key.starts_with('T')) key.remove_prefix(1);
        normals_ = normals_ || letter == 'N';
      }
      if (!key.empty() || words_.rest().starts_with("BINARY"))
        throw line_error(file_, lines_.number(), "OFF with four dimensions or binary data is not read");
      if (words_.rest().empty()) need_line("count");
    }
    vertices_ = count("vertices");
    faces_ = count("faces");
    const std::uint64_t left = lines_.rest().size() + 1;
    // A vertex takes three digits with separators, a face at least its number of corners.
    if (vertices_ > left / 6 || faces_ > (left - 6 * vertices_) / 2 + 1)
      throw line_error(file_, lines_.number(),
                       "{} vertices and {} faces are claimed, but only {} bytes follow", vertices_, faces_,
                       left - 1);
    mesh_.vertices.reserve(vertices_);
  }

  std::uint64_t count(std::string_view what) {
    const std::string_view word = words_.next();
    const auto value = parse_integer(word);
    if (!value || *value < 0 || *value > 0xFFFFFFFELL)
      throw line_error(file_, lines_.number(), "{} is no number of {}", shown(word), what);
    return static_cast<std::uint64_t>(*value);
  }

  double number() {
    const std::string_view word = words_.next();
    if (word.empty()) throw line_error(file_, lines_.number(), "too few numbers");
    const auto value = parse_value(word);
    if (!value) throw line_error(file_, lines_.number(), "{} is no number", shown(word));
    return *value;
  }

  Eigen::Vector3d triple() {
    Eigen::Vector3d values;
    for (double& value : values) value = number();
    return values;
  }

  void vertex() {
    need_line("vertex");
    mesh_.vertices.push_back(triple());
    if (normals_) vertex_normals_.push_back(triple());
    // Red, green, blue and often alpha; two numbers would be a texture coordinate.
    std::array<double, 6> more{};
    std::size_t found = 0;
    while (!words_.rest().empty()) {
      if (found == more.size()) throw line_error(file_, lines_.number(), "too many numbers");
      more[found++] = number();
    }
    if (found >= 3) colors_.emplace_back(Eigen::Vector3d(more[0], more[1], more[2]).cast<float>());
  }

  void face() {
    need_line("face");
    const std::string_view word = words_.next();
    const auto corners = parse_integer(word);
    if (!corners || *corners < 0 || static_cast<std::uint64_t>(*corners) > lines_.line().size())
      throw line_error(file_, lines_.number(), "{} is no number of corners that the line holds", shown(word));
    polygon_.clear();
    for (std::int64_t i = 0; i < *corners; ++i) {
      const double value = number();
      if (!(value >= 0 && value < static_cast<double>(vertices_) && value == std::floor(value)))
        throw line_error(file_, lines_.number(), "the face names vertex {}, but there are only {}", value,
                         vertices_);
      polygon_.push_back(static_cast<std::uint32_t>(value));
      if (!mesh_.vertices[polygon_.back()].allFinite())
        throw line_error(file_, lines_.number(),
                         "the face uses vertex {}, which has a coordinate that is not a finite number",
                         value);
    }
    if (append_fan(mesh_.faces, polygon_) == 0) ++skipped_;
  }

  const std::string& file_;
  TextLines lines_;
  Words words_{""};
  bool normals_ = false;
  std::uint64_t vertices_ = 0;
  std::uint64_t faces_ = 0;
  std::size_t skipped_ = 0;
  std::vector<std::uint32_t> polygon_;
  std::vector<Eigen::Vector3d> vertex_normals_;
  std::vector<Eigen::Vector3f> colors_;
  TriangleMesh mesh_;
};

}  // namespace

bool looks_like_off(std::string_view bytes) {
  std::string_view word = bytes.substr(0, bytes.find_first_of(" \t\r\n"));
  for (const std::string_view known :
       {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"})
    if (word == known) return true;
  return false;
}

TriangleMesh read_off_mesh(const std::string& file, std::string_view bytes) {
  return OffReader(file, bytes).read();
}

}  // namespace drape::io
