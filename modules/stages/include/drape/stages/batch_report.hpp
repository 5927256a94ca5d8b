// The page of a batch.
#pragma once

#include <filesystem>

#include "drape/pipeline/batch.hpp"

namespace drape::stages {

/// report.html in the batch's folder: what became of each object, failures and reviews first, with links to
/// the objects' own pages and small overlays of those that want review. Returns its path.
std::filesystem::path write_batch_report(const pipeline::Batch& batch, const pipeline::BatchSummary& summary);

}  // namespace drape::stages
