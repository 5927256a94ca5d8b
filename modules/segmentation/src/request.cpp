#include "request.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/error.hpp"

namespace drape::segmentation {
namespace {

int clamped(double value, int most) {
  return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(most)));
}

// A reduced pixel is what most of the marks in it say.
Image8 reduced_scribbles(const Image8& scribbles, const Image8& small) {
  Image<int> votes(small.width(), small.height(), 1, 0);
  for (int y = 0; y < scribbles.height(); ++y)
    for (int x = 0; x < scribbles.width(); ++x) {
      if (scribbles.at(x, y) == stencil::unknown) continue;
      const auto scaled = [](int position, int from, int to) {
        return static_cast<int>(static_cast<std::int64_t>(position) * to / from);
      };
      votes.at(scaled(x, scribbles.width(), small.width()), scaled(y, scribbles.height(), small.height())) +=
          scribbles.at(x, y) == stencil::object ? 1 : -1;
    }
  Image8 marks(small.width(), small.height(), 1, stencil::unknown);
  for (std::size_t i = 0; i < marks.data().size(); ++i)
    if (votes.data()[i] != 0) marks.data()[i] = votes.data()[i] > 0 ? stencil::object : stencil::background;
  return marks;
}

}  // namespace

Hints hints_of(const PhotoRegion& region, const Image8& photo, const Image8& small) {
  const double fx = static_cast<double>(small.width()) / photo.width();
  const double fy = static_cast<double>(small.height()) / photo.height();
  Hints hints;
  if (region.click_px)
    hints.click = {clamped((*region.click_px)[0] * fx, small.width() - 1),
                   clamped((*region.click_px)[1] * fy, small.height() - 1)};
  if (region.box_px) {
    const auto& [x, y, width, height] = *region.box_px;
    const int left = clamped(x * fx, small.width() - 1);
    const int top = clamped(y * fy, small.height() - 1);
    hints.box = {left, top, std::max(left + 1, clamped(std::ceil((x + width) * fx), small.width())),
                 std::max(top + 1, clamped(std::ceil((y + height) * fy), small.height()))};
  }
  if (!region.scribbles.empty()) hints.scribbles = reduced_scribbles(region.scribbles, small);
  return hints;
}

namespace {

void check_scribbles(const Image8& rgb, const Image8& scribbles) {
  if (scribbles.empty()) return;
  if (scribbles.width() != rgb.width() || scribbles.height() != rgb.height() || scribbles.channels() != 1)
    throw input_error("the scribbles are {} x {} pixels; the photo is {} x {}", scribbles.width(),
                      scribbles.height(), rgb.width(), rgb.height());
  const auto holds = [&](std::uint8_t kind) {
    return std::find(scribbles.data().begin(), scribbles.data().end(), kind) != scribbles.data().end();
  };
  if (!holds(stencil::object) || !holds(stencil::background))
    throw input_error(
        "the scribbles mark {}; they must mark some of the object (white) and some of the "
        "background (black), on grey",
        holds(stencil::object) ? "no background" : "no object");
}

}  // namespace

void check(const Image8& rgb, const Image8& mask, const PhotoRegion& region, const SegmentOptions& options) {
  if (rgb.empty()) throw input_error("the photo has no pixels");
  if (rgb.channels() != 3) throw input_error("the photo has {} channels instead of 3", rgb.channels());
  if (!mask.empty() && (mask.width() != rgb.width() || mask.height() != rgb.height() || mask.channels() != 1))
    throw input_error(
        "the mask is {} x {} pixels with {} channels; the photo is {} x {}, so it needs one channel "
        "of that size",
        mask.width(), mask.height(), mask.channels(), rgb.width(), rgb.height());
  if (mask.empty() && options.method == Method::mask)
    throw config_error("segment.method: mask needs a mask, and the photo has none (input.photos: mask)");
  if (mask.empty() && options.method == Method::alpha)
    throw config_error("segment.method: alpha needs a photo with an alpha channel");
  const bool wants_click = options.pick == Pick::click || options.pick == Pick::segment;
  if (wants_click && !region.click_px) throw config_error("segment.pick wants input.photos: click_px");
  if (options.pick == Pick::box && !region.box_px)
    throw config_error("segment.pick wants input.photos: box_px");
  if (options.pick == Pick::indices && options.indices.empty())
    throw config_error("segment.pick: indices needs segment.indices, the labels of segments.json");
  if (region.click_px) {
    const auto& [x, y] = *region.click_px;
    if (!(x >= 0 && y >= 0 && x <= rgb.width() && y <= rgb.height()))
      throw config_error("click_px [{}, {}] lies outside the photo of {} x {} pixels", x, y, rgb.width(),
                         rgb.height());
  }
  if (region.box_px) {
    const auto& [x, y, width, height] = *region.box_px;
    if (!(width > 0 && height > 0 && x < rgb.width() && y < rgb.height() && x + width > 0 && y + height > 0))
      throw config_error("box_px [{}, {}, {}, {}] holds no pixel of the photo of {} x {} pixels", x, y, width,
                         height, rgb.width(), rgb.height());
  }
  check_scribbles(rgb, region.scribbles);
  const Image8& scene = region.empty_scene;
  if (!scene.empty() &&
      (scene.width() != rgb.width() || scene.height() != rgb.height() || scene.channels() != 3))
    throw input_error("the photo of the empty scene is {} x {} pixels; the photo is {} x {}", scene.width(),
                      scene.height(), rgb.width(), rgb.height());
}

std::optional<std::array<int, 2>> pixel_of_click(const PhotoRegion& region, const Image8& photo) {
  if (!region.click_px) return std::nullopt;
  return std::array<int, 2>{clamped((*region.click_px)[0], photo.width() - 1),
                            clamped((*region.click_px)[1], photo.height() - 1)};
}

}  // namespace drape::segmentation
