// A page that sets several runs beside one another: tables, plots and pictures.
#pragma once

#include <string>
#include <vector>

#include "drape/report/page.hpp"

namespace drape::report {

struct PlotPoint {
  double x = 0;
  double y = 0;
  std::string label;  // shown when the pointer rests on it
};

/// Points on two axes. Points that are not finite are left out.
struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<std::string> x_names;  // if not empty, x counts these, and they are written on the axis
  std::vector<PlotPoint> points;
};

struct ComparisonSection {
  std::string heading;
  std::string text;                            // one paragraph; may be empty
  std::vector<std::string> columns;            // of the table
  std::vector<std::vector<std::string>> rows;  // as many cells each
  std::vector<Plot> plots;
  std::vector<Picture> pictures;
  int pictures_in_row = 0;                                 // 0: as many as there is room for
  std::vector<std::vector<std::string>> folded_rows = {};  // more rows, shown on a click
  std::string folded_text = {};                            // what they are
};

struct ComparisonPage {
  std::string eyebrow;  // "Experiment"
  std::string title;
  std::string facts;  // one line
  std::vector<ComparisonSection> sections;
};

/// HTML 5 in one file, like render_page: no network, no script, every text shown as it is.
[[nodiscard]] std::string render_comparison(const ComparisonPage& page);

/// The plot as SVG, in the colours of the page.
[[nodiscard]] std::string plot_svg(const Plot& plot);

}  // namespace drape::report
