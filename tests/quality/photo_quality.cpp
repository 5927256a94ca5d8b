// How well objects are found in photos by their mesh, with no stencil given: a photo in, a table out.
//
//   photo_quality [rows=clutter,studio,dino,absent,lmo] [kinds=box,click,unaided] [photos=N] [draws=N]
//                 [pairs=N] [skip=N] [cache=FOLDER] [verbose] [option=value ...]
//
// `draws`: boxes and clicks a photo; `photos`: simulated ones a row; `pairs`: of a mesh and a photo without
// it; options are those of `align:`. With a box or a click the colours alone are the evidence; unaided, the
// photo is segmented and aligned as a run does it with its defaults, but with evidence=colour by its colours.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drape/alignment/align.hpp"
#include "drape/metrics/distribution.hpp"
#include "drape/segmentation/segment_photo.hpp"
#include "photo_cases.hpp"
#include "program_arguments.hpp"

namespace drape {
namespace {

using alignment::Alignment;
using alignment::PhotoEvidence;
using alignment::Verdict;

struct Arguments {
  std::string rows = "clutter,studio,dino,absent,lmo";
  std::string kinds;  // empty: box, click and unaided
  int photos = 14;
  int draws = 4;
  int skip = 0;
  int pairs = 40;
  std::filesystem::path cache;  // of simulated photos, which must be there
  bool verbose = false;
  alignment::AlignOptions options;
};

/// What came of one photo.
struct Outcome {
  double rotation_deg = 0;
  bool pose_right = false;  // the first pose, within the row's limits
  bool wrong = true;        // another pose altogether, for the verdict
  bool right = false;       // and on the photo's edges
  bool among_finalists = false;
  bool free_axis = false;  // for review, as the outline of a body of rotation stays the same about it
  Verdict verdict = Verdict::reject;
  double score = 0;
  double seconds = 0;
};

struct Limits {
  double rotation_deg = 15;
  double size_percent = 12;
  double edge_support = 0.9;
};
// The true cameras of real photos are coarse; those of simulated ones are exact.
constexpr Limits real_limits{15, 12, 0.9};
constexpr Limits simulated_limits{2, 12, 0};

struct Tally {
  std::vector<Outcome> outcomes;
  void print(const std::string& name) const {
    const auto count = [&](auto holds) { return std::count_if(outcomes.begin(), outcomes.end(), holds); };
    std::vector<double> seconds;
    std::vector<double> degrees;
    for (const Outcome& o : outcomes) {
      seconds.push_back(o.seconds);
      degrees.push_back(o.rotation_deg);
    }
    fmt::print(
        "{:28} | {:3} | right {:3} pose {:3} finalist {:3} | accepted {:3} (free about an axis "
        "{:3}) wrongly {:3} rejected {:3} | deg "
        "med "
        "{:6.2f} | CPU s {:5.2f} max {:5.2f}\n",
        name, outcomes.size(), count([](const Outcome& o) { return o.right; }),
        count([](const Outcome& o) { return o.pose_right; }),
        count([](const Outcome& o) { return o.among_finalists; }),
        count([](const Outcome& o) { return o.right && o.verdict == Verdict::accept; }),
        count([](const Outcome& o) { return o.right && o.free_axis; }),
        count([](const Outcome& o) { return o.wrong && o.verdict == Verdict::accept; }),
        count([](const Outcome& o) { return o.verdict == Verdict::reject; }),
        metrics::distribution(degrees).median, metrics::distribution(seconds).median,
        *std::max_element(seconds.begin(), seconds.end()));
    std::fflush(stdout);
  }
};

/// All of the photo, a box, or a click.
struct Hint {
  std::optional<std::array<double, 4>> box;
  std::optional<std::array<double, 2>> click;
};

Alignment align(const TriangleMesh& mesh, const Image8& rgb, const Hint& hint,
                alignment::AlignOptions options) {
  const bool as_a_run = options.evidence == alignment::EvidenceKind::automatic;
  if (as_a_run && !hint.box && !hint.click) {
    const segmentation::Segmentation found = segmentation::segment_photo(rgb, {}, {}, {}, 1);
    PhotoEvidence evidence{found.stencil, std::nullopt, &rgb};
    evidence.stencil_confidence = found.confidence;
    return alignment::align_photo(mesh, evidence, options, 1, {});
  }
  if (as_a_run) options.evidence = alignment::EvidenceKind::colour;
  const Image8 nothing(rgb.width(), rgb.height(), 1, stencil::unknown);
  PhotoEvidence evidence{nothing, std::nullopt, &rgb};
  evidence.stencil_confidence = 0;
  evidence.box_px = hint.box;
  evidence.click_px = hint.click;
  return alignment::align_photo(mesh, evidence, options, 1, {});
}

Outcome outcome_of(const PhotoCase& photo, const TriangleMesh& mesh, const Hint& hint, const Limits& limits,
                   const Arguments& arguments) {
  const double before = test::cpu_seconds();
  const Alignment found = align(mesh, photo.rgb, hint, arguments.options);
  Outcome outcome;
  outcome.seconds = test::cpu_seconds() - before;
  outcome.verdict = found.verdict;
  outcome.free_axis = found.free_axis && found.verdict == Verdict::review;
  outcome.rotation_deg = 180;
  const auto within = [&](const Camera& camera) {
    const PoseError error = pose_error(photo, camera);
    return error.rotation_deg < limits.rotation_deg && error.size_percent < limits.size_percent;
  };
  if (!found.candidates.empty()) {
    outcome.rotation_deg = pose_error(photo, found.camera).rotation_deg;
    const PoseError error = pose_error(photo, found.camera);
    outcome.wrong =
        error.rotation_deg >= real_limits.rotation_deg || error.size_percent >= real_limits.size_percent;
    outcome.score = found.candidates.front().score;
    outcome.pose_right = within(found.camera);
    outcome.right = outcome.pose_right && found.edge_support.value_or(1) >= limits.edge_support;
    outcome.among_finalists =
        std::any_of(found.candidates.begin(), found.candidates.end(),
                    [&](const alignment::AlignmentCandidate& c) { return within(c.camera); });
  }
  if (arguments.verbose) {
    const PoseError error = pose_error(photo, found.camera);
    fmt::print("  {:14} {:6.2f} deg {:5.1f} % | parting {:.2f} edges {:.2f} inliers {:.2f} | ", photo.name,
               error.rotation_deg, error.size_percent, outcome.score, found.edge_support.value_or(0),
               found.inlier_fraction);
    for (const alignment::AlignmentCandidate& c : found.candidates)
      fmt::print("{:.3f}{} ", c.score, within(c.camera) ? "*" : "");
    fmt::print("| {}\n", found.reasons.empty() ? "" : found.reasons.front());
    std::fflush(stdout);
  }
  return outcome;
}

/// The verdict's confusion, and the share of wrong poses among the so many with the best scores.
void print_verdicts(const std::string& row, std::vector<Outcome> outcomes) {
  if (outcomes.empty()) return;
  fmt::print("{} verdicts:", row);
  for (const bool wrong : {false, true})
    for (const auto& [verdict, name] : {std::pair{Verdict::accept, "accepted"},
                                        {Verdict::review, "for review"},
                                        {Verdict::reject, "rejected"}})
      fmt::print("{} {} {} {}", name == std::string("accepted") ? " |" : ",", wrong ? "wrong" : "right", name,
                 std::count_if(outcomes.begin(), outcomes.end(), [&, v = verdict](const Outcome& o) {
                   return o.wrong == wrong && o.verdict == v;
                 }));
  std::stable_sort(outcomes.begin(), outcomes.end(),
                   [](const Outcome& a, const Outcome& b) { return a.score > b.score; });
  fmt::print(" | risk at coverage");
  for (const std::size_t percent : {20U, 40U, 60U, 80U, 100U}) {
    const std::size_t count = std::max<std::size_t>(1, outcomes.size() * percent / 100);
    const auto wrong = std::count_if(outcomes.begin(), outcomes.begin() + static_cast<std::ptrdiff_t>(count),
                                     [](const Outcome& o) { return o.wrong; });
    fmt::print(" {} %: {:.2f}", percent, static_cast<double>(wrong) / static_cast<double>(count));
  }
  fmt::print("\n");
  std::fflush(stdout);
}

// Of `count` in `n`: the upper bound of Wilson (1927).
double upper_bound(double count, double n) {
  const double share = count / n;
  const double z = 1.96;
  return (share + z * z / (2 * n) + z * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n))) /
         (1 + z * z / n);
}

// Objects that are not in the photo, each sought in a box round something else. What is known so far is
// printed as it grows: the whole takes long, and may be stopped.
void measure_absent(const Arguments& arguments) {
  const std::vector<AbsentCase> cases = absent_cases(arguments.pairs, arguments.cache);
  int counts[3] = {0, 0, 0};
  double seconds = 0;
  int done = 0;
  for (const AbsentCase& absent : cases) {
    if (done++ < arguments.skip) continue;
    Hint hint;
    hint.box = absent.box;
    const double before = test::cpu_seconds();
    const Alignment found = align(absent.mesh, absent.rgb, hint, arguments.options);
    seconds += test::cpu_seconds() - before;
    ++counts[static_cast<int>(found.verdict)];
    if (found.verdict == Verdict::accept || arguments.verbose)
      fmt::print("  {:32} {:8} score {:.2f} edges {:.2f} inliers {:.2f}\n", absent.name,
                 found.verdict == Verdict::accept   ? "ACCEPTED"
                 : found.verdict == Verdict::review ? "review"
                                                    : "rejected",
                 found.candidates.empty() ? 0 : found.candidates.front().score,
                 found.edge_support.value_or(0), found.inlier_fraction);
    const double n = counts[0] + counts[1] + counts[2];
    if (done % 25 == 0 || done == static_cast<int>(cases.size()))
      fmt::print(
          "absent: {} pairs | accepted {} (95 % upper bound {:.1f} %), for review {}, rejected {} | CPU s "
          "{:.2f}\n",
          n, counts[0], 100 * upper_bound(counts[0], n), counts[1], counts[2], seconds / n);
    std::fflush(stdout);
  }
}

TriangleMesh without_colors(TriangleMesh mesh) {
  mesh.colors.clear();
  return mesh;
}

std::vector<Hint> hints_of(const PhotoCase& photo, const std::string& kind, int draws) {
  std::vector<Hint> hints;
  Rng rng(7);
  for (int i = 0; i < (kind == "unaided" ? 1 : draws); ++i) {
    Hint hint;
    if (kind == "box") hint.box = loose_box(photo.silhouette, rng);
    if (kind == "click") hint.click = click_inside(photo.silhouette, rng);
    hints.push_back(hint);
  }
  return hints;
}

void measure(const std::vector<PhotoCase>& photos, const std::string& row, bool by_photo, int draws,
             const Limits& limits, const Arguments& arguments) {
  if (arguments.rows.find(row) == std::string::npos) return;
  std::vector<Outcome> every;
  for (const std::string kind : {"box", "click", "unaided"})
    for (const bool colors : {false, true}) {
      if (!arguments.kinds.empty() && arguments.kinds.find(kind) == std::string::npos) continue;
      Tally all;
      for (const PhotoCase& photo : photos) {
        Tally one;
        const TriangleMesh mesh = colors ? photo.mesh : without_colors(photo.mesh);
        for (const Hint& hint : hints_of(photo, kind, draws))
          one.outcomes.push_back(outcome_of(photo, mesh, hint, limits, arguments));
        if (by_photo) one.print(fmt::format("{} {} {}", photo.name, kind, colors ? "colour" : "plain"));
        all.outcomes.insert(all.outcomes.end(), one.outcomes.begin(), one.outcomes.end());
      }
      if (!by_photo) all.print(fmt::format("{} {} {}", row, kind, colors ? "colour" : "plain"));
      every.insert(every.end(), all.outcomes.begin(), all.outcomes.end());
    }
  print_verdicts(row, every);
}

std::vector<PhotoCase> simulated(Scene scene, const Arguments& arguments) {
  std::vector<PhotoCase> photos;
  for (int i = 0; i < arguments.photos; ++i)
    photos.push_back(simulated_case(arguments.skip + i, scene, arguments.cache));
  return photos;
}

Arguments parsed(test::ProgramArguments& given) {
  Arguments arguments;
  arguments.rows = given.text("rows").value_or(arguments.rows);
  arguments.kinds = given.text("kinds").value_or(arguments.kinds);
  arguments.photos = given.integer("photos").value_or(arguments.photos);
  arguments.draws = given.integer("draws").value_or(arguments.draws);
  arguments.skip = given.integer("skip").value_or(arguments.skip);
  arguments.pairs = given.integer("pairs").value_or(arguments.pairs);
  arguments.cache = given.text("cache").value_or("");
  arguments.verbose = given.flag("verbose");
  given.read(arguments.options);
  given.finish();
  return arguments;
}

void run(const Arguments& arguments) {
  const auto wants = [&](const char* row) { return arguments.rows.find(row) != std::string::npos; };
  if (wants("clutter"))
    measure(simulated(Scene::clutter, arguments), "clutter", false, 1, simulated_limits, arguments);
  if (wants("studio"))
    measure(simulated(Scene::studio, arguments), "studio", false, 1, simulated_limits, arguments);
  if (wants("dino")) {
    const std::vector<PhotoCase> photos = dino_cases();
    if (photos.empty()) fmt::print("dino skipped: needs photos/dino of DRAPE_TEST_DATA\n");
    measure(photos, "dino", false, 1, real_limits, arguments);
  }
  if (wants("absent")) measure_absent(arguments);
  if (wants("lmo")) {
    const std::vector<PhotoCase> photos = lmo_cases();
    if (photos.empty()) fmt::print("lmo skipped: needs photos/lmo of DRAPE_TEST_DATA\n");
    measure(photos, "lmo", true, arguments.draws, real_limits, arguments);
  }
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  return drape::test::measuring_main(
      count, texts, [](drape::test::ProgramArguments& arguments) { drape::run(drape::parsed(arguments)); });
}
