#include "outline_drawing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace drape::alignment {
namespace {

constexpr double sample_spacing_px = 2;
constexpr double straight_px = 3;  // shorter edges zigzag about the rim of a smooth body
constexpr double side_px = 0.9;  // beside a sample the stencil must be set on one side and clear on the other

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector3d unit_normal(const std::vector<Eigen::Vector3d>& turned, const Face& f) {
  return (turned[f[1]] - turned[f[0]]).cross(turned[f[2]] - turned[f[0]]).normalized();
}

// The first pixel whose centre is at or beyond `x`.
int center_at_or_after(double x) {
  return static_cast<int>(std::ceil(std::clamp(x, -1e6, 1e6) - 0.5));
}

bool set_in(const BitImage& image, bool in_row, int at, int line) {
  return in_row ? image.at(at, line) : image.at(line, at);
}

// What is seen at `t` of the way from `a` to `b` in the picture.
Eigen::Vector3d seen_between(const OutlinePose& pose, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             double t) {
  const double far_a = 1 + pose.perspective * a.z();
  const double far_b = 1 + pose.perspective * b.z();
  const double share = t * far_a / (t * far_a + (1 - t) * far_b);
  return (1 - share) * a + share * b;
}

}  // namespace

void OutlineDrawing::draw(const OutlineMesh& mesh, const OutlinePose& pose, const Window& window,
                          bool with_rim) {
  const std::size_t count = mesh.vertices.size();
  turned_.resize(count);
  places_.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    turned_[v] = pose.rotation * mesh.vertices[v];
    places_[v] = window.from_photo(pose.place(turned_[v]));
  }
  if (stencil_.width() != window.width || stencil_.height() != window.height)
    stencil_ = BitImage(window.width, window.height);
  else
    stencil_.clear();
  find_sides(mesh);
  find_outline(mesh);
  fill_.begin(window.width, window.height);
  for (const OutlinePart& part : outline_)
    fill_.add_edge(places_[part.edge->from], places_[part.edge->to], part.winding);
  fill_.fill(stencil_);
  find_gaps(mesh, pose, window);
  rim_.clear();
  if (!with_rim) return;
  for (const OutlinePart& part : outline_) sample_edge(mesh, *part.edge, pose, window);
}

// What the caps cover beside the mesh, and what both enclose.
void OutlineDrawing::find_gaps(const OutlineMesh& mesh, const OutlinePose& pose, const Window& window) {
  if (!mesh.open) {
    gaps_ = BitImage();
    return;
  }
  for (const Eigen::Vector3d& x : mesh.border_middles)
    places_.push_back(window.from_photo(pose.place(pose.rotation * x)));
  capped_ = stencil_;
  draw_faces(places_, mesh.caps, capped_);
  places_.resize(mesh.vertices.size());
  gaps_ = enclosed_gaps(capped_);
  const std::span<const std::uint64_t> capped = std::as_const(capped_).words();
  const std::span<const std::uint64_t> covered = std::as_const(stencil_).words();
  const std::span<std::uint64_t> gaps = gaps_.words();
  for (std::size_t i = 0; i < gaps.size(); ++i) gaps[i] |= capped[i] & ~covered[i];
}

// Which side of a face is seen is the sense of its projection, exactly, with perspective and all.
void OutlineDrawing::find_sides(const OutlineMesh& mesh) {
  front_.resize(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& face = mesh.faces[f];
    const Eigen::Vector2d& corner = places_[face[0]];
    front_[f] = cross(places_[face[1]] - corner, places_[face[2]] - corner) < 0 ? 1 : 0;
  }
}

// A face that is seen covers what its sides wind about; so does one that turns its back, the other way round.
// Of the sides that two faces share most cancel: what is left is where the body turns, and its borders.
void OutlineDrawing::find_outline(const OutlineMesh& mesh) {
  outline_.clear();
  for (const OutlineEdge& edge : mesh.edges) {
    int winding = front_[edge.face] != 0 ? 1 : -1;
    if (edge.other != OutlineEdge::no_face) winding += (front_[edge.other] != 0) == edge.turned ? 1 : -1;
    if (winding != 0) outline_.push_back({&edge, winding});
  }
}

Eigen::Vector2d OutlineDrawing::normal_of(const OutlineMesh& mesh, const OutlineEdge& edge) const {
  const Eigen::Vector2d along = places_[edge.to] - places_[edge.from];
  const double length = along.norm();
  if (length < straight_px && edge.other != OutlineEdge::no_face) {
    const Eigen::Vector3d first = unit_normal(turned_, mesh.faces[edge.face]);
    const Eigen::Vector3d second = unit_normal(turned_, mesh.faces[edge.other]);
    const Eigen::Vector2d mean = (first + (edge.turned ? -1.0 : 1.0) * second).head<2>();
    if (mean.norm() > 1e-9) return mean.normalized();
  }
  return Eigen::Vector2d(along.y(), -along.x()) / length;
}

void OutlineDrawing::sample_edge(const OutlineMesh& mesh, const OutlineEdge& edge, const OutlinePose& pose,
                                 const Window& window) {
  const double length = (places_[edge.to] - places_[edge.from]).norm();
  if (!(length > 0)) return;
  RimSample sample;
  sample.border = edge.border;
  sample.straight = length >= straight_px;
  const Eigen::Vector2d normal = normal_of(mesh, edge);
  const int count = std::max(1, static_cast<int>(std::ceil(length / sample_spacing_px)));
  sample.length = length / count;
  for (int i = 0; i < count; ++i) {
    const double t = (i + 0.5) / count;
    sample.turned = (1 - t) * turned_[edge.from] + t * turned_[edge.to];
    sample.at = window.from_photo(pose.place(sample.turned));
    const auto set_beside = [&](double distance) {
      const Eigen::Vector2d x = sample.at + distance * normal;
      return stencil_.at(static_cast<int>(std::floor(x.x())), static_cast<int>(std::floor(x.y())));
    };
    const bool inside = set_beside(-side_px);
    if (inside == set_beside(side_px)) continue;
    sample.outward = inside ? normal : Eigen::Vector2d(-normal);
    rim_.push_back(sample);
  }
}

std::vector<PixelCrossing> OutlineDrawing::crossings(const OutlineMesh& mesh, const OutlinePose& pose) const {
  std::vector<PixelCrossing> found;
  for (const OutlinePart& part : outline_) {
    const OutlineEdge& edge = *part.edge;
    const Eigen::Vector2d& from = places_[edge.from];
    const Eigen::Vector2d& to = places_[edge.to];
    for (const bool in_row : {true, false}) {
      const int along = in_row ? 0 : 1;
      const int across = 1 - along;
      const int begin = center_at_or_after(std::min(from[across], to[across]));
      const int end = center_at_or_after(std::max(from[across], to[across]));
      for (int line = begin; line < end; ++line) {
        const double t = (line + 0.5 - from[across]) / (to[across] - from[across]);
        const double x = from[along] + t * (to[along] - from[along]);
        PixelCrossing crossing;
        crossing.in_row = in_row;
        crossing.line = line;
        crossing.border = edge.border;
        crossing.before = center_at_or_after(x) - 1;
        crossing.object_first = set_in(stencil_, in_row, crossing.before, line);
        if (crossing.object_first == set_in(stencil_, in_row, crossing.before + 1, line)) continue;
        crossing.at[along] = x;
        crossing.at[across] = line + 0.5;
        crossing.turned = seen_between(pose, turned_[edge.from], turned_[edge.to], t);
        const Eigen::Vector2d normal = normal_of(mesh, edge);
        crossing.outward = (normal[along] > 0) == crossing.object_first ? normal : Eigen::Vector2d(-normal);
        found.push_back(crossing);
      }
    }
  }
  return found;
}

}  // namespace drape::alignment
