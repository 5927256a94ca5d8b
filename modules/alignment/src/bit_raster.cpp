#include "bit_raster.hpp"

#include <algorithm>
#include <cmath>

namespace drape::alignment {
namespace {

// The first pixel whose centre is at or beyond `x`. Truncation of a positive number is several times faster
// than std::ceil where the processor's own rounding may not be assumed.
int first_center(double x, double most) {
  const double within = std::clamp(x - 0.5, -1.0, most);
  return 65536 - static_cast<int>(65536.0 - within);
}

struct Side {
  double x, y, slope;
  // `a` is above `b`, or as high.
  Side(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
      : x(a.x()), y(a.y()), slope((b.x() - a.x()) / (b.y() - a.y())) {}
  [[nodiscard]] double at(double row) const { return x + (row - y) * slope; }
};

void set_span(std::span<std::uint64_t> row, int from, int to) {
  if (from >= to) return;
  const auto first = static_cast<std::size_t>(from >> 6);
  const auto last = static_cast<std::size_t>((to - 1) >> 6);
  const std::uint64_t head = ~std::uint64_t{0} << (from & 63);
  const std::uint64_t tail = ~std::uint64_t{0} >> (63 - ((to - 1) & 63));
  if (first == last) {
    row[first] |= head & tail;
    return;
  }
  row[first] |= head;
  for (std::size_t i = first + 1; i < last; ++i) row[i] = ~std::uint64_t{0};
  row[last] |= tail;
}

// Spreads the bits of `seed` along the runs of `open` that they are in (Kogge and Stone's doubling).
std::uint64_t flooded(std::uint64_t seed, std::uint64_t open) {
  std::uint64_t up = open;
  std::uint64_t down = open;
  std::uint64_t filled = seed;
  for (int shift = 1; shift < 64; shift *= 2) {
    filled |= up & (filled << shift);
    up &= up << shift;
  }
  for (int shift = 1; shift < 64; shift *= 2) {
    filled |= down & (filled >> shift);
    down &= down >> shift;
  }
  return filled;
}

void draw_rows(const Side& a, const Side& b, int from, int to, BitImage& image) {
  const double most = image.width();
  for (int y = from; y < to; ++y) {
    const double xa = a.at(y + 0.5);
    const double xb = b.at(y + 0.5);
    set_span(image.row(y), std::max(0, first_center(std::min(xa, xb), most)),
             std::min(image.width(), first_center(std::max(xa, xb), most)));
  }
}

}  // namespace

void draw_faces(std::span<const Eigen::Vector2d> places, std::span<const Face> faces, BitImage& image) {
  const double most = image.height();
  for (const Face& face : faces) {
    const Eigen::Vector2d* top = &places[face[0]];
    const Eigen::Vector2d* middle = &places[face[1]];
    const Eigen::Vector2d* bottom = &places[face[2]];
    if (middle->y() < top->y()) std::swap(top, middle);
    if (bottom->y() < middle->y()) std::swap(middle, bottom);
    if (middle->y() < top->y()) std::swap(top, middle);
    const int first = std::max(0, first_center(top->y(), most));
    const int end = std::min(image.height(), first_center(bottom->y(), most));
    if (first >= end) continue;
    const Side whole(*top, *bottom);
    const int turn = std::clamp(first_center(middle->y(), most), first, end);
    if (first < turn) draw_rows(whole, Side(*top, *middle), first, turn, image);
    if (turn < end) draw_rows(whole, Side(*middle, *bottom), turn, end, image);
  }
}

void WindingFill::begin(int width, int height) {
  width_ = width;
  height_ = height;
  crossings_.clear();
}

void WindingFill::add_edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int winding) {
  const bool down = from.y() < to.y();
  const Eigen::Vector2d& top = down ? from : to;
  const Eigen::Vector2d& bottom = down ? to : from;
  const double most = height_;
  const int first = std::max(0, first_center(top.y(), most));
  const int end = std::min(height_, first_center(bottom.y(), most));
  if (first >= end) return;
  const Side side(top, bottom);
  for (int y = first; y < end; ++y) {
    const int column = std::max(0, first_center(side.at(y + 0.5), width_));
    if (column < width_) crossings_.push_back({y, column, down ? winding : -winding});
  }
}

void WindingFill::fill(BitImage& image) {
  row_begin_.assign(static_cast<std::size_t>(height_) + 2, 0);
  for (const Crossing& crossing : crossings_) ++row_begin_[static_cast<std::size_t>(crossing.row) + 2];
  for (std::size_t i = 2; i < row_begin_.size(); ++i) row_begin_[i] += row_begin_[i - 1];
  sorted_.resize(crossings_.size());
  for (const Crossing& crossing : crossings_)
    sorted_[row_begin_[static_cast<std::size_t>(crossing.row) + 1]++] = crossing;
  for (int y = 0; y < height_; ++y) {
    const auto begin = sorted_.begin() + row_begin_[static_cast<std::size_t>(y)];
    const auto end = sorted_.begin() + row_begin_[static_cast<std::size_t>(y) + 1];
    std::sort(begin, end, [](const Crossing& a, const Crossing& b) { return a.column < b.column; });
    int winding = 0;
    for (auto i = begin; i != end; ++i) {
      winding += i->winding;
      if (winding > 0) set_span(image.row(y), i->column, i + 1 == end ? width_ : (i + 1)->column);
    }
  }
}

BitImage enclosed_gaps(const BitImage& mesh) {
  const int height = mesh.height();
  const std::size_t words = height == 0 ? 0 : mesh.row(0).size();
  BitImage outside(mesh.width(), height);
  const auto open_word = [&](int y, std::size_t i) {
    return ~mesh.row(y)[i] & (i + 1 == words ? mesh.last_word_mask() : ~std::uint64_t{0});
  };
  // Spreads what is outside from the rows above and below and from both sides along row `y`.
  const auto flood_row = [&](int y) {
    const std::span<std::uint64_t> row = outside.row(y);
    bool changed = false;
    const auto flood_word = [&](std::size_t i, std::uint64_t seed) {
      const std::uint64_t open = open_word(y, i);
      const std::uint64_t wet = (row[i] | seed) & open;
      // Most words are all outside or not at all.
      if (wet == row[i] && (wet == 0 || wet == open)) return;
      const std::uint64_t filled = wet == open ? open : flooded(wet, open);
      changed |= filled != row[i];
      row[i] = filled;
    };
    for (std::size_t i = 0; i < words; ++i) {
      const bool edge_row = y == 0 || y + 1 == height;
      const std::uint64_t beside = i == 0 ? 1 : row[i - 1] >> 63;
      const std::uint64_t rows = edge_row ? ~std::uint64_t{0} : outside.row(y - 1)[i] | outside.row(y + 1)[i];
      flood_word(i, rows | beside);
    }
    for (std::size_t i = words; i-- > 0;)
      flood_word(i, i + 1 == words ? std::uint64_t{1} << ((mesh.width() - 1) & 63) : row[i + 1] << 63);
    return changed;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (int y = 0; y < height; ++y) changed |= flood_row(y);
    for (int y = height; y-- > 0;) changed |= flood_row(y);
  }
  BitImage gaps(mesh.width(), height);
  for (int y = 0; y < height; ++y)
    for (std::size_t i = 0; i < words; ++i) gaps.row(y)[i] = open_word(y, i) & ~outside.row(y)[i];
  return gaps;
}

}  // namespace drape::alignment
