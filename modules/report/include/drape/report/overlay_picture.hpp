// A photo with the outlines of what was found in it.
#pragma once

#include <string_view>

#include "drape/geometry/image.hpp"

namespace drape::report {

/// The photo, dimmed outside the object, with the outline of the image stencil in orange and that of the
/// model stencil in blue (both told apart with any colour vision; Okabe and Ito 2008), and what only one of
/// them covers tinted in its colour. Lines are smooth and as thick as suits the size of the photo. Pixels
/// that the image stencil does not know are never tinted. Either stencil may be empty (Image8()): then only
/// the other is drawn. RGB of the photo's size. Error{input} if the photo has not 3 channels, or a stencil
/// has not its size and 1 channel.
[[nodiscard]] Image8 overlay_picture(const Image8& photo, const Image8& image_stencil,
                                     const Image8& model_stencil);

/// What the colours of overlay_picture mean, as a caption.
inline constexpr std::string_view overlay_caption =
    "Orange: outline found in the photo. Blue: outline of the model. Tinted: what only one of them covers.";

}  // namespace drape::report
