#include "drape/alignment/overlap.hpp"

#include <cstddef>
#include <cstdint>

#include "drape/base/error.hpp"

namespace drape::alignment {

double overlap_percent(const Image8& first, const Image8& second) {
  if (first.width() != second.width() || first.height() != second.height() || first.channels() != 1 ||
      second.channels() != 1)
    throw input_error("stencils of {} x {} x {} and {} x {} x {} values cannot be compared", first.width(),
                      first.height(), first.channels(), second.width(), second.height(), second.channels());
  std::size_t both = 0;
  std::size_t either = 0;
  for (std::size_t i = 0; i < first.data().size(); ++i) {
    const std::uint8_t a = first.data()[i];
    const std::uint8_t b = second.data()[i];
    if (a == stencil::unknown || b == stencil::unknown) continue;
    both += a == stencil::object && b == stencil::object ? 1 : 0;
    either += a == stencil::object || b == stencil::object ? 1 : 0;
  }
  return either == 0 ? 0.0 : 100.0 * static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace drape::alignment
