#include "verdict_measure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "drape/base/random.hpp"
#include "drape/io/photo.hpp"
#include "real_photos.hpp"

namespace drape::lab {
namespace {

using alignment::Verdict;

constexpr std::size_t dino_photos = 6;
constexpr std::size_t told_every = 25;  // negatives: what is stopped has told its figures so far

struct Negative {
  std::string name;
  std::string shows;  // the model that it shows
  Image8 stencil;
  Image8 photo;
};

std::vector<Negative> real_negatives() {
  std::vector<Negative> negatives;
  for (MaskedPhoto& photo : masked_photos())
    negatives.push_back({photo.name, photo.name, std::move(photo.stencil), std::move(photo.rgb)});
  const std::vector<PosedPhoto> dino = posed_photos("dino");
  for (std::size_t i = 0; i < std::min(dino_photos, dino.size()); ++i) {
    // Evenly spread over the photos.
    const PosedPhoto& photo = dino[i * dino.size() / dino_photos];
    Image8 rgb = io::read_photo(photo.image).rgb;
    Image8 stencil = dino_stencil(rgb);
    negatives.push_back({photo.name, "dino", std::move(stencil), std::move(rgb)});
  }
  return negatives;
}

std::vector<Negative> simulated_negatives(const std::vector<Model>& models, int per_model,
                                          std::uint64_t seed) {
  std::vector<Negative> negatives;
  const Cell cell = cells_named({"20-60_photo"}).front();
  for (const Model& model : models)
    for (int i = 0; i < per_model; ++i) {
      Shot shot = take_shot(model, cell, item_seed(seed, 17), i);
      negatives.push_back(
          {fmt::format("{} {}", model.name, i), model.name, std::move(shot.stencil), std::move(*shot.photo)});
    }
  return negatives;
}

int& cell_of(std::vector<std::vector<int>>& table, const Judged& one) {
  return table[static_cast<std::size_t>(one.truth)][static_cast<std::size_t>(one.verdict)];
}

std::vector<std::vector<int>> confusion(const std::vector<Judged>& all) {
  std::vector<std::vector<int>> table(3, std::vector<int>(3, 0));
  for (const Judged& one : all) ++cell_of(table, one);
  return table;
}

struct Risk {
  double coverage;
  double risk;
};

// The surest first: accept before review before reject, then by margin.
std::vector<Risk> risk_against_coverage(std::vector<Judged> all) {
  std::stable_sort(all.begin(), all.end(), [](const Judged& a, const Judged& b) {
    return a.verdict != b.verdict ? a.verdict < b.verdict : a.confidence > b.confidence;
  });
  std::vector<Risk> curve;
  std::size_t wrong = 0;
  std::size_t tenth = 1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    wrong += all[i].truth != Judged::Truth::right;
    if ((i + 1) * 10 < tenth * all.size()) continue;
    curve.push_back({static_cast<double>(i + 1) / static_cast<double>(all.size()),
                     static_cast<double>(wrong) / static_cast<double>(i + 1)});
    ++tenth;
  }
  return curve;
}

constexpr const char* truth_names[] = {"right", "wrong", "absent"};

}  // namespace

std::vector<Judged> judged(std::span<const Row> rows) {
  std::vector<Judged> all;
  for (const Row& row : rows)
    for (const Trial& trial : row.trials)
      all.push_back(
          {trial.right ? Judged::Truth::right : Judged::Truth::wrong, trial.verdict, trial.confidence});
  return all;
}

std::vector<Judged> measure_negatives(const std::vector<Model>& models, int per_pair, std::uint64_t seed,
                                      const alignment::AlignOptions& options, FeatureTable& features) {
  std::vector<Negative> negatives = simulated_negatives(models, per_pair, seed);
  for (Negative& negative : real_negatives()) negatives.push_back(std::move(negative));
  std::vector<Judged> all;
  int accepted = 0;
  for (const Model& model : models)
    for (const Negative& negative : negatives) {
      if (negative.shows == model.name) continue;
      alignment::PhotoEvidence evidence{negative.stencil, std::nullopt, &negative.photo};
      const alignment::Alignment found = alignment::align_photo(model.scanned, evidence, options, 1, {});
      all.push_back({Judged::Truth::absent, found.verdict, margin(found)});
      features.add("negatives", model.name + " in " + negative.name, 0, "absent", 180, found.verdict,
                   found.outline, found.sigma ? found.sigma->rotation_deg : 0);
      if (all.size() % told_every == 0) {
        fmt::print("  negatives so far: {} of {} accepted\n", accepted, all.size());
        std::fflush(stdout);
      }
      if (found.verdict != Verdict::accept) continue;
      ++accepted;
      fmt::print("  accepted: {} in the photo {}: {}\n", model.name, negative.name,
                 found.reasons.empty() ? "" : found.reasons.front());
      std::fflush(stdout);
    }
  const int n = static_cast<int>(all.size());
  fmt::print("negatives: {} of {} accepted; with 95 % confidence under {:.2f} %\n", accepted, n,
             100 * upper_bound_95(accepted, n));
  std::fflush(stdout);
  return all;
}

void print_verdicts(const std::vector<Judged>& all) {
  const auto table = confusion(all);
  fmt::print("{:8} {:>7} {:>7} {:>7}\n", "", "accept", "review", "reject");
  for (std::size_t i = 0; i < 3; ++i)
    fmt::print("{:8} {:7} {:7} {:7}\n", truth_names[i], table[i][0], table[i][1], table[i][2]);
  fmt::print("coverage %");
  const auto curve = risk_against_coverage(all);
  for (const Risk& point : curve) fmt::print(" {:6.0f}", 100 * point.coverage);
  fmt::print("\nrisk %    ");
  for (const Risk& point : curve) fmt::print(" {:6.2f}", 100 * point.risk);
  fmt::print("\n");
}

nlohmann::json verdicts_json(const std::vector<Judged>& all) {
  const auto table = confusion(all);
  nlohmann::json json;
  for (std::size_t i = 0; i < 3; ++i)
    json["confusion"][truth_names[i]] = {
        {"accept", table[i][0]}, {"review", table[i][1]}, {"reject", table[i][2]}};
  for (const Risk& point : risk_against_coverage(all))
    json["risk_against_coverage"].push_back({{"coverage", point.coverage}, {"risk", point.risk}});
  return json;
}

}  // namespace drape::lab
