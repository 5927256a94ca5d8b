#include "thesis_tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "drape/base/error.hpp"
#include "drape/metrics/distribution.hpp"
#include "drape/rendering/renderer.hpp"
#include "program_arguments.hpp"
#include "trials.hpp"

namespace drape::lab {
namespace {

using alignment::Alignment;

struct Published {
  double pass1_s;
  std::optional<double> refined_s;  // of the last cell the thesis gives none
  double overlap_percent;
};

/// The thesis's models (its tables 5.1 to 5.3) and those that stand for them here.
struct ThesisModel {
  const char* name;
  const char* here;
  int points;
  Published at_45;
  Published at_20;
};

const std::vector<ThesisModel>& thesis_models() {
  static const std::vector<ThesisModel> models = {
      {"Teapot", "teapot", 620, {13.95, 16.13, 95.342}, {132.27, 137.71, 96.103}},
      {"Face", "head", 689, {16.26, 17.92, 98.287}, {180.34, 182.25, 98.331}},
      {"Machine Part", "machine_part", 163, {16.11, 19.13, 96.311}, {187.51, 191.34, 96.413}},
      {"Cessna", "cessna.obj", 6795, {48.01, 8388.56, 86.924}, {584.13, 56520.14, 85.442}},
      {"Will Rogers", "Laurana50k.ply", 46438, {262.87, 58320.43, 81.371}, {3210.14, std::nullopt, 80.327}}};
  return models;
}

struct Timed {
  std::optional<Alignment> found;  // nothing: given up
  double cpu_s = 0;
  double pass1_cpu_s = 0;
  bool pass1_done = false;
};

Timed align_within(const TriangleMesh& mesh, const Image8& stencil, const alignment::AlignOptions& options,
                   double limit_s) {
  Timed timed;
  const double before = test::cpu_seconds();
  std::atomic<bool> stop = false;
  bool first_pass = true;
  const Progress::Report watch = [&](double, std::string_view what) {
    const double now = test::cpu_seconds() - before;
    if (first_pass) timed.pass1_cpu_s = now;  // up to what follows it
    first_pass = first_pass && what != "refining candidates";
    timed.pass1_done = !first_pass;
    if (now > limit_s) stop = true;
  };
  try {
    timed.found = alignment::align_photo(mesh, {stencil, std::nullopt}, options, 1, {watch, &stop});
  } catch (const Interrupted&) {
    // What it had by then is not told.
  }
  timed.cpu_s = test::cpu_seconds() - before;
  timed.pass1_done |= timed.found.has_value();
  return timed;
}

struct Outcome {
  std::vector<double> pass1, total, overlap, error, ours, our_overlap, our_error, ratio;
  int given_up = 0;
};

// What was given up counts as endless: beyond all that ended.
constexpr double endless = std::numeric_limits<double>::infinity();

std::string median_within(std::vector<double> values, double limit_s) {
  std::sort(values.begin(), values.end());
  const double middle = values.empty() ? endless : values[values.size() / 2];
  return middle == endless ? fmt::format(">{:.0f}", limit_s) : fmt::format("{:.2f}", middle);
}

Outcome measure(const Model& model, const ThesisRun& run) {
  Outcome outcome;
  alignment::AlignOptions thesis;
  thesis.method = alignment::Method::exhaustive;
  thesis.exhaustive.first_pass_step_deg = run.first_pass_step_deg;
  thesis.exhaustive.max_candidates_percent = run.max_candidates_percent;
  const Cell cell = cells_named({"20-60"}).front();
  rendering::Renderer renderer(model.object);
  for (int i = 0; i < run.stencils; ++i) {
    const Shot shot = take_shot(model, cell, 1, i);
    const Timed theirs = align_within(model.scanned, shot.stencil, thesis, run.limit_s);
    const Timed ours = align_within(model.scanned, shot.stencil, {}, run.limit_s);
    const auto error = [&](const Alignment& found) {
      return error_modulo_symmetry(found.camera, shot.truth, model).rotation_about_ray_deg;
    };
    outcome.pass1.push_back(theirs.pass1_done ? theirs.pass1_cpu_s : endless);
    outcome.total.push_back(theirs.found ? theirs.cpu_s : endless);
    if (theirs.found) {
      outcome.overlap.push_back(theirs.found->overlap_percent);
      outcome.error.push_back(error(*theirs.found));
    } else {
      ++outcome.given_up;
    }
    if (!ours.found) continue;
    outcome.ours.push_back(ours.cpu_s);
    outcome.our_overlap.push_back(ours.found->overlap_percent);
    outcome.our_error.push_back(error(*ours.found));
    // Of those given up at least this.
    outcome.ratio.push_back(theirs.cpu_s / ours.cpu_s);
  }
  return outcome;
}

double median(const std::vector<double>& values) {
  return metrics::distribution(values).median;
}

std::string or_dash(const std::vector<double>& values) {
  return values.empty() ? "-" : fmt::format("{:.2f}", median(values));
}

}  // namespace

void print_model_sizes() {
  fmt::print("Table 5.1: points of the thesis's models, and of those here\n");
  for (const ThesisModel& row : thesis_models())
    if (const auto model = load_model(row.here))
      fmt::print("  {:12} {:6}   {:15} {:6} ({} triangles)\n", row.name, row.points, row.here,
                 model->scanned.vertices.size(), model->scanned.faces.size());
}

nlohmann::json print_thesis_table(const ThesisRun& run) {
  const bool fine = run.first_pass_step_deg < 30;
  fmt::print(
      "Table {}: first pass of {:.0f} degrees, {} stencils a model, {:.0f} % of the list, {:.0f} CPU s at "
      "most\n",
      fine ? "5.3" : "5.2", run.first_pass_step_deg, run.stencils, run.max_candidates_percent, run.limit_s);
  fmt::print("{:12} | {:^29} | {:^35} | {:^23} |\n", "", "published", "exhaustive, here", "silhouette, here");
  fmt::print("{:12} | {:>8} {:>9} {:>10} | {:>8} {:>8} {:>9} {:>7} | {:>7} {:>8} {:>6} | {:>7}\n", "model",
             "pass 1 s", "refined s", "overlap %", "pass 1 s", "total s", "overlap %", "deg", "total s",
             "overlap", "deg", "ratio");
  nlohmann::json json;
  std::vector<double> ratios;
  int less_overlap = 0;
  int given_up = 0;
  for (const ThesisModel& row : thesis_models()) {
    const std::optional<Model> model = load_model(row.here);
    if (!model) continue;
    const Outcome o = measure(*model, run);
    const Published& published = fine ? row.at_20 : row.at_45;
    fmt::print(
        "{:12} | {:8.2f} {:>9} {:10.2f} | {:>8} {:>8} {:>9} {:>7} | {:7.3f} {:8.2f} {:6.2f} | {:>7}\n",
        row.name, published.pass1_s, published.refined_s ? fmt::format("{:.2f}", *published.refined_s) : "-",
        published.overlap_percent, median_within(o.pass1, run.limit_s), median_within(o.total, run.limit_s),
        or_dash(o.overlap), or_dash(o.error), median(o.ours), median(o.our_overlap), median(o.our_error),
        fmt::format("{}{:.0f}x", o.given_up > 0 ? ">" : "", median(o.ratio)));
    std::fflush(stdout);
    ratios.insert(ratios.end(), o.ratio.begin(), o.ratio.end());
    given_up += o.given_up;
    less_overlap += !o.overlap.empty() && median(o.overlap) > median(o.our_overlap);
    json.push_back({{"model", row.name},
                    {"mesh", row.here},
                    {"exhaustive",
                     {{"pass1_s", o.pass1},
                      {"total_s", o.total},
                      {"overlap_percent", o.overlap},
                      {"error_deg", o.error},
                      {"given_up", o.given_up}}},
                    {"silhouette",
                     {{"total_s", o.ours}, {"overlap_percent", o.our_overlap}, {"error_deg", o.our_error}}},
                    {"ratio", o.ratio}});
  }
  fmt::print(
      "silhouette is {:.0f} times as fast in the median ({} of {} stencils were given up and count as if "
      "they "
      "had ended then); less overlap than exhaustive on {} of the models where that ended\n\n",
      median(ratios), given_up, ratios.size(), less_overlap);
  return json;
}

}  // namespace drape::lab
