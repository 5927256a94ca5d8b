#include "e57_points.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "byte_fields.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

constexpr std::uint64_t section_header = 32;
enum Packet : unsigned char { index_packet = 0, data_packet = 1, empty_packet = 2 };

E57Field field_of(const std::string& file, pugi::xml_node node) {
  E57Field field;
  field.name = node.name();
  const std::string_view type = node.attribute("type").value();
  if (type == "Float") {
    field.is_float = true;
    field.bits = std::string_view(node.attribute("precision").value()) == "single" ? 32 : 64;
    return field;
  }
  if (type != "Integer" && type != "ScaledInteger")
    throw input_error("{}: points have a field {} of unknown type {}", file, shown(field.name), shown(type));
  field.least = e57_integer(file, node, "minimum", std::numeric_limits<std::int64_t>::min());
  field.most = e57_integer(file, node, "maximum", std::numeric_limits<std::int64_t>::max());
  if (field.most < field.least)
    throw input_error("{}: the field {} of the points has a maximum below its minimum", file,
                      shown(field.name));
  field.bits = static_cast<int>(
      std::bit_width(static_cast<std::uint64_t>(field.most) - static_cast<std::uint64_t>(field.least)));
  if (type == "ScaledInteger") {
    field.scale = e57_attribute(file, node, "scale", 1);
    field.offset = e57_attribute(file, node, "offset", 0);
  }
  return field;
}

/// The bytes of one field that came and were not used yet.
class BitStream {
 public:
  void append(std::string_view bytes) {
    bytes_.erase(0, bit_ / 8);
    bit_ %= 8;
    bytes_.append(bytes);
  }
  [[nodiscard]] std::uint64_t values(int bits) const {
    return bits == 0 ? std::numeric_limits<std::uint64_t>::max()
                     : (8 * bytes_.size() - bit_) / static_cast<std::uint64_t>(bits);
  }
  /// Least significant bit first.
  std::uint64_t take(int bits) {
    std::uint64_t value = 0;
    for (int have = 0; have < bits;) {
      const auto byte = static_cast<unsigned char>(bytes_[bit_ / 8]);
      const int within = static_cast<int>(bit_ % 8);
      const int part = std::min(8 - within, bits - have);
      value |= (std::uint64_t{byte} >> within & ((1U << part) - 1U)) << have;
      have += part;
      bit_ += static_cast<std::size_t>(part);
    }
    return value;
  }

 private:
  std::string bytes_;
  std::size_t bit_ = 0;
};

double value_of(const E57Field& field, std::uint64_t raw) {
  if (field.is_float)
    return field.bits == 32 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)))
                            : std::bit_cast<double>(raw);
  const auto whole = static_cast<std::int64_t>(static_cast<std::uint64_t>(field.least) + raw);
  return static_cast<double>(whole) * field.scale + field.offset;
}

}  // namespace

E57Points::E57Points(const E57Pages& pages, pugi::xml_node points) : pages_(pages) {
  const std::string& file = pages.file();
  for (const pugi::xml_node node : points.child("prototype").children())
    if (node.type() == pugi::node_element) fields_.push_back(field_of(file, node));
  const auto count = e57_integer(file, points, "recordCount", -1);
  const auto offset = e57_integer(file, points, "fileOffset", -1);
  if (count < 0 || offset < 0) throw input_error("{}: points without their number and place", file);
  count_ = static_cast<std::uint64_t>(count);
  if (count_ == 0) return;
  begin_ = pages.logical(static_cast<std::uint64_t>(offset));
  std::uint64_t bits = 0;
  for (const E57Field& field : fields_) bits += static_cast<std::uint64_t>(field.bits);
  if (bits == 0 || count_ / 8 > pages.size() / bits)
    throw input_error("{}: the XML section claims {} points of {} bits, which {} bytes cannot hold", file,
                      count_, bits, pages.size());
}

void E57Points::for_each(const std::function<void(std::span<const double>)>& record) const {
  if (count_ == 0) return;
  const std::string& file = pages_.file();
  const std::string header = pages_.read(begin_, section_header);
  if (header[0] != 1) throw byte_error(file, pages_.physical(begin_), "no compressed vector begins here");
  std::uint64_t at = pages_.logical(load<std::uint64_t>(header, 16));
  std::vector<BitStream> streams(fields_.size());
  std::vector<double> values(fields_.size());
  for (std::uint64_t done = 0; done < count_;) {
    // type, flags, length - 1; of a data packet then the number of streams, their lengths, and their bytes.
    const std::string start = pages_.read(at, 6);
    const std::uint64_t size = std::uint64_t{load<std::uint16_t>(start, 2)} + 1;
    const auto type = static_cast<unsigned char>(start[0]);
    if (type != data_packet) {
      if (type > empty_packet || size % 4 != 0)
        throw byte_error(file, pages_.physical(at), "no packet begins here");
      at += size;
      continue;
    }
    const std::string packet = pages_.read(at, size);
    const std::size_t count = load<std::uint16_t>(start, 4);
    std::size_t place = 6 + 2 * count;
    if (count != fields_.size() || place > packet.size())
      throw byte_error(file, pages_.physical(at), "a packet of {} streams, but points have {} fields", count,
                       fields_.size());
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t length = load<std::uint16_t>(packet, 6 + 2 * k);
      if (length > packet.size() - place)
        throw byte_error(file, pages_.physical(at), "a stream of {} bytes does not fit its packet", length);
      streams[k].append(std::string_view(packet).substr(place, length));
      place += length;
    }
    at += size;
    std::uint64_t whole = count_ - done;
    for (std::size_t k = 0; k < count; ++k) whole = std::min(whole, streams[k].values(fields_[k].bits));
    for (std::uint64_t i = 0; i < whole; ++i) {
      for (std::size_t k = 0; k < count; ++k)
        values[k] = value_of(fields_[k], streams[k].take(fields_[k].bits));
      record(values);
    }
    done += whole;
  }
}

}  // namespace drape::io
