// One photo's segments and stencil as files.
#pragma once

#include <cstdint>
#include <filesystem>

#include "drape/base/progress.hpp"
#include "drape/pipeline/input.hpp"
#include "drape/segmentation/segment_photo.hpp"

namespace drape::stages {

/// Reads the photo and what is given with it, finds the object, and writes segments.png, segments.json and
/// stencil.png into `folder`, which must be there. Errors as those of io::read_photo and segment_photo,
/// naming the photo.
segmentation::Segmentation write_segment_files(const pipeline::PhotoInput& input,
                                               const segmentation::SegmentOptions& options,
                                               std::uint64_t seed, const std::filesystem::path& folder,
                                               const Progress& progress);

}  // namespace drape::stages
