// How well a model stencil fits the image stencil, 0 to 100.
#pragma once

#include <memory>

#include "drape/alignment/exhaustive_options.hpp"
#include "image_stencil.hpp"

namespace drape::alignment {

class FitnessMeasure {
 public:
  virtual ~FitnessMeasure() = default;
  /// `model` has the image stencil's size. May be called from several threads.
  [[nodiscard]] virtual double operator()(const Image8& model) const = 0;
};

/// `image` must outlive the measure.
[[nodiscard]] std::unique_ptr<FitnessMeasure> make_fitness(const ImageStencil& image,
                                                           const ExhaustiveOptions& options);

}  // namespace drape::alignment
