// A libFuzzer target for one scan format, DRAPE_FUZZ_FILE.
#include <cstddef>
#include <cstdint>

#include "scan_entry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  (void)drape::test::read_as_scan(DRAPE_FUZZ_FILE, {reinterpret_cast<const char*>(data), size});
  return 0;
}
