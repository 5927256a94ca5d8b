#include "cells.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "drape/base/error.hpp"

namespace drape::lab {
namespace {

// A condition as it is, with the photo, and with a hint of the focal length.
void add(std::vector<Cell>& cells, const Cell& plain, bool with_hint = false) {
  cells.push_back(plain);
  Cell photo = plain;
  photo.name += "_photo";
  photo.photo = true;
  cells.push_back(photo);
  if (!with_hint) return;
  Cell hint = plain;
  hint.name += "_focal";
  hint.focal_hint = true;
  cells.push_back(hint);
}

std::vector<Cell> make_cells() {
  const Lens normal{Camera::Projection::perspective, 20, 60};
  const Lens longer{Camera::Projection::perspective, 10, 20};
  const Lens longest{Camera::Projection::perspective, 4, 10};
  const Lens parallel{Camera::Projection::orthographic, 4, 4};
  std::vector<Cell> cells;
  add(cells, {.name = "20-60", .lens = normal}, true);
  add(cells, {.name = "10-20", .lens = longer}, true);
  add(cells, {.name = "4-10", .lens = longest}, true);
  add(cells, {.name = "orthographic", .lens = parallel});
  for (const int pixels : {1, 2, 3})
    add(cells, {.name = fmt::format("noise_{}px", pixels),
                .lens = normal,
                .fault = Fault::boundary_noise,
                .amount = static_cast<double>(pixels)});
  for (const int percent : {10, 20})
    cells.push_back({.name = fmt::format("missing_{}", percent),
                     .lens = normal,
                     .fault = Fault::missing,
                     .amount = percent / 100.0});
  for (const int percent : {10, 20})
    cells.push_back({.name = fmt::format("extra_{}", percent),
                     .lens = normal,
                     .fault = Fault::extra,
                     .amount = percent / 100.0});
  cells.push_back({.name = "holes_3", .lens = normal, .fault = Fault::pin_holes, .amount = 0.03});
  cells.push_back({.name = "crop_8", .lens = normal, .off_center = 0.08});
  cells.push_back({.name = "4-10_painted", .lens = longest, .photo = true, .painted = true});
  return cells;
}

}  // namespace

const std::vector<Cell>& all_cells() {
  static const std::vector<Cell> cells = make_cells();
  return cells;
}

std::vector<Cell> cells_named(const std::vector<std::string>& names) {
  if (names.empty()) return all_cells();
  std::vector<Cell> chosen;
  for (const std::string& name : names) {
    const std::size_t before = chosen.size();
    for (const Cell& cell : all_cells())
      if (cell.name == name ||
          (name.ends_with("*") && cell.name.starts_with(name.substr(0, name.size() - 1))))
        chosen.push_back(cell);
    if (chosen.size() > before) continue;
    std::string there;
    for (const Cell& cell : all_cells()) there += " " + cell.name;
    throw config_error("there is no cell {}; there are{}", name, there);
  }
  return chosen;
}

}  // namespace drape::lab
