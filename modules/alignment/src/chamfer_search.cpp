#include "chamfer_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "drape/base/parallel.hpp"

namespace drape::alignment {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;
constexpr int steps = 64;  // of a full turn: rolls, and directions in which supports are known
constexpr int channels = 8;
constexpr std::size_t most_samples = 64;
constexpr double near_px = 5;  // of the photo's window: what is further off does not count
constexpr int view_cells = 60;
constexpr double view_reach = 1.15;        // of a view's table, in radii
constexpr std::uint8_t unknown_near = 90;  // of 255: as near as wrong outlines often are
// Of the size by the area: what a fifth to a third too little or too much allows.
constexpr double least_size = 0.75;
constexpr double most_size = 1.35;
constexpr double part_sizes[] = {0.91, 1.12};  // a fifth too much, a fifth too little
constexpr std::size_t first_look = 16;         // samples
constexpr int least_first_sum = 85 * static_cast<int>(first_look);
constexpr std::size_t kept_for_moving = 4000;

struct Sample {
  float x = 0, y = 0;
  float direction = 0;  // outward, in steps
};

using Supports = std::array<double, steps>;

struct Outline {
  std::vector<Sample> samples;
  Supports supports{};
};

// Samples at equal lengths, in an order in which each first part is spread over all.
template <class Piece>
Outline outline_of(const std::vector<Piece>& pieces, double scale, const Eigen::Vector2d& origin) {
  Outline outline;
  outline.supports.fill(-1e9);
  double total = 0;
  for (const Piece& piece : pieces) {
    total += piece.length;
    const Eigen::Vector2d at = (piece.at + origin) / scale;
    for (int k = 0; k < steps; ++k) {
      const double angle = full_turn * k / steps;
      double& support = outline.supports[static_cast<std::size_t>(k)];
      support = std::max(support, at.x() * std::cos(angle) + at.y() * std::sin(angle));
    }
  }
  if (!(total > 0)) return outline;
  std::vector<Sample> along;
  double length = 0;
  double next = 0.5 * total / most_samples;
  for (const Piece& piece : pieces) {
    length += piece.length;
    for (; next < length; next += total / most_samples) {
      const Eigen::Vector2d at = (piece.at + origin) / scale;
      const double direction = std::atan2(piece.outward.y(), piece.outward.x()) * steps / full_turn;
      along.push_back(
          {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(direction)});
    }
  }
  const std::size_t stride = 23;  // prime to 64
  if (along.size() % stride == 0) return outline;
  for (std::size_t i = 0; i < along.size(); ++i) outline.samples.push_back(along[i * stride % along.size()]);
  return outline;
}

int channel_of(double direction_steps) {
  return static_cast<int>(direction_steps * channels / steps + 2.5 * channels) & (channels - 1);
}

// How near to an outline of about the same direction a place is, 0..255.
class NearnessTable {
 public:
  NearnessTable(int width, int height)
      : width_(width),
        height_(height),
        near_(static_cast<std::size_t>(width * height * channels), std::uint8_t{0}) {}

  void add(double x, double y, double direction_steps, double reach) {
    const int channel = channel_of(direction_steps);
    for (int j = std::max(0, static_cast<int>(y - reach));
         j <= std::min(height_ - 1, static_cast<int>(y + reach)); ++j)
      for (int i = std::max(0, static_cast<int>(x - reach));
           i <= std::min(width_ - 1, static_cast<int>(x + reach)); ++i) {
        const double squared =
            ((i + 0.5 - x) * (i + 0.5 - x) + (j + 0.5 - y) * (j + 0.5 - y)) / (reach * reach);
        if (squared >= 1) continue;
        const auto near = static_cast<std::uint8_t>(255 * (1 - squared));
        for (int c = channel + channels - 1; c <= channel + channels + 1; ++c) {
          std::uint8_t& best = at(i, j, c & (channels - 1));
          best = std::max(best, near);
        }
      }
  }
  void set_unknown(int x, int y) {
    for (int c = 0; c < channels; ++c) at(x, y, c) = unknown_near;
  }
  /// Beyond the table: `outside`.
  [[nodiscard]] int near(double x, double y, int channel, int outside) const {
    if (!(x >= 0) || !(y >= 0) || !(x < width_) || !(y < height_)) return outside;
    return near_[static_cast<std::size_t>((static_cast<int>(y) * width_ + static_cast<int>(x)) * channels +
                                          channel)];
  }

 private:
  std::uint8_t& at(int x, int y, int channel) {
    return near_[static_cast<std::size_t>((y * width_ + x) * channels + channel)];
  }
  int width_;
  int height_;
  std::vector<std::uint8_t> near_;
};

struct ViewOutline {
  Outline outline;
  NearnessTable near{view_cells, view_cells};
};

constexpr double cells_per_unit = view_cells / (2 * view_reach);

ViewOutline view_outline(const OutlineMesh& mesh, const AtlasView& view, double px_per_unit,
                         OutlineDrawing& drawing) {
  Window window;
  const double scale = draw_view(mesh, view, true, drawing, window);
  ViewOutline result;
  result.outline = outline_of(drawing.rim(), scale, window.origin);
  for (const Sample& s : result.outline.samples)
    result.near.add((s.x + view_reach) * cells_per_unit, (s.y + view_reach) * cells_per_unit, s.direction,
                    near_px / px_per_unit * cells_per_unit);
  return result;
}

class ChamferSearch {
 public:
  ChamferSearch(const OutlineMesh& mesh, const std::vector<AtlasView>& views, const StencilLevel& photo);

  [[nodiscard]] std::vector<ChamferMatch> matches(std::size_t most) const;

 private:
  // The best place of one view at one roll; a score of 0: none is any good.
  [[nodiscard]] ChamferMatch placed(std::size_t view, int roll) const;
  [[nodiscard]] double score(const ChamferMatch& match) const;
  void move(ChamferMatch& match) const;

  const std::vector<AtlasView>& views_;
  std::vector<ViewOutline> outlines_;
  Outline photo_;
  NearnessTable near_;
  double photo_radius_ = 1;  // of gyration, px
};

ChamferSearch::ChamferSearch(const OutlineMesh& mesh, const std::vector<AtlasView>& views,
                             const StencilLevel& photo)
    : views_(views), outlines_(views.size()), near_(photo.window.width, photo.window.height) {
  photo_ = outline_of(photo.contour, 1, Eigen::Vector2d::Zero());
  for (const ContourPoint& point : photo.contour)
    near_.add(point.at.x(), point.at.y(),
              std::atan2(point.outward.y(), point.outward.x()) * steps / full_turn, near_px);
  for (int y = 0; y < photo.window.height; ++y)
    for (int x = 0; x < photo.window.width; ++x)
      if (!photo.known.at(x, y)) near_.set_unknown(x, y);
  photo_radius_ = std::max(1.0, polar_frame(photo.object).radius);
  parallel_for(views.size(), 16, [&](std::size_t begin, std::size_t end) {
    OutlineDrawing drawing;
    for (std::size_t v = begin; v < end; ++v)
      outlines_[v] = view_outline(mesh, views[v], photo_radius_ / views[v].frame.radius, drawing);
  });
}

ChamferMatch ChamferSearch::placed(std::size_t view, int roll) const {
  const Outline& outline = outlines_[view].outline;
  const std::size_t count = outline.samples.size();
  const double angle = full_turn * roll / steps;
  const auto c = static_cast<float>(std::cos(angle));
  const auto s = static_cast<float>(std::sin(angle));
  std::array<Sample, most_samples + 1> turned;
  std::array<int, most_samples + 1> channel{};
  for (std::size_t i = 0; i < count; ++i) {
    const Sample& x = outline.samples[i];
    turned[i] = {c * x.x - s * x.y, s * x.x + c * x.y, x.direction + static_cast<float>(roll)};
    channel[i] = channel_of(turned[i].direction);
  }
  const double usual_scale = photo_radius_ / views_[view].frame.radius;
  ChamferMatch best{0, view, angle, 1, Eigen::Vector2d::Zero()};
  int best_sum = 0;
  const auto try_place = [&](double scale, double tx, double ty) {
    if (!(scale > least_size * usual_scale) || !(scale < most_size * usual_scale)) return;
    const auto nearness = [&](std::size_t i) {
      return near_.near(scale * turned[i].x + tx, scale * turned[i].y + ty, channel[i], unknown_near);
    };
    int sum = 0;
    std::size_t i = 0;
    for (; i < std::min(first_look, count); ++i) sum += nearness(i);
    if (sum < least_first_sum) return;
    for (; i < count; ++i) sum += nearness(i);
    if (sum <= best_sum) return;
    best_sum = sum;
    best.scale = scale;
    best.shift << tx, ty;
  };
  const auto of_view = [&](int k) { return outline.supports[static_cast<std::size_t>((k - roll) & 63)]; };
  const auto of_photo = [&](int k) { return photo_.supports[static_cast<std::size_t>(k & 63)]; };
  for (int k = 0; k < steps; k += steps / 8) {
    const int across = k + steps / 4;
    const double a = full_turn * k / steps;
    const auto place = [&](double scale) {
      const double along = of_photo(k) - scale * of_view(k);
      const double aside = of_photo(across) - scale * of_view(across);
      try_place(scale, along * std::cos(a) - aside * std::sin(a), along * std::sin(a) + aside * std::cos(a));
    };
    const int opposite = k + steps / 2;
    place((of_photo(k) + of_photo(opposite)) / (of_view(k) + of_view(opposite)));
    for (const double size : part_sizes) place(size * usual_scale);
  }
  best.score = count == 0 ? 0 : best_sum / (255.0 * static_cast<double>(count));
  return best;
}

// Mean of how near each outline is to the other.
double ChamferSearch::score(const ChamferMatch& match) const {
  const ViewOutline& view = outlines_[match.view];
  const double c = std::cos(match.angle);
  const double s = std::sin(match.angle);
  const double turn = match.angle * steps / full_turn;
  int forward = 0;
  for (const Sample& x : view.outline.samples)
    forward += near_.near(match.scale * (c * x.x - s * x.y) + match.shift.x(),
                          match.scale * (s * x.x + c * x.y) + match.shift.y(), channel_of(x.direction + turn),
                          unknown_near);
  int backward = 0;
  const double cells = cells_per_unit / match.scale;
  const double middle = view_cells / 2.0;
  for (const Sample& p : photo_.samples) {
    const double x = (p.x - match.shift.x()) * cells;
    const double y = (p.y - match.shift.y()) * cells;
    backward +=
        view.near.near(c * x + s * y + middle, c * y - s * x + middle, channel_of(p.direction - turn), 0);
  }
  return (forward / static_cast<double>(view.outline.samples.size()) +
          backward / static_cast<double>(photo_.samples.size())) /
         510;
}

// Coordinate by coordinate to where the score is best, with steps that are halved.
void ChamferSearch::move(ChamferMatch& match) const {
  match.score = score(match);
  for (double step = 3; step > 0.5; step /= 2) {  // px at the outline
    for (int coordinate = 0; coordinate < 4; ++coordinate)
      for (const double sign : {-1.0, 1.0}) {
        ChamferMatch moved = match;
        const double by = sign * step;
        if (coordinate < 2) moved.shift[coordinate] += by;
        if (coordinate == 2) moved.scale *= 1 + by / (1.4 * photo_radius_);
        if (coordinate == 3) moved.angle += by / (1.4 * photo_radius_);
        moved.score = score(moved);
        if (moved.score > match.score) match = moved;
      }
  }
}

std::vector<ChamferMatch> ChamferSearch::matches(std::size_t most) const {
  std::vector<std::vector<ChamferMatch>> found(views_.size());
  const auto best_first = [](const ChamferMatch& a, const ChamferMatch& b) { return a.score > b.score; };
  parallel_for(views_.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      for (int roll = 0; roll < steps; ++roll) {
        const ChamferMatch match = placed(v, roll);
        if (match.score > 0) found[v].push_back(match);
      }
  });
  std::vector<ChamferMatch> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  std::stable_sort(all.begin(), all.end(), best_first);
  all.resize(std::min(all.size(), kept_for_moving));
  parallel_for(all.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) move(all[i]);
  });
  std::stable_sort(all.begin(), all.end(), best_first);
  all.resize(std::min(all.size(), most));
  return all;
}

}  // namespace

std::vector<ChamferMatch> chamfer_matches(const OutlineMesh& mesh, const std::vector<AtlasView>& views,
                                          const StencilLevel& photo, std::size_t most) {
  const ChamferSearch search(mesh, views, photo);
  return search.matches(most);
}

}  // namespace drape::alignment
