// Several pictures in one.
#pragma once

#include <Eigen/Core>
#include <span>

#include "drape/geometry/image.hpp"

namespace drape::report {

/// The picture reduced by the area filter, in linear light, until it fits into the box with its proportions
/// kept; as it is if it fits already. Straight alpha is weighted in. Error{input} for a box without pixels.
[[nodiscard]] Image8 fitted(const Image8& picture, int max_width, int max_height);

struct ContactSheetStyle {
  int columns = 0;  // 0: as many as make the sheet about one and a half times as wide as high
  int cell_width_px = 480;
  int cell_height_px = 480;
  int gap_px = 8;                                                        // between cells and round the sheet
  Eigen::Vector3f background = Eigen::Vector3f(0.925F, 0.933F, 0.945F);  // sRGB, 0..1
};

/// RGB: every picture (1, 3 or 4 channels) fitted into its cell and centred there, row by row. Empty pictures
/// leave their cell empty. Empty without pictures. Error{input} for a cell without pixels.
[[nodiscard]] Image8 contact_sheet(std::span<const Image8> pictures, const ContactSheetStyle& style = {});

}  // namespace drape::report
