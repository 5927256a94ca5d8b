// The compressed vectors of an E57 file: records of bit-packed numbers in packets.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "e57_file.hpp"

namespace drape::io {

struct E57Field {
  std::string name;
  int bits = 0;            // of one value; 0: all values are `offset + least * scale`
  bool is_float = false;   // of 32 or 64 bits
  std::int64_t least = 0;  // integers are stored as their distance from it
  std::int64_t most = 0;
  double scale = 1;
  double offset = 0;
};

class E57Points {
 public:
  /// `points` is a CompressedVector element. Error{input} if its prototype or its count make no sense.
  E57Points(const E57Pages& pages, pugi::xml_node points);

  [[nodiscard]] const std::vector<E57Field>& fields() const { return fields_; }
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// The values of each record in turn, in the order of the fields.
  void for_each(const std::function<void(std::span<const double>)>& record) const;

 private:
  const E57Pages& pages_;
  std::vector<E57Field> fields_;
  std::uint64_t count_ = 0;
  std::uint64_t begin_ = 0;  // logical place of the section
};

}  // namespace drape::io
