// STL, ASCII and binary (3D Systems, "StereoLithography Interface Specification").
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "drape/base/log.hpp"
#include "mesh_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

constexpr std::size_t header_size = 84;  // 80 bytes of text and the count
constexpr std::size_t facet_size = 50;   // normal, three corners, two bytes that nobody agrees on

std::uint32_t count_of(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

struct PointHash {
  std::size_t operator()(const Eigen::Vector3d& p) const {
    std::uint64_t h = 0;
    for (const double x : p) h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15ULL + (h >> 29);
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

/// STL repeats a corner in every facet that has it: equal coordinates are one vertex.
class Welder {
 public:
  std::uint32_t vertex(const Eigen::Vector3d& corner) {
    const Eigen::Vector3d key = corner.array() + 0.0;  // makes one of the two zeros
    const auto [entry, added] = known_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (added) mesh_.vertices.push_back(key);
    return entry->second;
  }

  void add_facet(const std::array<Eigen::Vector3d, 3>& corners) {
    const std::array<std::uint32_t, 3> face{vertex(corners[0]), vertex(corners[1]), vertex(corners[2])};
    if (append_fan(mesh_.faces, face) == 0) ++flat_;
  }

  TriangleMesh mesh(const std::string& file) {
    if (flat_ > 0) log::info("{}: {} facets with two equal corners are left out", file, flat_);
    return without_unused_vertices(mesh_);
  }

 private:
  TriangleMesh mesh_;
  std::unordered_map<Eigen::Vector3d, std::uint32_t, PointHash> known_;
  std::size_t flat_ = 0;
};

TriangleMesh read_binary(const std::string& file, std::string_view bytes) {
  Welder welder;
  std::size_t at = header_size;
  for (std::uint32_t i = count_of(bytes); i > 0; --i, at += facet_size) {
    std::array<float, 12> numbers;
    std::memcpy(numbers.data(), bytes.data() + at, sizeof numbers);
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = Eigen::Vector3f(numbers.data() + 3 + 3 * k).cast<double>();
      if (!corners[k].allFinite()) throw byte_error(file, at, "the facet has a corner that is not finite");
    }
    welder.add_facet(corners);
  }
  return welder.mesh(file);
}

/// The words that make a facet, in their order.
class AsciiReader {
 public:
  AsciiReader(const std::string& file, std::string_view bytes) : file_(file), lines_(bytes) {}

  TriangleMesh read() {
    bool inside = false;  // a solid
    while (next()) {
      if (key_ == "solid" && !inside)
        inside = true;
      else if (key_ == "endsolid" && inside)
        inside = false;
      else if (key_ == "facet" && inside)
        facet();
      else
        throw line_error(file_, lines_.number(), "{} is not expected here", shown(lines_.line()));
    }
    if (inside)
      throw line_error(file_, lines_.number(), "the STL ends without \"endsolid\": the file is truncated");
    return welder_.mesh(file_);
  }

 private:
  bool next() {
    if (!lines_.next_filled()) return false;
    words_ = Words(lines_.line());
    key_ = words_.next();
    std::transform(key_.begin(), key_.end(), key_.begin(),
                   [](char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
    return true;
  }

  void expect(std::string_view key) {
    if (!next())
      throw line_error(file_, lines_.number(), "the STL ends within a facet: the file is truncated");
    if (key_ != key)
      throw line_error(file_, lines_.number(), "\"{}\" is expected, not {}", key, shown(lines_.line()));
  }

  void facet() {
    expect("outer");
    std::array<Eigen::Vector3d, 3> corners;
    for (Eigen::Vector3d& corner : corners) {
      expect("vertex");
      for (double& x : corner) {
        const std::string_view word = words_.next();
        const auto value = parse_value(word);
        if (!value) throw line_error(file_, lines_.number(), "{} is no number", shown(word));
        x = *value;
      }
      if (!words_.rest().empty()) throw line_error(file_, lines_.number(), "a vertex has three numbers");
      if (!corner.allFinite())
        throw line_error(file_, lines_.number(), "the facet has a corner that is not finite");
    }
    expect("endloop");
    expect("endfacet");
    welder_.add_facet(corners);
  }

  const std::string& file_;
  TextLines lines_;
  Words words_{""};
  std::string key_;
  Welder welder_;
};

}  // namespace

bool looks_like_binary_stl(std::string_view bytes) {
  // Many binary files start with the word "solid": only the size tells.
  return bytes.size() > header_size &&
         bytes.size() == header_size + facet_size * std::uint64_t{count_of(bytes)};
}

TriangleMesh read_stl_mesh(const std::string& file, std::string_view bytes) {
  if (looks_like_binary_stl(bytes)) return read_binary(file, bytes);
  const std::size_t start = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  const std::string_view head = bytes.substr(0, 4096);
  if ((bytes.substr(start).starts_with("solid") || bytes.substr(start).starts_with("SOLID")) &&
      head.find('\0') == std::string_view::npos)
    return AsciiReader(file, bytes).read();
  if (bytes.size() < header_size)
    throw byte_error(file, bytes.size(), "the STL ends within its header: the file is truncated");
  throw byte_error(file, 80, "the STL claims {} facets, which take {} bytes, but the file has {}",
                   count_of(bytes), header_size + facet_size * std::uint64_t{count_of(bytes)}, bytes.size());
}

}  // namespace drape::io
