#include "sample_neighbors.hpp"

#include <numeric>

namespace drape::meshing {

SampleNeighbors::SampleNeighbors(const std::vector<Face>& faces, std::size_t samples)
    : first_(samples + 1, 0) {
  for (const Face& f : faces)
    for (const std::uint32_t v : f) ++first_[v + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  indices_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Face& f : faces)
    for (std::size_t k = 0; k < 3; ++k) indices_[next[f[k]]++] = f[(k + 1) % 3];
}

}  // namespace drape::meshing
