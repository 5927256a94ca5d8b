// Denoised samples averaged with more of their surface.
#pragma once

#include <vector>

#include "range_sheet.hpp"
#include "sample_neighbors.hpp"

namespace drape::meshing {

/// From the median magnitude of a normal variable; 0 of none.
[[nodiscard]] float deviation_of(std::vector<float> magnitudes);

/// The samples, which have slopes, after rounds of averaging over neighbours ever farther off, more rounds
/// for more noise and none for little: 3 x 3 weighted means at strides of the lattice (an edge-avoiding
/// wavelet, Dammertz et al. 2010; without a lattice that many more rounds over the next neighbours instead).
/// What is averaged is the distance from the sample's own tangent plane, under heavy noise blended with that
/// from the neighbour's, so that round shapes do not shrink; and the slopes. A neighbour's weight
/// falls to 0 as its normal differs by more than the normals' noise, as one lies off the other's plane by
/// more than the depths', and as it is far off in space: under heavy noise the nearer the more the surface
/// turns there, and what is flat is averaged two rounds more. At last what the rounds took away is averaged
/// by the same weights and given back ("twicing", Tukey 1977), which restores shape but little noise. `noise`
/// is the deviation that the samples had across the surface, in spacings.
[[nodiscard]] std::vector<RangeSample> averaged_over_surfaces(std::vector<RangeSample> samples,
                                                              const SampleNeighbors& neighbors,
                                                              const Sight& sight, float noise);

}  // namespace drape::meshing
