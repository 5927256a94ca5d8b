// Fitness of outlines: the two improvements that the thesis proposes in section 6.2.1.
//
// Both find a mean distance d between the outlines, in pixels. So that the thresholds of the search keep
// their meaning, it becomes the overlap of two shapes that differ by d all round: where an outline of length
// L round an area A is off by d, the pixels that only one shape holds are L d, and
//   fitness = 100 (1 - L d / A), at least 0.
#pragma once

#include <cstdint>
#include <vector>

#include "fitness.hpp"

namespace drape::alignment {

/// The outer outlines as lists of points: from a common point on, the points of both are compared pair by
/// pair. The common point is the first of the image's outline and the model's nearest to it; both outlines
/// are divided into the same number of equal steps. Pairs whose image point borders what is unknown are left
/// out.
class ListFitness : public FitnessMeasure {
 public:
  explicit ListFitness(const ImageStencil& image);
  double operator()(const Image8& model) const override;

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<std::uint8_t> counts_;
  double loss_per_px_ = 0;  // L / A
};

/// Rays from the centre of the object in the photo: on each, the distance between the places where it leaves
/// the two stencils for good. Rays that leave the image's object into what is unknown are left out.
class RayFitness : public FitnessMeasure {
 public:
  explicit RayFitness(const ImageStencil& image);
  double operator()(const Image8& model) const override;

 private:
  struct Ray {
    std::vector<std::uint32_t> pixels;  // from the image's border towards the centre, one per step
    double image_radius = 0;            // px
    bool counts = true;
  };
  [[nodiscard]] static double radius_on(const Ray& ray, const Image8& stencil);

  std::vector<Ray> rays_;
  double loss_per_px_ = 0;
};

}  // namespace drape::alignment
