// The conditions that alignment is measured under.
#pragma once

#include <string>
#include <vector>

#include "views.hpp"

namespace drape::lab {

enum class Fault { none, boundary_noise, missing, extra, pin_holes };

struct Cell {
  std::string name;
  Lens lens;
  bool focal_hint = false;  // the focal length as a photo's file has it: true to 3 % (one sigma)
  bool photo = false;       // the aligner sees a photo too
  bool painted = false;     // of the object in its colours
  Fault fault = Fault::none;
  double amount = 0;      // of the fault: pixels or a share
  double off_center = 0;  // of the principal point, as a share of the photo's width
};

/// In the order of the table. The first is the clean one, of which more poses are taken.
[[nodiscard]] const std::vector<Cell>& all_cells();

/// Those named, or all; a name that ends in * stands for all that begin so. Error{config} for a name that
/// fits none.
[[nodiscard]] std::vector<Cell> cells_named(const std::vector<std::string>& names);

}  // namespace drape::lab
