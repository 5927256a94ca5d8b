#include "ply_vertices.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "attribute_scale.hpp"

namespace drape::io {
namespace {

using Columns = std::array<const PlyColumn*, 3>;

bool complete(const Columns& columns) {
  return std::all_of(columns.begin(), columns.end(),
                     [](const PlyColumn* c) { return c != nullptr && !c->property.list; });
}

Eigen::Vector3d triple(const Columns& columns, std::size_t row) {
  return {columns[0]->values[row], columns[1]->values[row], columns[2]->values[row]};
}

/// The value that means 1 in a colour or intensity column.
double full_scale(const PlyColumn& column) {
  switch (column.property.type) {
    case PlyType::uint8:
      return 255;
    case PlyType::uint16:
      return 65535;
    default:
      return 0;
  }
}

std::vector<Eigen::Vector3d> triples(const Columns& columns) {
  std::vector<Eigen::Vector3d> values;
  values.reserve(columns[0]->values.size());
  for (std::size_t i = 0; i < columns[0]->values.size(); ++i) values.push_back(triple(columns, i));
  return values;
}

std::vector<Eigen::Vector3f> float_triples(const Columns& columns) {
  std::vector<Eigen::Vector3f> values;
  values.reserve(columns[0]->values.size());
  for (std::size_t i = 0; i < columns[0]->values.size(); ++i)
    values.emplace_back(triple(columns, i).cast<float>());
  return values;
}

/// As they were written: floats, or bytes for 0..1.
std::vector<Eigen::Vector3f> exact_floats(const Columns& columns) {
  const bool bytes = columns[0]->property.type == PlyType::uint8;
  std::vector<Eigen::Vector3f> values;
  values.reserve(columns[0]->values.size());
  for (std::size_t i = 0; i < columns[0]->values.size(); ++i)
    values.emplace_back(triple(columns, i).cast<float>() / (bytes ? 255.0F : 1.0F));
  return values;
}

std::vector<float> floats_of(const PlyColumn& column) {
  std::vector<float> values;
  values.reserve(column.values.size());
  for (const double value : column.values) values.push_back(static_cast<float>(value));
  return values;
}

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

bool bytes_hold(std::span<const Eigen::Vector3f> colors) {
  const auto holds = [](float value) {
    return value >= 0 && value <= 1 && static_cast<float>(byte_of(value)) / 255.0F == value;
  };
  return std::all_of(colors.begin(), colors.end(),
                     [&](const Eigen::Vector3f& c) { return holds(c.x()) && holds(c.y()) && holds(c.z()); });
}

}  // namespace

std::vector<PlyWanted> vertex_columns() {
  std::vector<PlyWanted> wanted;
  for (const char* name : {"x",
                           "y",
                           "z",
                           "nx",
                           "ny",
                           "nz",
                           "normal_x",
                           "normal_y",
                           "normal_z",
                           "red",
                           "green",
                           "blue",
                           "r",
                           "g",
                           "b",
                           "diffuse_red",
                           "diffuse_green",
                           "diffuse_blue",
                           "intensity",
                           "scalar_Intensity",
                           "scalar_intensity",
                           "confidence"})
    wanted.push_back({"vertex", name});
  return wanted;
}

VertexSamples::VertexSamples(const PlyFile& ply) {
  const PlyTable* table = ply.table("vertex");
  const auto scalar = [&](std::initializer_list<std::string_view> names) -> const PlyColumn* {
    const PlyColumn* column = table == nullptr ? nullptr : table->column_of(names);
    return column == nullptr || column->property.list ? nullptr : column;
  };
  const auto whole = [](Columns columns) { return complete(columns) ? columns : Columns{}; };
  position_ = whole({scalar({"x"}), scalar({"y"}), scalar({"z"})});
  if (!complete(position_)) throw input_error("{}: has no element \"vertex\" with x, y and z", ply.file);
  normal_ = whole({scalar({"nx", "normal_x"}), scalar({"ny", "normal_y"}), scalar({"nz", "normal_z"})});
  color_ = whole({scalar({"red", "diffuse_red", "r"}), scalar({"green", "diffuse_green", "g"}),
                  scalar({"blue", "diffuse_blue", "b"})});
  intensity_ = scalar({"intensity", "scalar_Intensity", "scalar_intensity"});
  confidence_ = scalar({"confidence"});
  const auto scale = [&](const PlyColumn* column) {
    const double by_type = column == nullptr ? 0 : full_scale(*column);
    return has_mark(ply.header) && by_type == 0 ? 1 : by_type;
  };
  scales_ = {scale(color_[0]), scale(intensity_)};
}

SampleFields VertexSamples::fields() const {
  return {normal_[0] != nullptr, color_[0] != nullptr, intensity_ != nullptr, confidence_ != nullptr};
}

Sample VertexSamples::sample(std::size_t row) const {
  Sample sample;
  sample.position = triple(position_, row);
  if (normal_[0] != nullptr) sample.normal = triple(normal_, row);
  if (color_[0] != nullptr) sample.color = triple(color_, row);
  if (intensity_ != nullptr) sample.intensity = intensity_->values[row];
  if (confidence_ != nullptr) sample.confidence = confidence_->values[row];
  return sample;
}

PointCloud vertices_of(const PlyFile& ply) {
  const VertexSamples columns(ply);
  const bool exact = has_mark(ply.header);
  PointCloud cloud;
  cloud.positions = triples(columns.position());
  if (const Columns& normal = columns.normal(); complete(normal))
    cloud.normals = exact ? exact_floats(normal) : unit_normals(triples(normal));
  if (const Columns& color = columns.color(); complete(color))
    cloud.colors = exact ? exact_floats(color) : scaled_colors(float_triples(color), columns.scales().color);
  if (const PlyColumn* c = columns.intensity())
    cloud.intensities = exact ? floats_of(*c) : scaled_intensities(floats_of(*c), columns.scales().intensity);
  if (const PlyColumn* c = columns.confidence())
    cloud.confidences = exact ? floats_of(*c) : clamped_confidences(c->values);
  return cloud;
}

void put_mark(PlyBuilder& ply, std::string_view kind) {
  ply.obj_info("drape_file " + std::string(kind));
}

bool has_mark(const PlyHeader& header) {
  return !header.info("drape_file").empty();
}

VertexWriter::VertexWriter(std::span<const Eigen::Vector3d> positions,
                           std::span<const Eigen::Vector3f> normals, std::span<const Eigen::Vector3f> colors,
                           std::span<const float> intensities, std::span<const float> confidences)
    : positions_(positions),
      normals_(normals),
      colors_(colors),
      intensities_(intensities),
      confidences_(confidences),
      byte_colors_(bytes_hold(colors)) {
  [[maybe_unused]] const auto fits = [&](std::size_t size) { return size == 0 || size == positions.size(); };
  assert(fits(normals.size()) && fits(colors.size()) && fits(intensities.size()) && fits(confidences.size()));
}

void VertexWriter::declare(PlyBuilder& ply) const {
  ply.element("vertex", positions_.size());
  for (const char* name : {"x", "y", "z"}) ply.property(PlyType::float64, name);
  if (!normals_.empty())
    for (const char* name : {"nx", "ny", "nz"}) ply.property(PlyType::float32, name);
  if (!colors_.empty())
    for (const char* name : {"red", "green", "blue"})
      ply.property(byte_colors_ ? PlyType::uint8 : PlyType::float32, name);
  if (!intensities_.empty()) ply.property(PlyType::float32, "intensity");
  if (!confidences_.empty()) ply.property(PlyType::float32, "confidence");
}

std::size_t VertexWriter::bytes() const {
  return 24 * positions_.size() + 12 * normals_.size() + (byte_colors_ ? 3 : 12) * colors_.size() +
         4 * (intensities_.size() + confidences_.size());
}

void VertexWriter::put_rows(PlyBuilder& ply) const {
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    for (const double value : positions_[i]) ply.put_double(value);
    if (!normals_.empty())
      for (const float value : normals_[i]) ply.put_float(value);
    if (!colors_.empty())
      for (const float value : colors_[i]) byte_colors_ ? ply.put_byte(byte_of(value)) : ply.put_float(value);
    if (!intensities_.empty()) ply.put_float(intensities_[i]);
    if (!confidences_.empty()) ply.put_float(confidences_[i]);
  }
}

}  // namespace drape::io
