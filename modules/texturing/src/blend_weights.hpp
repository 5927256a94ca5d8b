// How photos go over into each other where one hands over to the next.
#pragma once

#include <span>
#include <vector>

#include "painted_faces.hpp"

namespace drape::texturing {

struct ViewWeight {
  int view;
  float weight;
};

/// The photos that mix at one vertex, ordered by view; their weights add up to 1. Empty: the photos of the
/// faces round it have none in common that sees all of them, and each face keeps its own (a torn vertex).
using VertexBlend = std::vector<ViewWeight>;

/// A photo has a weight at a vertex only if it sees every painted face round it well, so that weights linear
/// over the faces make colours that are continuous across all edges without torn vertices. The change-over is
/// about blend_px of the photos wide on each side of a seam.
[[nodiscard]] std::vector<VertexBlend> blend_weights(const PaintedFaces& surface, std::span<const int> chosen,
                                                     double blend_px);

}  // namespace drape::texturing
