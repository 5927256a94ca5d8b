// One label for each node of a graph, with as little cost as can be.
#pragma once

#include <cstdint>
#include <vector>

namespace drape::texturing {

/// Minimise the sum of unary[label of node] and of pairwise[labels of both ends] over all edges.
struct LabelProblem {
  std::vector<std::uint32_t> first_label = {0};  // node n has labels first_label[n] .. first_label[n + 1]
  std::vector<float> unary;                      // per node and label
  struct Edge {
    std::uint32_t a;
    std::uint32_t b;           // a < b
    std::uint32_t first_cost;  // pairwise[first_cost + label of a * labels of b + label of b]
  };
  std::vector<Edge> edges;
  std::vector<float> pairwise;

  [[nodiscard]] std::size_t nodes() const { return first_label.size() - 1; }
  [[nodiscard]] std::uint32_t labels_of(std::size_t node) const {
    return first_label[node + 1] - first_label[node];
  }
};

struct Labelling {
  std::vector<std::uint32_t> labels;  // per node, counted from its own first label
  double cost = 0;
  double lower_bound = 0;  // no labelling costs less
};

/// Sequential tree-reweighted message passing (TRW-S; Kolmogorov, "Convergent Tree-Reweighted Message Passing
/// for Energy Minimization", PAMI 2006, section 3.3); exact on trees. Nodes without labels take part in no
/// edge and get label 0. Nodes are visited in their order: always the same result.
[[nodiscard]] Labelling least_cost_labels(const LabelProblem& problem, int most_sweeps);

}  // namespace drape::texturing
