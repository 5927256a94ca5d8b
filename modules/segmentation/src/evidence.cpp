#include "evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "cast_shadow.hpp"
#include "drape/base/concurrent.hpp"
#include "drape/base/random.hpp"
#include "grabcut.hpp"
#include "object_evidence.hpp"
#include "stencil_shape.hpp"

namespace drape::segmentation {
namespace {

constexpr double edge_difference = 12;  // Lab step across the outline that counts as an edge
constexpr int edge_reach_px = 2;        // how far inside and outside the outline it is measured
// Unaided, a cut has no safe background to learn from and takes in look-alikes, while standing out from the
// border misses dull parts: a mean of the two; more than half of the cut, or enclosed backdrop stays in.
constexpr float cut_share_unaided = 0.6F;
constexpr std::array<double, 4> click_radii = {0.1, 0.18, 0.3, 0.45};  // of the shorter side
constexpr double click_margin = 1.6;  // half the box that surrounds the object, in radii of the first guess
constexpr std::size_t most_scribble_samples = 400;  // of each kind

// The value that splits the evidence into two classes of the most different means (Otsu 1979).
float otsu_threshold(const ImageF& evidence) {
  constexpr int bins = 256;
  std::array<double, bins> histogram{};
  for (const float e : evidence.data())
    ++histogram[static_cast<std::size_t>(std::clamp(static_cast<int>(e * bins), 0, bins - 1))];
  double total = 0;
  double sum = 0;
  for (std::size_t i = 0; i < bins; ++i) {
    total += histogram[i];
    sum += histogram[i] * static_cast<double>(i);
  }
  double below = 0;
  double sum_below = 0;
  double best = 0;
  std::size_t split = bins / 2;
  for (std::size_t i = 0; i + 1 < bins; ++i) {
    below += histogram[i];
    sum_below += histogram[i] * static_cast<double>(i);
    const double above = total - below;
    if (below == 0 || above == 0) continue;
    const double apart = sum_below / below - (sum - sum_below) / above;
    if (below * above * apart * apart <= best) continue;
    best = below * above * apart * apart;
    split = i + 1;
  }
  return static_cast<float>(split) / bins;
}

Evidence evidence_of_stencil(const Image8& shape) {
  Evidence evidence;
  evidence.value = ImageF(shape.width(), shape.height(), 1, 0.F);
  for (std::size_t i = 0; i < shape.data().size(); ++i)
    if (shape.data()[i] == stencil::object) evidence.value.data()[i] = 1;
  evidence.is_a_cut = true;
  return evidence;
}

Evidence by_backdrop(const ImageF& lab, const Backdrop& backdrop, const Hints& hints) {
  Evidence evidence;
  evidence.value = backdrop.difference;
  Image8 as_bright(lab.width(), lab.height(), 1, 0);
  for (std::size_t i = 0; i < as_bright.data().size(); ++i)
    if (backdrop.difference.data()[i] < 1) as_bright.data()[i] = 1;
  evidence.unknown = cast_shadow(lab, as_bright, backdrop.darker);
  for (float& value : evidence.value.data()) value = 1 - std::exp2(-value);  // one half at the limit
  if (hints.box)
    for (int y = 0; y < lab.height(); ++y)
      for (int x = 0; x < lab.width(); ++x) {
        const auto& [left, top, right, bottom] = *hints.box;
        if (x < left || y < top || x >= right || y >= bottom) evidence.value.at(x, y) = 0;
      }
  return evidence;
}

// Colour and position of the pixels that one kind of scribble marks; at most so many, evenly taken.
std::vector<std::array<float, 5>> scribbled(const ImageF& lab, const Image8& scribbles, std::uint8_t kind) {
  std::vector<std::array<float, 5>> all;
  const float scale = 50.F / static_cast<float>(std::max(lab.width(), lab.height()));
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x)
      if (scribbles.at(x, y) == kind)
        all.push_back({lab.at(x, y, 0), lab.at(x, y, 1), lab.at(x, y, 2), scale * static_cast<float>(x),
                       scale * static_cast<float>(y)});
  if (all.size() <= most_scribble_samples) return all;
  std::vector<std::array<float, 5>> some;
  for (std::size_t i = 0; i < most_scribble_samples; ++i)
    some.push_back(all[i * all.size() / most_scribble_samples]);
  return some;
}

float nearest(const std::vector<std::array<float, 5>>& samples, const std::array<float, 5>& pixel) {
  float best = std::numeric_limits<float>::max();
  for (const auto& sample : samples) {
    float distance = 0;
    for (std::size_t c = 0; c < 5; ++c) distance += (sample[c] - pixel[c]) * (sample[c] - pixel[c]);
    best = std::min(best, distance);
  }
  return best;
}

// Every pixel is what the scribble of the nearest colour and place says; then a minimum cut.
Evidence by_scribbles(const Image8& rgb, const ImageF& lab, const Hints& hints, std::uint64_t seed) {
  const auto object = scribbled(lab, hints.scribbles, stencil::object);
  const auto background = scribbled(lab, hints.scribbles, stencil::background);
  Image8 guess(lab.width(), lab.height(), 1, stencil::background);
  const float scale = 50.F / static_cast<float>(std::max(lab.width(), lab.height()));
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      const std::array<float, 5> pixel = {lab.at(x, y, 0), lab.at(x, y, 1), lab.at(x, y, 2),
                                          scale * static_cast<float>(x), scale * static_cast<float>(y)};
      if (nearest(object, pixel) < nearest(background, pixel)) guess.at(x, y) = stencil::object;
    }
  return evidence_of_stencil(grabcut(rgb, guess, hints, seed));
}

// GrabCut from circles of several sizes round the click; of the cuts the one whose outline lies on edges
// most.
Image8 cut_round_click(const Image8& rgb, const ImageF& lab, const Hints& hints, std::uint64_t seed) {
  const auto [cx, cy] = *hints.click;
  const int side = std::min(rgb.width(), rgb.height());
  Image8 best;
  double best_score = -1;
  for (std::size_t i = 0; i < click_radii.size(); ++i) {
    const int radius = std::max(2, static_cast<int>(click_radii[i] * side));
    const int reach = static_cast<int>(click_margin * radius);
    Hints round = hints;
    round.box = {std::max(0, cx - reach), std::max(0, cy - reach), std::min(rgb.width(), cx + reach + 1),
                 std::min(rgb.height(), cy + reach + 1)};
    const Image8 guess = elliptic_guess(rgb.width(), rgb.height(),
                                        {cx - radius, cy - radius, cx + radius + 1, cy + radius + 1});
    const Image8 cut = without_islands(grabcut(rgb, guess, round, item_seed(seed, i)), 1, hints.click);
    const double score = edge_share(cut, lab);
    if (score <= best_score) continue;
    best_score = score;
    best = cut;
  }
  return best;
}

// GrabCut's mixtures end in the minimum that is nearest to their start: of a start from the box's ellipse and
// one from all of the box, the cut whose outline lies on edges more.
Image8 cut_in_box(const Image8& rgb, const ImageF& lab, const Hints& hints, std::uint64_t seed) {
  const auto& [left, top, right, bottom] = *hints.box;
  Image8 all(rgb.width(), rgb.height(), 1, stencil::background);
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) all.at(x, y) = stencil::object;
  Image8 from_ellipse;
  Image8 from_all;
  run_concurrently({[&] {
                      from_ellipse = grabcut(rgb, elliptic_guess(rgb.width(), rgb.height(), *hints.box),
                                             hints, item_seed(seed, 0));
                    },
                    [&] { from_all = grabcut(rgb, all, hints, item_seed(seed, 1)); }});
  return edge_share(from_all, lab) > edge_share(from_ellipse, lab) ? from_all : from_ellipse;
}

Evidence by_contrast(const Image8& rgb, const ImageF& lab, const Hints& hints, std::uint64_t seed) {
  Evidence evidence;
  evidence.value = object_evidence(lab, hints);
  if (*std::max_element(evidence.value.data().begin(), evidence.value.data().end()) == 0)
    return evidence;  // no contrast: nothing to cut either
  Hints within = hints;
  within.box = inset_box(rgb.width(), rgb.height());
  const Image8 cut = hints.click
                         ? cut_round_click(rgb, lab, hints, seed)
                         : grabcut(rgb, elliptic_guess(rgb.width(), rgb.height(), *within.box), within, seed);
  for (std::size_t i = 0; i < evidence.value.data().size(); ++i) {
    const float in_cut = cut.data()[i] == stencil::object ? 1.F : 0.F;
    evidence.value.data()[i] += cut_share_unaided * (in_cut - evidence.value.data()[i]);
  }
  evidence.threshold = otsu_threshold(evidence.value);
  return evidence;
}

bool holds_both_kinds(const Image8& scribbles) {
  const auto& marks = scribbles.data();
  return std::find(marks.begin(), marks.end(), stencil::object) != marks.end() &&
         std::find(marks.begin(), marks.end(), stencil::background) != marks.end();
}

}  // namespace

Evidence evidence_of(const Image8& rgb, const ImageF& lab, const std::optional<Backdrop>& backdrop,
                     const Hints& hints, std::uint64_t seed) {
  if (backdrop) return by_backdrop(lab, *backdrop, hints);
  if (holds_both_kinds(hints.scribbles)) return by_scribbles(rgb, lab, hints, seed);
  if (hints.box) return evidence_of_stencil(cut_in_box(rgb, lab, hints, seed));
  return by_contrast(rgb, lab, hints, seed);
}

double edge_share(const Image8& shape, const ImageF& lab) {
  double edges = 0;
  double outline = 0;
  const auto look = [&](int x, int y, int dx, int dy) {
    if (!shape.contains(x + dx, y + dy) || shape.at(x, y) == shape.at(x + dx, y + dy)) return;
    outline += 1;
    const int ax = x - (edge_reach_px - 1) * dx;
    const int ay = y - (edge_reach_px - 1) * dy;
    const int bx = x + edge_reach_px * dx;
    const int by = y + edge_reach_px * dy;
    if (!shape.contains(ax, ay) || !shape.contains(bx, by)) return;
    if (squared_difference(&lab.at(ax, ay), &lab.at(bx, by)) > edge_difference * edge_difference) edges += 1;
  };
  for (int y = 0; y < shape.height(); ++y)
    for (int x = 0; x < shape.width(); ++x) {
      look(x, y, 1, 0);
      look(x, y, 0, 1);
    }
  return outline > 0 ? edges / outline : 0;
}

}  // namespace drape::segmentation
