#include <array>
#include <bit>

#include "ply.hpp"

namespace drape::io {
namespace {

std::string_view name_of(PlyType type) {
  static constexpr std::array<std::string_view, 8> names{"char", "uchar", "short", "ushort",
                                                         "int",  "uint",  "float", "double"};
  return names[static_cast<std::size_t>(type)];
}

template <class Number>
void append(std::string& bytes, Number value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  bytes.append(raw.data(), raw.size());
}

}  // namespace

PlyBuilder::PlyBuilder() : bytes_("ply\nformat binary_little_endian 1.0\n") {}

void PlyBuilder::comment(std::string_view text) {
  bytes_.append("comment ").append(text).append("\n");
}

void PlyBuilder::obj_info(std::string_view text) {
  bytes_.append("obj_info ").append(text).append("\n");
}

void PlyBuilder::element(std::string_view name, std::size_t count) {
  bytes_.append("element ").append(name).append(" ").append(std::to_string(count)).append("\n");
}

void PlyBuilder::property(PlyType type, std::string_view name) {
  bytes_.append("property ").append(name_of(type)).append(" ").append(name).append("\n");
}

void PlyBuilder::list_property(PlyType count_type, PlyType type, std::string_view name) {
  bytes_.append("property list ").append(name_of(count_type)).append(" ").append(name_of(type));
  bytes_.append(" ").append(name).append("\n");
}

void PlyBuilder::end_header(std::size_t body_size) {
  bytes_.append("end_header\n");
  bytes_.reserve(bytes_.size() + body_size);
}

void PlyBuilder::put_double(double value) {
  append(bytes_, value);
}
void PlyBuilder::put_float(float value) {
  append(bytes_, value);
}
void PlyBuilder::put_int(std::int32_t value) {
  append(bytes_, value);
}
void PlyBuilder::put_byte(std::uint8_t value) {
  bytes_.push_back(static_cast<char>(value));
}

}  // namespace drape::io
