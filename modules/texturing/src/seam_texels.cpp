#include "seam_texels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace drape::texturing {
namespace {

constexpr double spacing_texels = 0.5;  // of the places where the sides are compared
constexpr float keep = 0.03F;           // weight of a texel's own colour against agreement at one place
constexpr int most_steps = 40;
constexpr float settled = 1e-4F;  // of the residual at the start

// What one place reads: texels with bilinear weights, those of the second side negative.
struct Reading {
  std::array<std::uint32_t, 8> texels;
  std::array<float, 8> weights;
};

template <class Sample>
class Texels {
 public:
  explicit Texels(std::span<Image<Sample>* const> pages) : pages_(pages) {}

  std::uint32_t number_of(std::uint32_t page, int x, int y) {
    const Image<Sample>& image = *pages_[page];
    x = std::clamp(x, 0, image.width() - 1);
    y = std::clamp(y, 0, image.height() - 1);
    const std::uint64_t key = (static_cast<std::uint64_t>(page) << 32U) |
                              static_cast<std::uint64_t>(y * static_cast<std::int64_t>(image.width()) + x);
    const auto [at, fresh] = numbers_.emplace(key, static_cast<std::uint32_t>(places_.size()));
    if (fresh) {
      places_.push_back({page, x, y});
      colors_.emplace_back(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
    }
    return at->second;
  }

  [[nodiscard]] const std::vector<Eigen::Vector3f>& colors() const { return colors_; }

  void write(const std::vector<Eigen::Vector3f>& changes) {
    constexpr float most = std::numeric_limits<Sample>::max();
    for (std::size_t i = 0; i < places_.size(); ++i)
      for (int c = 0; c < 3; ++c)
        pages_[places_[i].page]->at(places_[i].x, places_[i].y, c) =
            static_cast<Sample>(std::lround(std::clamp(colors_[i][c] + changes[i][c], 0.F, most)));
  }

 private:
  struct Place {
    std::uint32_t page;
    int x;
    int y;
  };
  std::span<Image<Sample>* const> pages_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
  std::vector<Place> places_;
  std::vector<Eigen::Vector3f> colors_;
};

template <class Sample>
void read(const Seam::Side& side, double share, float sign, std::size_t first, Texels<Sample>& texels,
          Reading& r) {
  const Eigen::Vector2d p = side.from + share * (side.to - side.from);
  const double px = p.x() - 0.5;
  const double py = p.y() - 0.5;
  const int x = static_cast<int>(std::floor(px));
  const int y = static_cast<int>(std::floor(py));
  const auto fx = static_cast<float>(px - x);
  const auto fy = static_cast<float>(py - y);
  for (int i = 0; i < 4; ++i) {
    const int right = i % 2;
    const int below = i / 2;
    r.texels[first + static_cast<std::size_t>(i)] = texels.number_of(side.page, x + right, y + below);
    r.weights[first + static_cast<std::size_t>(i)] =
        sign * (right == 1 ? fx : 1 - fx) * (below == 1 ? fy : 1 - fy);
  }
}

using Colors = std::vector<Eigen::Vector3f>;

Eigen::Vector3f shown(const Reading& r, const Colors& colors) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < r.texels.size(); ++i) sum += r.weights[i] * colors[r.texels[i]];
  return sum;
}

// The normal equations' left side: what places make of changes, spread back, and the pull to stay.
void apply(const std::vector<Reading>& readings, const Colors& x, Colors& out) {
  for (std::size_t i = 0; i < x.size(); ++i) out[i] = keep * x[i];
  for (const Reading& r : readings) {
    const Eigen::Vector3f step = shown(r, x);
    for (std::size_t i = 0; i < r.texels.size(); ++i) out[r.texels[i]] += r.weights[i] * step;
  }
}

Eigen::Vector3f inner(const Colors& a, const Colors& b) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].cwiseProduct(b[i]).cast<double>();
  return sum.cast<float>();
}

// Conjugate gradients, the three channels side by side.
Colors solved(const std::vector<Reading>& readings, const Colors& colors) {
  Colors x(colors.size(), Eigen::Vector3f::Zero());
  Colors residual = x;
  for (const Reading& r : readings) {
    const Eigen::Vector3f step = shown(r, colors);
    for (std::size_t i = 0; i < r.texels.size(); ++i) residual[r.texels[i]] -= r.weights[i] * step;
  }
  Colors direction = residual;
  Colors applied = x;
  Eigen::Vector3f rest = inner(residual, residual);
  const Eigen::Vector3f enough = settled * settled * rest;
  for (int step = 0; step < most_steps && (rest.array() > enough.array()).any(); ++step) {
    apply(readings, direction, applied);
    const Eigen::Vector3f curvature = inner(direction, applied).cwiseMax(1e-20F);
    const Eigen::Vector3f length = rest.cwiseQuotient(curvature);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] += length.cwiseProduct(direction[i]);
      residual[i] -= length.cwiseProduct(applied[i]);
    }
    const Eigen::Vector3f next = inner(residual, residual);
    const Eigen::Vector3f turn = next.cwiseQuotient(rest.cwiseMax(1e-20F));
    for (std::size_t i = 0; i < x.size(); ++i) direction[i] = residual[i] + turn.cwiseProduct(direction[i]);
    rest = next;
  }
  return x;
}

}  // namespace

template <class Sample>
void match_texels_along(std::span<const Seam> seams, std::span<Image<Sample>* const> pages) {
  Texels<Sample> texels(pages);
  std::vector<Reading> readings;
  for (const Seam& seam : seams) {
    double length = 0;
    for (const Seam::Side& s : seam.sides) length = std::max(length, (s.to - s.from).norm());
    const int count = std::max(1, static_cast<int>(std::ceil(length / spacing_texels)));
    for (int i = 0; i < count; ++i) {
      const double share = (i + 0.5) / count;
      Reading& r = readings.emplace_back();
      read(seam.sides[0], share, 1, 0, texels, r);
      read(seam.sides[1], share, -1, 4, texels, r);
    }
  }
  if (!readings.empty()) texels.write(solved(readings, texels.colors()));
}

template void match_texels_along(std::span<const Seam> seams, std::span<Image8* const> pages);
template void match_texels_along(std::span<const Seam> seams, std::span<Image16* const> pages);

}  // namespace drape::texturing
