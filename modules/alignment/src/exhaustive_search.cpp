#include "exhaustive_search.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <numeric>

#include "drape/base/parallel.hpp"
#include "rotation_grid.hpp"

namespace drape::alignment {
namespace {

// Centres of perspective stencils settle in two or three steps; those of a model that the image's border cuts
// may never.
constexpr int most_translations = 10;
constexpr std::size_t cells_per_report = 32;
// A candidate's refinement is most of the work; shares of the progress bar.
constexpr double first_pass_share = 0.2;
constexpr double fov_share = 0.02;

class Search {
 public:
  Search(const SearchInput& input, const ExhaustiveOptions& options)
      : input_(input),
        options_(options),
        fitness_(make_fitness(input.image, options)),
        renderers_(input.mesh, input.image.pixels.width(), input.image.pixels.height()) {}

  [[nodiscard]] SearchResult run(const Progress& progress);

 private:
  using Draw = std::function<const Image8&(const ModelPose&)>;

  [[nodiscard]] FittedPose fit(const EulerAngles& angles, const ModelPose& from);
  [[nodiscard]] std::vector<FittedPose> fit_all(std::span<const EulerAngles> rotations);
  [[nodiscard]] Moments translate(ModelPose& pose, const Draw& draw) const;
  [[nodiscard]] bool scale(ModelPose& pose, const Moments& model) const;
  [[nodiscard]] Moments model_moments(const Image8& model) const;
  void initial_pose();
  [[nodiscard]] std::vector<FittedPose> first_pass(const Progress& progress);
  [[nodiscard]] bool refine(FittedPose& candidate);
  [[nodiscard]] FittedPose field_of_view(const FittedPose& best);
  template <class Work>
  auto with_renderer(const Work& work);

  const SearchInput& input_;
  const ExhaustiveOptions& options_;
  std::unique_ptr<FitnessMeasure> fitness_;
  StencilRendererPool renderers_;
  ModelPose start_;
  ModelPose memory_;  // with scale_memory: the pose fitted last
  std::atomic<std::int64_t> drawn_{0};
};

// Calls work(draw) with a renderer of the calling thread's own.
template <class Work>
auto Search::with_renderer(const Work& work) {
  StencilRendererPool::Lease lease(renderers_);
  const Image8& image = input_.image.pixels;
  const Draw draw = [&](const ModelPose& pose) -> const Image8& {
    drawn_.fetch_add(1, std::memory_order_relaxed);
    return lease.renderer().draw(input_.frame.camera(pose).resized(image.width(), image.height()));
  };
  return work(draw);
}

// Unknown pixels count neither way; a model that lies in them altogether must be brought out first.
Moments Search::model_moments(const Image8& model) const {
  Moments moments = moments_of(model, input_.image.known);
  if (moments.pixels == 0) moments = moments_of(model, Image8(model.width(), model.height(), 1, 1));
  return moments;
}

// Thesis 4.2.1: moves the model by the difference of the centres until that is small. Returns the moments of
// the model where it ends; no pixels if it is not in the picture.
Moments Search::translate(ModelPose& pose, const Draw& draw) const {
  const Camera photo = input_.frame.camera(pose);
  const Eigen::Vector2d photo_per_stencil(static_cast<double>(photo.width) / input_.image.pixels.width(),
                                          static_cast<double>(photo.height) / input_.image.pixels.height());
  Moments model = model_moments(draw(pose));
  for (int i = 0; i < most_translations && model.pixels > 0; ++i) {
    const Eigen::Vector2d shift = input_.image.moments.center - model.center;
    if (shift.norm() < options_.translation_threshold_px) break;
    pose.translation += input_.frame.translation_of(shift.cwiseProduct(photo_per_stencil), pose);
    model = model_moments(draw(pose));
  }
  return model;
}

// Thesis 4.2.2: scales x and y by the ratio of the standard deviations, about the model stencil's centre, so
// that the centres stay together. False if the model's stencil has no width or height to be scaled.
bool Search::scale(ModelPose& pose, const Moments& model) const {
  if (model.pixels == 0 || !(model.deviation.minCoeff() > 0)) return false;
  const Camera photo = input_.frame.camera(pose);
  const Eigen::Vector2d photo_per_stencil(static_cast<double>(photo.width) / input_.image.pixels.width(),
                                          static_cast<double>(photo.height) / input_.image.pixels.height());
  const Eigen::Vector2d center =
      input_.frame.place_at_depth(model.center.cwiseProduct(photo_per_stencil), pose);
  const Eigen::Vector2d ratio = input_.image.moments.deviation.cwiseQuotient(model.deviation);
  pose.scale = pose.scale.cwiseProduct(ratio);
  pose.translation = center + ratio.cwiseProduct(pose.translation - center);
  return true;
}

// Algorithm 6, inside its loops: rotate, translate, scale, compare.
FittedPose Search::fit(const EulerAngles& angles, const ModelPose& from) {
  return with_renderer([&](const Draw& draw) {
    FittedPose fitted{from, 0};
    fitted.pose.angles = angles;
    const Moments model = translate(fitted.pose, draw);
    if (scale(fitted.pose, model)) fitted.fitness = (*fitness_)(draw(fitted.pose));
    return fitted;
  });
}

std::vector<FittedPose> Search::fit_all(std::span<const EulerAngles> rotations) {
  std::vector<FittedPose> fitted(rotations.size());
  if (options_.scale_memory) {
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      fitted[i] = fit(rotations[i], memory_);
      // A model that was lost from sight would never come back.
      memory_ = fitted[i].fitness > 0 ? fitted[i].pose : start_;
    }
    return fitted;
  }
  parallel_for(rotations.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) fitted[i] = fit(rotations[i], start_);
  });
  return fitted;
}

// Algorithm 6, before its loops.
void Search::initial_pose() {
  start_ = input_.frame.start(input_.fov_deg);
  with_renderer([&](const Draw& draw) {
    ModelPose pose = start_;
    if (scale(pose, translate(pose, draw)))
      start_ =
          options_.initial_scale == InitialScale::distance ? input_.frame.scaled_by_distance(pose) : pose;
    return 0;
  });
  memory_ = start_;
}

// Algorithm 4: the fitness of every rotation of the grid, best first.
std::vector<FittedPose> Search::first_pass(const Progress& progress) {
  const RotationGrid grid = rotation_grid(options_.first_pass_step_deg);
  std::vector<std::size_t> cells;  // to be fitted
  for (std::size_t i = 0; i < grid.cells.size(); ++i)
    if (options_.scale_memory || grid.same_rotation[i] == i) cells.push_back(i);

  std::vector<FittedPose> fitted(grid.cells.size());
  for (std::size_t begin = 0; begin < cells.size(); begin += cells_per_report) {
    progress.update(static_cast<double>(begin) / static_cast<double>(cells.size()), "first pass");
    const std::size_t end = std::min(cells.size(), begin + cells_per_report);
    std::vector<EulerAngles> rotations;
    for (std::size_t i = begin; i < end; ++i) rotations.push_back(grid.cells[cells[i]]);
    const std::vector<FittedPose> batch = fit_all(rotations);
    for (std::size_t i = begin; i < end; ++i) fitted[cells[i]] = batch[i - begin];
  }

  std::vector<FittedPose> list;
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (!options_.scale_memory && grid.has_earlier_twin[i]) continue;
    FittedPose entry = options_.scale_memory ? fitted[i] : fitted[grid.same_rotation[i]];
    entry.pose.angles = grid.cells[i];
    list.push_back(entry);
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const FittedPose& a, const FittedPose& b) { return a.fitness > b.fitness; });
  return list;
}

// Algorithm 5, one candidate. False if it was dropped.
bool Search::refine(FittedPose& candidate) {
  FittedPose best = candidate;
  best.fitness = 0;
  const double first_step = options_.refine_start_deg.value_or(options_.first_pass_step_deg / 2);
  for (double step = first_step; step >= options_.min_step_deg; step /= 2) {
    std::vector<EulerAngles> rotations;
    for (const double pitch : {-step, 0.0, step})
      for (const double yaw : {-step, 0.0, step})
        for (const double roll : {-step, 0.0, step})
          rotations.push_back({best.pose.angles.pitch_deg + pitch, best.pose.angles.yaw_deg + yaw,
                               best.pose.angles.roll_deg + roll});
    double best_of_step = 0;
    for (const FittedPose& fitted : fit_all(rotations)) {
      best_of_step = std::max(best_of_step, fitted.fitness);
      if (fitted.fitness >= best.fitness) best = fitted;
    }
    if (step <= options_.drop_step_deg && best_of_step <= options_.drop_overlap_percent) {
      candidate = best;
      return false;
    }
  }
  candidate = best;
  return true;
}

// Thesis 4.2.5: everything else is kept.
FittedPose Search::field_of_view(const FittedPose& best) {
  std::vector<double> angles;
  const int range = static_cast<int>(std::floor(options_.fov_range_deg));
  for (int i = 1; i <= range; ++i)
    for (const double angle : {best.pose.fov_deg - i, best.pose.fov_deg + i})
      if (angle >= 1 && angle <= 170) angles.push_back(angle);
  std::vector<FittedPose> fitted(angles.size(), best);
  parallel_for(angles.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      fitted[i].pose.fov_deg = angles[i];
      fitted[i].fitness = with_renderer([&](const Draw& draw) { return (*fitness_)(draw(fitted[i].pose)); });
    }
  });
  FittedPose chosen = best;
  for (const FittedPose& other : fitted)
    if (other.fitness > chosen.fitness) chosen = other;
  return chosen;
}

SearchResult Search::run(const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  SearchResult result;
  initial_pose();
  const std::vector<FittedPose> list = first_pass(progress.part(0, first_pass_share));
  result.pass1_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  result.candidates_listed = static_cast<int>(list.size());
  const auto most =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(options_.max_candidates_percent / 100 *
                                                                  static_cast<double>(list.size()))));
  const Progress refinement = progress.part(first_pass_share, 1 - fov_share);
  std::vector<FittedPose> dropped;
  for (std::size_t i = 0; i < std::min(most, list.size()) && !result.accepted; ++i) {
    refinement.update(static_cast<double>(i) / static_cast<double>(most), "refining candidates");
    FittedPose candidate = list[i];
    ++result.candidates_tried;
    if (!refine(candidate)) {
      dropped.push_back(candidate);
      continue;
    }
    result.candidates.push_back(candidate);
    result.accepted = candidate.fitness > options_.accept_overlap_percent;
  }
  // Where none held out to the smallest step, the best of what was left early is still the answer.
  result.every_candidate_dropped = result.candidates.empty();
  if (result.every_candidate_dropped) result.candidates = std::move(dropped);
  std::stable_sort(result.candidates.begin(), result.candidates.end(),
                   [](const FittedPose& a, const FittedPose& b) { return a.fitness > b.fitness; });
  progress.update(1 - fov_share, "field of view");
  result.best = field_of_view(result.candidates.front());
  result.stencils_drawn = drawn_;
  progress.update(1, "field of view");
  return result;
}

}  // namespace

SearchResult exhaustive_search(const SearchInput& input, const ExhaustiveOptions& options,
                               const Progress& progress) {
  return Search(input, options).run(progress);
}

}  // namespace drape::alignment
