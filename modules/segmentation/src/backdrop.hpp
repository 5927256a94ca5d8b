// Objects before a backdrop that is smooth, or that was photographed without them.
#pragma once

#include "lab_image.hpp"

namespace drape::segmentation {

struct Backdrop {
  ImageF difference;        // per pixel: how far from the backdrop, 1 where object and backdrop part
  Image8 darker;            // 1 where the photo is darker than the backdrop, of its tint; else 0
  double border_share = 0;  // of the picture's border that is backdrop, 0..1
  float limit = 0;          // Lab units, of the roughest sheet: what an object differs from it by
  std::size_t sheets = 1;   // smooth parts that it consists of
};

/// A sheet of paper, a cloth or a black room, evenly lit or falling off: the colours of the picture's border
/// are fitted by a quadratic of the position, then those of all that hangs together with it. Where that
/// leaves part of the border open, up to three such sheets (a wall, a floor, a table), each grown from the
/// commonest colour of what is open; where two meet, mixtures of both are backdrop. Robust: an object or a
/// clamp may reach over the border. A border of many colours mostly gives a small
/// border_share.
[[nodiscard]] Backdrop smooth_backdrop(const ImageF& lab);

/// The same scene without the object, of the same size, by the same camera; its exposure may differ.
[[nodiscard]] Backdrop photographed_backdrop(const ImageF& lab, const ImageF& empty_scene);

}  // namespace drape::segmentation
