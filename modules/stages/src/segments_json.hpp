// segments.json: what the segments of a photo are, and how to pick them.
#pragma once

#include <filesystem>

#include "drape/segmentation/segment_photo.hpp"

namespace drape::stages {

/// {"width", "height", "confidence", "how", "segments": [{"label", "area_percent", "box_px", "inside_px",
/// "mean_color", "chosen", "yaml"}]}
void write_segments(const std::filesystem::path& file, const segmentation::Segmentation& segmentation);

/// The confidence that such a file holds. Error{input} for another file.
[[nodiscard]] double read_confidence(const std::filesystem::path& file);

}  // namespace drape::stages
