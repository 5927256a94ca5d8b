// Whether the verdict knows: right poses against wrong ones, and objects that are not in the photo.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "feature_table.hpp"
#include "models.hpp"
#include "summary.hpp"

namespace drape::lab {

/// What the verdict was on one pose, whatever it was tested on.
struct Judged {
  enum class Truth { right, wrong, absent };  // absent: the photo shows another object
  Truth truth;
  alignment::Verdict verdict;
  double confidence;
};
[[nodiscard]] std::vector<Judged> judged(std::span<const Row> rows);

/// Every model with outlines of the others: `per_pair` photos (lit, 20 to 60 degrees) of each other model,
/// and the real outlines of DRAPE_TEST_DATA's segmentation/ and photos/dino. Prints what was accepted.
[[nodiscard]] std::vector<Judged> measure_negatives(const std::vector<Model>& models, int per_pair,
                                                    std::uint64_t seed,
                                                    const alignment::AlignOptions& options,
                                                    FeatureTable& features);

/// Right, wrong and absent by accept, review and reject; and the risk (share of wrong and absent among those
/// that are taken) against the coverage (share that is taken), the surest first.
void print_verdicts(const std::vector<Judged>& all);
[[nodiscard]] nlohmann::json verdicts_json(const std::vector<Judged>& all);

}  // namespace drape::lab
