#include "feature_table.hpp"

#include <fmt/core.h>

#include "drape/base/error.hpp"
#include "trials.hpp"

namespace drape::lab {

FeatureTable::FeatureTable(const std::string& file) {
  if (file.empty()) return;
  stream_.open(file);
  if (!stream_) throw input_error("{} cannot be written", file);
  stream_ << "cell,model,index,truth,error_deg,verdict,object_px,noise_px,correlation_px,fits,largest_gap,"
             "margin,rotation_deg,by_photo,sigma_deg,explained,independent,inner_side\n";
}

void FeatureTable::add(const std::string& cell, const std::string& model, int index, const std::string& truth,
                       double error_deg, alignment::Verdict verdict,
                       const std::optional<alignment::OutlineFigures>& outline, double sigma_deg) {
  if (!stream_.is_open() || !outline) return;
  stream_ << fmt::format("{},{},{},{},{:.3f},{},", cell, model, index, truth, error_deg,
                         verdict_name(verdict))
          << fmt::format("{:.0f},{:.3f},{:.2f},{:.4f},{:.4f},{:.4f},{:.3f},", outline->object_px,
                         outline->noise_px, outline->correlation_px, outline->fits, outline->largest_gap,
                         outline->margin, outline->rotation_deg)
          << fmt::format("{},{:.3f},{:.3f},{:.0f},{:.3f}\n", outline->by_photo ? 1 : 0, sigma_deg,
                         outline->explained, outline->independent, outline->inner_side)
          << std::flush;
}

}  // namespace drape::lab
