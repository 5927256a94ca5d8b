// One pose of a mesh, drawn: its stencil and its rim.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "bit_raster.hpp"
#include "outline_mesh.hpp"
#include "outline_pose.hpp"

namespace drape::alignment {

/// The pixels that things are compared at: a cut-out of the photo, at this or a lower resolution.
struct Window {
  Eigen::Vector2d origin =
      Eigen::Vector2d::Zero();  // its corner, in the photo's pixels about the principal point
  double px_per_photo_px = 1;
  int width = 0;
  int height = 0;

  [[nodiscard]] Eigen::Vector2d from_photo(const Eigen::Vector2d& x) const {
    return (x - origin) * px_per_photo_px;
  }
  [[nodiscard]] Eigen::Vector2d to_photo(const Eigen::Vector2d& x) const {
    return x / px_per_photo_px + origin;
  }
};

/// A piece of the outline, in the window's pixels.
struct RimSample {
  Eigen::Vector2d at;
  Eigen::Vector2d outward;  // unit
  Eigen::Vector3d turned;   // rotation * x_unit
  double length = 0;        // of the outline that it stands for
  bool straight = false;    // of an edge that is long enough for its direction to be exact
  bool border = false;      // of the mesh, where it is open
};

/// Where the outline of a drawn pose passes between the centres of two pixels, beside each other in a row or
/// one below the other in a column.
struct PixelCrossing {
  Eigen::Vector2d at;       // in the window; one coordinate is a pixel centre's
  Eigen::Vector2d outward;  // unit
  Eigen::Vector3d turned;   // rotation * x_unit
  bool in_row = false;
  int before = 0;  // column (in a row) or row (in a column) of the first of the two pixels
  int line = 0;    // the row or column that both are in
  bool object_first = false;
  bool border = false;  // of the mesh, where it is open
};

/// Buffers are kept from one pose to the next.
class OutlineDrawing {
 public:
  /// `with_rim` false: the stencil alone.
  void draw(const OutlineMesh& mesh, const OutlinePose& pose, const Window& window, bool with_rim = true);

  [[nodiscard]] const BitImage& stencil() const { return stencil_; }
  [[nodiscard]] const std::vector<RimSample>& rim() const { return rim_; }
  /// All of them, of what draw() was called with last; it must have been with the rim.
  [[nodiscard]] std::vector<PixelCrossing> crossings(const OutlineMesh& mesh, const OutlinePose& pose) const;
  /// What an open mesh and the caps over its borders enclose and the mesh does not cover: maybe holes of the
  /// scan. Empty for a closed mesh, whose holes are the object's own.
  [[nodiscard]] const BitImage& gaps() const { return gaps_; }

 private:
  /// An edge where the body turns away or ends.
  struct OutlinePart {
    const OutlineEdge* edge = nullptr;
    int winding = 0;
  };
  void find_sides(const OutlineMesh& mesh);
  void find_gaps(const OutlineMesh& mesh, const OutlinePose& pose, const Window& window);
  void find_outline(const OutlineMesh& mesh);
  void sample_edge(const OutlineMesh& mesh, const OutlineEdge& edge, const OutlinePose& pose,
                   const Window& window);
  /// Across an edge in the window, on either side; of a short one across the smooth body that it stands for.
  [[nodiscard]] Eigen::Vector2d normal_of(const OutlineMesh& mesh, const OutlineEdge& edge) const;

  std::vector<Eigen::Vector3d> turned_;
  std::vector<Eigen::Vector2d> places_;
  std::vector<std::uint8_t> front_;  // per face, whether it is seen from its front
  std::vector<OutlinePart> outline_;
  WindingFill fill_;
  BitImage stencil_;
  BitImage gaps_;
  BitImage capped_;
  std::vector<RimSample> rim_;
};

}  // namespace drape::alignment
