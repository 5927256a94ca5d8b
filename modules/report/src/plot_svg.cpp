#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "drape/report/comparison_page.hpp"
#include "drape/report/readable_number.hpp"
#include "html_text.hpp"

namespace drape::report {
namespace {

constexpr double width = 360;
constexpr double height = 250;
constexpr double left = 58;
constexpr double right = 14;
constexpr double top = 30;
constexpr double bottom = 46;

struct Axis {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  void cover(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  // Some air at both ends; one value alone stands in the middle.
  void widen() {
    const double air = most > least ? 0.06 * (most - least) : std::max(std::abs(most) * 0.1, 0.5);
    least -= air;
    most += air;
  }
  [[nodiscard]] double share(double value) const { return (value - least) / (most - least); }
};

double x_at(const Axis& axis, double x) {
  return left + axis.share(x) * (width - left - right);
}

double y_at(const Axis& axis, double y) {
  return height - bottom - axis.share(y) * (height - top - bottom);
}

// Ticks at 1, 2 or 5 times a power of ten (Heckbert, "Nice numbers for graph labels", Graphics Gems, 1990).
std::vector<double> ticks(const Axis& axis, int about) {
  const double rough = (axis.most - axis.least) / about;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double share = rough / power;
  const double step = (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10) * power;
  std::vector<double> values;
  for (double i = std::ceil(axis.least / step); i * step <= axis.most; ++i) values.push_back(i * step);
  return values;
}

std::string label(double x, double y, std::string_view anchor, std::string_view text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     escaped(text));
}

std::string axes(const Plot& plot, const Axis& x, const Axis& y) {
  std::string text;
  for (const double value : ticks(y, 4)) {
    const double at = y_at(y, value);
    text +=
        fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"var(--line)\"/>\n", left, at, width - right);
    text += label(left - 6, at + 4, "end", readable_value(value));
  }
  if (plot.x_names.empty())
    for (const double value : ticks(x, 4))
      text += label(x_at(x, value), height - bottom + 16, "middle", readable_value(value));
  for (std::size_t i = 0; i < plot.x_names.size(); ++i)
    text += label(x_at(x, static_cast<double>(i)), height - bottom + 16, "middle", plot.x_names[i]);
  text += label((left + width - right) / 2, height - 8, "middle", plot.x_label);
  return text + label(left, 16, "start", plot.y_label);
}

}  // namespace

std::string plot_svg(const Plot& plot) {
  Axis x;
  Axis y;
  for (std::size_t i = 0; i < plot.x_names.size(); ++i) x.cover(static_cast<double>(i));
  for (const PlotPoint& point : plot.points)
    if (std::isfinite(point.x) && std::isfinite(point.y)) {
      x.cover(point.x);
      y.cover(point.y);
    }
  if (!(y.most >= y.least)) return "<p class=\"meta\">" + escaped(plot.title) + ": no numbers to show</p>\n";
  x.widen();
  y.widen();
  std::string text = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" font-size=\"11\" fill=\"var(--soft)\" "
      "xmlns=\"http://www.w3.org/2000/svg\">\n",
      width, height, escaped(plot.title));
  text += axes(plot, x, y);
  for (const PlotPoint& point : plot.points) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    text += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\" fill=\"var(--accent)\" "
        "fill-opacity=\".75\"><title>{}</title></circle>\n",
        x_at(x, point.x), y_at(y, point.y), escaped(point.label));
  }
  return text + "</svg>\n";
}

}  // namespace drape::report
