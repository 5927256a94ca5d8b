// The rows of the stage table, one function per src/<name>_stage.cpp.
#pragma once

#include "drape/pipeline/stage.hpp"

namespace drape::stages {

[[nodiscard]] pipeline::Stage ingest_stage();
[[nodiscard]] pipeline::Stage register_stage();
[[nodiscard]] pipeline::Stage mesh_stage();
[[nodiscard]] pipeline::Stage fill_stage();
[[nodiscard]] pipeline::Stage segment_stage();
[[nodiscard]] pipeline::Stage align_stage();
[[nodiscard]] pipeline::Stage texture_stage();
[[nodiscard]] pipeline::Stage export_stage();

/// "000", "001", ...: how scans and photos are numbered in file names.
[[nodiscard]] std::string three_digits(std::size_t number);

}  // namespace drape::stages
