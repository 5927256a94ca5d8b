#include "summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "drape/metrics/distribution.hpp"

namespace drape::lab {
namespace {

using alignment::Verdict;

// The binomial distribution: the chance of at most `count` of `n`.
double chance_of_at_most(int count, int n, double share) {
  double sum = 0;
  for (int k = 0; k <= count; ++k)
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                    k * std::log(share) + (n - k) * std::log1p(-share));
  return sum;
}

struct Counted {
  int n = 0;
  int of = 0;
  [[nodiscard]] std::string percent() const { return of == 0 ? "-" : fmt::format("{:.1f}", 100.0 * n / of); }
  [[nodiscard]] nlohmann::json json() const { return {{"count", n}, {"of", of}}; }
};

struct Figures {
  std::size_t n = 0;
  metrics::Distribution overlap, rotation, about_ray, focal, cpu;
  double worst_overlap = 0;
  Counted right, right_absolute, flagged, accepted, listed;
};

Figures figures_of(const Row& row) {
  Figures figures;
  std::vector<double> overlap, rotation, about_ray, focal, cpu;
  figures.n = row.trials.size();
  for (const Trial& trial : row.trials) {
    overlap.push_back(trial.overlap_percent);
    rotation.push_back(trial.rotation_deg);
    about_ray.push_back(trial.about_ray_deg);
    if (trial.focal_percent) focal.push_back(std::abs(*trial.focal_percent));
    cpu.push_back(trial.cpu_seconds);
    figures.right.n += trial.right;
    figures.right_absolute.n += trial.rotation_deg < right_deg;
    (trial.right ? figures.accepted : figures.flagged).of += 1;
    if (trial.right) figures.accepted.n += trial.known_as_right();
    if (!trial.right) figures.flagged.n += trial.verdict != Verdict::accept;
    if (!trial.right && trial.best_candidate_deg) figures.listed.n += *trial.best_candidate_deg < right_deg;
  }
  figures.right.of = figures.right_absolute.of = static_cast<int>(figures.n);
  figures.listed.of = figures.flagged.of;
  figures.worst_overlap = overlap.empty() ? 0 : *std::min_element(overlap.begin(), overlap.end());
  figures.overlap = metrics::distribution(overlap);
  figures.rotation = metrics::distribution(rotation);
  figures.about_ray = metrics::distribution(about_ray);
  figures.focal = metrics::distribution(focal);
  figures.cpu = metrics::distribution(cpu);
  return figures;
}

nlohmann::json json_of(const metrics::Distribution& distribution) {
  return {{"median", distribution.median}, {"p95", distribution.percentile_95}, {"worst", distribution.max}};
}

}  // namespace

double upper_bound_95(int count, int n) {
  if (count >= n) return 1;
  double least = static_cast<double>(count) / n;
  double most = 1;
  while (most - least > 1e-6) {
    const double share = (least + most) / 2;
    (chance_of_at_most(count, n, share) > 0.05 ? least : most) = share;
  }
  return most;
}

void print_header() {
  fmt::print(
      "{:15} {:15} {:>4} | {:>7} {:>7} | {:^21} | {:^21} | {:>6} | {:>6} {:>6} | {:>6} {:>6} {:>6} | {:>6}\n",
      "", "", "", "overlap", "%", "rotation, degrees", "about the ray", "focal", "under", "2 deg", "misses",
      "misses", "right", "CPU");
  fmt::print(
      "{:15} {:15} {:>4} | {:>7} {:>7} | {:>6} {:>6} {:>7} | {:>6} {:>6} {:>7} | {:>6} | {:>6} {:>6} | {:>6} "
      "{:>6} {:>6} | {:>6}\n",
      "cell", "model", "n", "median", "worst", "median", "p95", "worst", "median", "p95", "worst", "% med",
      "ray %", "abs %", "flag %", "list %", "acc %", "s med");
}

void print_row(const Row& row) {
  const Figures f = figures_of(row);
  fmt::print(
      "{:15} {:15} {:4} | {:7.2f} {:7.2f} | {:6.3f} {:6.2f} {:7.2f} | {:6.3f} {:6.2f} {:7.2f} | {:6.2f} | "
      "{:>6} {:>6} | "
      "{:>6} {:>6} {:>6} | {:6.3f}\n",
      row.cell, row.model, f.n, f.overlap.median, f.worst_overlap, f.rotation.median,
      f.rotation.percentile_95, f.rotation.max, f.about_ray.median, f.about_ray.percentile_95,
      f.about_ray.max, f.focal.median, f.right.percent(), f.right_absolute.percent(), f.flagged.percent(),
      f.listed.percent(), f.accepted.percent(), f.cpu.median);
  std::fflush(stdout);
}

void print_failures(const Row& row) {
  for (const Trial& trial : row.trials) {
    if (trial.right) continue;
    std::string reasons;
    for (const std::string& reason : trial.reasons) reasons += (reasons.empty() ? "" : "; ") + reason;
    fmt::print("  miss: {} {} photo {}: {:.2f} deg ({:.2f} about the ray), overlap {:.2f}, {} ({})\n",
               row.cell, row.model, trial.index, trial.rotation_deg, trial.about_ray_deg,
               trial.overlap_percent, verdict_name(trial.verdict), reasons);
  }
}

nlohmann::json to_json(const Row& row) {
  const Figures f = figures_of(row);
  nlohmann::json json = {{"cell", row.cell},
                         {"model", row.model},
                         {"n", f.n},
                         {"overlap_percent", {{"median", f.overlap.median}, {"worst", f.worst_overlap}}},
                         {"rotation_deg", json_of(f.rotation)},
                         {"rotation_about_ray_deg", json_of(f.about_ray)},
                         {"focal_error_percent", json_of(f.focal)},
                         {"right", f.right.json()},
                         {"right_absolute", f.right_absolute.json()},
                         {"failures_flagged", f.flagged.json()},
                         {"failures_listed_among_candidates", f.listed.json()},
                         {"right_accepted", f.accepted.json()},
                         {"cpu_seconds", json_of(f.cpu)}};
  json["failures"] = nlohmann::json::array();
  for (const Trial& trial : row.trials)
    if (!trial.right && !row.pooled)
      json["failures"].push_back({{"photo", trial.index},
                                  {"rotation_about_ray_deg", trial.about_ray_deg},
                                  {"verdict", verdict_name(trial.verdict)},
                                  {"reasons", trial.reasons}});
  return json;
}

}  // namespace drape::lab
