// What verdicts rest on, for choosing their limits: a line for every pose, written as it comes.
#pragma once

#include <fstream>
#include <optional>
#include <string>

#include "drape/alignment/align.hpp"

namespace drape::lab {

/// Comma-separated, with a heading. Without a file it takes nothing down.
class FeatureTable {
 public:
  explicit FeatureTable(const std::string& file);

  /// `truth` is right, wrong or absent; `error_deg` is about the viewing ray, 180 where the object is absent.
  void add(const std::string& cell, const std::string& model, int index, const std::string& truth,
           double error_deg, alignment::Verdict verdict,
           const std::optional<alignment::OutlineFigures>& outline, double sigma_deg);

 private:
  std::ofstream stream_;
};

}  // namespace drape::lab
