#include "area_prefilter.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "linear_light.hpp"

namespace drape::texturing {
namespace {

// How much of its neighbours on each side a pixel is taken to hold.
constexpr float side = 1 / 16.F;

// One channel, row by row.
struct Plane {
  int width;
  int height;
  std::vector<float> values;
  [[nodiscard]] float* row(int y) {
    return values.data() + static_cast<std::ptrdiff_t>(y) * static_cast<std::ptrdiff_t>(width);
  }
};

// `count` items of `size` floats each, `stride` apart: the recursions run over the items.
void filter(float* first, int count, std::ptrdiff_t stride, int size) {
  if (count < 2) return;
  constexpr float half = (1 - 2 * side) / (2 * side);
  static const float pole = std::sqrt(half * half - 1) - half;
  constexpr int horizon = 16;  // the pole to this power is nothing
  const auto item = [&](int i) { return first + i * stride; };
  for (int j = 0; j < size; ++j) {
    float sum = 0;
    float power = 1;
    for (int i = 0; i < std::min(count, horizon); ++i) {
      sum += power * item(i)[j];
      power *= pole;
    }
    item(0)[j] = sum;
  }
  for (int i = 1; i < count; ++i)
    for (int j = 0; j < size; ++j) item(i)[j] += pole * item(i - 1)[j];
  const float end = pole / (pole * pole - 1);
  for (int j = 0; j < size; ++j) item(count - 1)[j] = end * (item(count - 1)[j] + pole * item(count - 2)[j]);
  for (int i = count - 2; i >= 0; --i)
    for (int j = 0; j < size; ++j) item(i)[j] = pole * (item(i + 1)[j] - item(i)[j]);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < size; ++j) item(i)[j] /= side;
}

}  // namespace

template <class Sample>
void prefilter_areas(Image<Sample>& rgb) {
  Plane plane{rgb.width(), rgb.height(), {}};
  plane.values.resize(static_cast<std::size_t>(rgb.width()) * static_cast<std::size_t>(rgb.height()));
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < rgb.height(); ++y)
      for (int x = 0; x < rgb.width(); ++x) plane.row(y)[x] = linear_from(rgb.at(x, y, c));
    for (int y = 0; y < rgb.height(); ++y) filter(plane.row(y), rgb.width(), 1, 1);
    filter(plane.row(0), rgb.height(), rgb.width(), rgb.width());
    for (int y = 0; y < rgb.height(); ++y)
      for (int x = 0; x < rgb.width(); ++x) rgb.at(x, y, c) = stored_as<Sample>(plane.row(y)[x]);
  }
}

template void prefilter_areas(Image8& rgb);
template void prefilter_areas(Image16& rgb);

}  // namespace drape::texturing
