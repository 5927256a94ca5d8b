#include "stencil_shape.hpp"

#include <algorithm>
#include <vector>

#include "region_graph.hpp"

namespace drape::segmentation {
namespace {

struct Part {
  bool object = false;
  bool on_border = false;
  double pixels = 0;
};

struct Parts {
  Labels labels;
  std::vector<Part> parts;
};

Parts parts_of(const Image8& given) {
  Labels values(given.width(), given.height(), 1, 0);
  std::transform(given.data().begin(), given.data().end(), values.data().begin(),
                 [](std::uint8_t v) { return static_cast<std::int32_t>(v == stencil::object); });
  Parts p;
  p.labels = connected_regions(values);
  for (int y = 0; y < given.height(); ++y)
    for (int x = 0; x < given.width(); ++x) {
      const auto i = static_cast<std::size_t>(p.labels.at(x, y));
      if (i >= p.parts.size()) p.parts.resize(i + 1);
      p.parts[i].object = values.at(x, y) == 1;
      p.parts[i].pixels += 1;
      if (x == 0 || y == 0 || x + 1 == given.width() || y + 1 == given.height()) p.parts[i].on_border = true;
    }
  return p;
}

}  // namespace

Image8 without_islands(const Image8& given, double least_share, std::optional<std::array<int, 2>> must_hold) {
  const Parts p = parts_of(given);
  std::int32_t only = -1;
  if (must_hold) {
    const std::int32_t held = p.labels.at((*must_hold)[0], (*must_hold)[1]);
    if (p.parts[static_cast<std::size_t>(held)].object) only = held;
  }
  double main = 0;
  for (const Part& part : p.parts)
    if (part.object) main = std::max(main, part.pixels);
  Image8 out(given.width(), given.height(), 1, stencil::background);
  for (std::size_t i = 0; i < out.data().size(); ++i) {
    const std::int32_t label = p.labels.data()[i];
    const Part& part = p.parts[static_cast<std::size_t>(label)];
    const bool kept = only >= 0 ? label == only : part.pixels >= least_share * main;
    if (part.object && kept) out.data()[i] = stencil::object;
  }
  return out;
}

Image8 without_holes(const Image8& given, double most_share) {
  const Parts p = parts_of(given);
  double object = 0;
  for (const Part& part : p.parts)
    if (part.object) object += part.pixels;
  Image8 out = given;
  for (std::size_t i = 0; i < out.data().size(); ++i) {
    const Part& part = p.parts[static_cast<std::size_t>(p.labels.data()[i])];
    if (!part.object && !part.on_border && part.pixels <= most_share * object)
      out.data()[i] = stencil::object;
  }
  return out;
}

}  // namespace drape::segmentation
