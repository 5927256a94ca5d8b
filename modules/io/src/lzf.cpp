#include "lzf.hpp"

namespace drape::io {

std::optional<std::string> lzf_decompressed(std::string_view codes, std::size_t size) {
  std::string bytes;
  bytes.reserve(size);
  std::size_t at = 0;
  const auto next = [&] { return static_cast<std::size_t>(static_cast<unsigned char>(codes[at++])); };
  while (at < codes.size()) {
    const std::size_t code = next();
    if (code < 32) {  // code + 1 bytes as they are
      const std::size_t count = code + 1;
      if (count > codes.size() - at || count > size - bytes.size()) return std::nullopt;
      bytes.append(codes.substr(at, count));
      at += count;
      continue;
    }
    // A copy of 3 to 264 earlier bytes; it may run into what it writes.
    std::size_t count = (code >> 5) + 2;
    if (count == 9) {
      if (at == codes.size()) return std::nullopt;
      count += next();
    }
    if (at == codes.size()) return std::nullopt;
    const std::size_t back = ((code & 31) << 8 | next()) + 1;
    if (back > bytes.size() || count > size - bytes.size()) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i) bytes.push_back(bytes[bytes.size() - back]);
  }
  if (bytes.size() != size) return std::nullopt;
  return bytes;
}

}  // namespace drape::io
