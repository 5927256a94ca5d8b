#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "attribute_scale.hpp"
#include "drape/base/log.hpp"
#include "drape/base/numbers.hpp"
#include "mesh_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

constexpr std::array<std::string_view, 19> ignored_keywords{
    "vp",     "l",     "p",        "g",        "o",   "s",          "mg",        "usemtl", "mtllib", "usemap",
    "maplib", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "call",   "csh"};

constexpr std::uint32_t no_normal = std::numeric_limits<std::uint32_t>::max();

/// Wavefront OBJ (Wavefront Technologies, Advanced Visualizer manual, appendix B1): vertices, normals and
/// polygons. Materials and texture coordinates are no part of a TriangleMesh and are stepped over.
class ObjReader {
 public:
  ObjReader(const std::string& file, std::string_view bytes) : file_(file), lines_(bytes) {}

  TriangleMesh read() {
    while (lines_.next_filled()) {
      // A backslash at its end continues a line.
      std::string_view line = lines_.line();
      if (line.back() == '\\') line = joined_line();
      read_line(line);
    }
    if (mesh_.vertices.empty()) throw input_error("{}: holds no vertex (a line \"v x y z\")", file_);
    add_faces();
    keep_normals();
    if (colors_.size() == mesh_.vertices.size()) mesh_.colors = scaled_colors(colors_);
    return std::move(mesh_);
  }

 private:
  struct Corner {
    std::uint32_t vertex;
    std::uint32_t normal;
  };
  struct Polygon {
    std::size_t end;   // of its corners
    std::size_t line;  // where it stands
  };

  std::string_view joined_line() {
    joined_.clear();
    do {
      joined_ += lines_.line();
      if (joined_.empty() || joined_.back() != '\\') return joined_;
      joined_.back() = ' ';
    } while (lines_.next());
    return joined_;
  }

  void read_line(std::string_view line) {
    Words words(line);
    const std::string_view key = words.next();
    if (key == "v")
      vertex(words);
    else if (key == "vn")
      normals_.push_back(triple(words));
    else if (key == "vt")
      ++texture_vertices_;
    else if (key == "f" || key == "fo")
      face(words);
    else if (!key.starts_with('#'))
      other(key);
  }

  void other(std::string_view key) {
    if (std::find(ignored_keywords.begin(), ignored_keywords.end(), key) != ignored_keywords.end()) return;
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    if (key != "curv2" && !std::all_of(key.begin(), key.end(), letter))
      throw line_error(file_, lines_.number(), "{} is no OBJ keyword: is the file damaged?", shown(key));
    if (!warned_)
      log::warn("{}:{}: lines with the keyword {} are left out", file_, lines_.number(), shown(key));
    warned_ = true;
  }

  Eigen::Vector3d triple(Words& words) {
    Eigen::Vector3d values;
    for (double& value : values) value = number(words.next());
    return values;
  }

  double number(std::string_view word) const {
    if (word.empty()) throw line_error(file_, lines_.number(), "too few numbers");
    const auto value = parse_value(word);
    if (!value) throw line_error(file_, lines_.number(), "{} is no number", shown(word));
    return *value;
  }

  void vertex(Words& words) {
    mesh_.vertices.push_back(triple(words));
    if (mesh_.vertices.size() >= no_normal)
      throw line_error(file_, lines_.number(), "more than 2^32 - 2 vertices");
    std::array<double, 4> more{};
    std::size_t count = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (word.starts_with('#')) break;
      if (count == more.size()) throw line_error(file_, lines_.number(), "too many numbers");
      more[count++] = number(word);
    }
    // Three numbers after x y z are a colour, four a colour and its alpha; one is a weight.
    if (count < 3) return;
    colors_.emplace_back(Eigen::Vector3d(more[0], more[1], more[2]).cast<float>());
  }

  void face(Words& words) {
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (word.starts_with('#')) break;
      corners_.push_back(corner(word));
    }
    polygons_.push_back({corners_.size(), lines_.number()});
  }

  /// v, v/vt, v//vn or v/vt/vn; a negative number counts back from the last one so far.
  Corner corner(std::string_view word) {
    const std::size_t first = word.find('/');
    const std::size_t second = first == std::string_view::npos ? first : word.find('/', first + 1);
    const std::string_view vt =
        first == std::string_view::npos
            ? std::string_view()
            : word.substr(first + 1, second == std::string_view::npos ? second : second - first - 1);
    if (!vt.empty()) (void)index(vt, texture_vertices_, word);
    Corner corner{index(word.substr(0, first), mesh_.vertices.size(), word), no_normal};
    if (second != std::string_view::npos)
      corner.normal = index(word.substr(second + 1), normals_.size(), word);
    return corner;
  }

  /// Whether a positive number names something is known only at the end of the file.
  std::uint32_t index(std::string_view text, std::size_t count, std::string_view word) const {
    const auto value = parse_integer(text);
    if (!value || *value == 0)
      throw line_error(file_, lines_.number(), "{} is no corner of a face", shown(word));
    const std::int64_t from_zero = *value > 0 ? *value - 1 : static_cast<std::int64_t>(count) + *value;
    if (from_zero < 0 || from_zero >= no_normal)
      throw line_error(file_, lines_.number(), "{} is out of range", shown(word));
    return static_cast<std::uint32_t>(from_zero);
  }

  void add_faces() {
    std::vector<std::uint32_t> polygon;
    std::size_t begin = 0;
    std::size_t skipped = 0;
    for (const Polygon& p : polygons_) {
      polygon.clear();
      for (; begin < p.end; ++begin) {
        const Corner& c = corners_[begin];
        if (c.vertex >= mesh_.vertices.size())
          throw line_error(file_, p.line, "the face names vertex {}, but there are only {}",
                           c.vertex + std::uint64_t{1}, mesh_.vertices.size());
        if (c.normal != no_normal && c.normal >= normals_.size())
          throw line_error(file_, p.line, "the face names normal {}, but there are only {}",
                           c.normal + std::uint64_t{1}, normals_.size());
        if (!mesh_.vertices[c.vertex].allFinite())
          throw line_error(file_, p.line,
                           "the face uses vertex {}, which has a coordinate that is not a finite number",
                           c.vertex + std::uint64_t{1});
        polygon.push_back(c.vertex);
      }
      if (append_fan(mesh_.faces, polygon) == 0) ++skipped;
    }
    if (skipped > 0)
      log::info("{}: {} faces with fewer than three different corners are left out", file_, skipped);
  }

  /// Only where every vertex has one and the same normal in all its faces: at hard edges they differ, and a
  /// vertex cannot hold several.
  void keep_normals() {
    std::vector<std::uint32_t> of_vertex(mesh_.vertices.size(), no_normal);
    for (const Corner& c : corners_) {
      if (c.normal == no_normal) return;
      std::uint32_t& mine = of_vertex[c.vertex];
      if (mine != no_normal && normals_[mine] != normals_[c.normal]) return;
      mine = c.normal;
    }
    if (corners_.empty()) return;
    std::vector<Eigen::Vector3d> chosen;
    chosen.reserve(of_vertex.size());
    for (const std::uint32_t n : of_vertex)
      chosen.push_back(n == no_normal ? Eigen::Vector3d(0, 0, 0) : normals_[n]);
    mesh_.normals = unit_normals(chosen);
  }

  const std::string& file_;
  TextLines lines_;
  std::string joined_;
  TriangleMesh mesh_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<Eigen::Vector3f> colors_;
  std::size_t texture_vertices_ = 0;
  std::vector<Corner> corners_;
  std::vector<Polygon> polygons_;
  bool warned_ = false;
};

}  // namespace

TriangleMesh read_obj_mesh(const std::string& file, std::string_view bytes) {
  return ObjReader(file, bytes).read();
}

}  // namespace drape::io
