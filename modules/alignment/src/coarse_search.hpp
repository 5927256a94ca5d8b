// Which poses are worth refining, by polar pictures of the mesh's views.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "evidence.hpp"
#include "pose_refinement.hpp"
#include "view_atlas.hpp"

namespace drape::alignment {

class CoarseSearch {
 public:
  /// References to the first three are kept. `allowed`: which poses may be tried; empty: all.
  CoarseSearch(const OutlineMesh& mesh, const Evidence& evidence, const LensPrior& lens,
               std::function<bool(const OutlinePose&)> allowed);

  /// Distinct starting poses, best first. With effort 1 the evidence is taken to be wrong in part.
  [[nodiscard]] std::vector<OutlinePose> starts(int effort, std::size_t most) const;

  /// Starting poses about where the object is in these poses, from somewhat smaller to twice as large: at
  /// most `most` of each size, distinct among themselves.
  [[nodiscard]] std::vector<OutlinePose> starts_about(const std::vector<OutlinePose>& places,
                                                      std::size_t most) const;

  /// Pictures that starts() compares.
  [[nodiscard]] std::size_t listed(int effort) const;

 private:
  struct Candidate {
    float score = 0;
    std::size_t frame = 0;
    std::size_t view = 0;
    int roll = 0;
  };

  [[nodiscard]] double expected_perspective(const PolarFrame& frame) const;
  [[nodiscard]] std::vector<PolarFrame> promising(std::vector<PolarFrame> frames) const;
  [[nodiscard]] std::vector<PolarFrame> best_frames(const std::vector<PolarFrame>& frames, std::size_t stride,
                                                    std::size_t most) const;
  [[nodiscard]] std::vector<OutlinePose> by_frames(const std::vector<PolarFrame>& frames, std::size_t most,
                                                   std::size_t most_in_a_place) const;
  [[nodiscard]] std::vector<OutlinePose> by_outline(std::size_t most) const;
  [[nodiscard]] std::vector<OutlinePose> distinct(std::size_t count,
                                                  const std::function<OutlinePose(std::size_t)>& pose_at,
                                                  double apart_rad, std::size_t most,
                                                  std::size_t most_in_a_place) const;
  [[nodiscard]] OutlinePose pose_of(const Candidate& candidate, const PolarFrame& frame) const;
  [[nodiscard]] OutlinePose pose_of(const AtlasView& view, double angle, double scale,
                                    const Eigen::Vector2d& shift, const Eigen::Vector2d& center) const;

  const OutlineMesh& mesh_;
  const Evidence& evidence_;
  const LensPrior& lens_;
  std::function<bool(const OutlinePose&)> allowed_;
  double perspective_ = 0;
  std::vector<AtlasView> views_;
};

}  // namespace drape::alignment
