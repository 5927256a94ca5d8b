// Which photos can paint which faces, with the faces split where that changes.
#pragma once

#include <span>
#include <vector>

#include "drape/base/progress.hpp"
#include "edge_splits.hpp"
#include "photo_sight.hpp"
#include "surface_normals.hpp"

namespace drape::texturing {

/// A photo that sees all of a face.
struct Candidate {
  int view;
  double quality;     // higher is better: pixels per area, less if seen obliquely or with grown colours
  double full_share;  // of the face: on fully trusted pixels
  Eigen::Vector3f log_color = Eigen::Vector3f::Zero();  // of light, where it was looked up
};

struct PaintedFaces {
  TriangleMesh mesh;
  std::vector<std::uint32_t> candidate_sets;       // per face: index into candidates
  std::vector<std::vector<Candidate>> candidates;  // set 0 is empty
};

/// Cuts edges (see split_edges); parts of a face keep its candidates, and the photo `chosen` for it.
void cut_edges(PaintedFaces& surface, std::vector<int>& chosen, std::span<const EdgeSplit> splits);

/// Splits the faces of `mesh` until each is either seen whole by some photo or not at all, down to edges of
/// split_px in the photo: what is then still seen partly counts as unseen. Edges are cut where sight ends.
[[nodiscard]] PaintedFaces split_at_sight(const TriangleMesh& mesh, std::span<const PhotoSight> sights,
                                          double split_px, const Progress& progress);

}  // namespace drape::texturing
