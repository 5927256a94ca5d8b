#include "tree_reweighted.hpp"

#include <algorithm>
#include <limits>

namespace drape::texturing {
namespace {

// How a node sees one of its edges.
struct Link {
  std::uint32_t edge;
  std::uint32_t other;
};

class Solver {
 public:
  explicit Solver(const LabelProblem& problem);
  Labelling solve(int most_sweeps);

 private:
  using Costs = std::vector<float>;

  [[nodiscard]] float pair_cost(const Link& link, std::size_t node, std::uint32_t own,
                                std::uint32_t theirs) const {
    const LabelProblem::Edge& e = p_.edges[link.edge];
    return e.a == node ? p_.pairwise[e.first_cost + own * p_.labels_of(e.b) + theirs]
                       : p_.pairwise[e.first_cost + theirs * p_.labels_of(e.b) + own];
  }
  // The message that the edge holds for its end `to`; there is room for one each way.
  [[nodiscard]] std::size_t message_to(std::uint32_t edge, std::size_t to) const {
    return first_message_[edge] + (p_.edges[edge].b == to ? 0 : p_.labels_of(p_.edges[edge].b));
  }
  float gather(std::size_t node, Costs& sum) const;
  void send(const Link& link, std::size_t node, const Costs& sum);
  double pass(bool forward);
  [[nodiscard]] std::vector<std::uint32_t> decided() const;
  [[nodiscard]] double cost_of(const std::vector<std::uint32_t>& labels) const;

  const LabelProblem& p_;
  std::vector<std::uint32_t> first_link_;
  std::vector<Link> links_;  // of each node
  std::vector<std::size_t> first_message_;
  std::vector<float> messages_;
  std::vector<float> share_;  // gamma: one over the number of chains through a node
};

Solver::Solver(const LabelProblem& problem) : p_(problem) {
  std::vector<std::uint32_t> before(p_.nodes(), 0);
  std::vector<std::uint32_t> after(p_.nodes(), 0);
  std::size_t messages = 0;
  for (const LabelProblem::Edge& e : p_.edges) {
    ++after[e.a];
    ++before[e.b];
    first_message_.push_back(messages);
    messages += p_.labels_of(e.a) + p_.labels_of(e.b);
  }
  messages_.assign(messages, 0);
  first_link_.assign(p_.nodes() + 1, 0);
  for (std::size_t n = 0; n < p_.nodes(); ++n) {
    first_link_[n + 1] = first_link_[n] + before[n] + after[n];
    share_.push_back(1.F / static_cast<float>(std::max({before[n], after[n], 1U})));
  }
  links_.resize(first_link_.back());
  std::vector<std::uint32_t> next(first_link_.begin(), first_link_.end() - 1);
  for (std::uint32_t i = 0; i < p_.edges.size(); ++i) {
    links_[next[p_.edges[i].a]++] = {i, p_.edges[i].b};
    links_[next[p_.edges[i].b]++] = {i, p_.edges[i].a};
  }
}

// Unary costs and all messages of a node, less their minimum, which is returned.
float Solver::gather(std::size_t node, Costs& sum) const {
  sum.assign(p_.unary.begin() + p_.first_label[node], p_.unary.begin() + p_.first_label[node + 1]);
  for (std::uint32_t i = first_link_[node]; i < first_link_[node + 1]; ++i) {
    const std::size_t message = message_to(links_[i].edge, node);
    for (std::size_t l = 0; l < sum.size(); ++l) sum[l] += messages_[message + l];
  }
  const float least = *std::min_element(sum.begin(), sum.end());
  for (float& s : sum) s -= least;
  return least;
}

void Solver::send(const Link& link, std::size_t node, const Costs& sum) {
  const std::size_t from_them = message_to(link.edge, node);
  const std::size_t to_them = message_to(link.edge, link.other);
  const std::uint32_t theirs = p_.labels_of(link.other);
  for (std::uint32_t t = 0; t < theirs; ++t) {
    float least = std::numeric_limits<float>::infinity();
    for (std::uint32_t l = 0; l < sum.size(); ++l)
      least = std::min(least, share_[node] * sum[l] - messages_[from_them + l] + pair_cost(link, node, l, t));
    messages_[to_them + t] = least;
  }
}

// One way through the nodes; the way back gives the bound (equation 21 there).
double Solver::pass(bool forward) {
  double bound = 0;
  Costs sum;
  const std::size_t count = p_.nodes();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t node = forward ? i : count - 1 - i;
    if (p_.labels_of(node) == 0) continue;
    bound += gather(node, sum);
    for (std::uint32_t k = first_link_[node]; k < first_link_[node + 1]; ++k) {
      if ((links_[k].other > node) != forward) continue;
      send(links_[k], node, sum);
      const std::size_t message = message_to(links_[k].edge, links_[k].other);
      const auto begin = messages_.begin() + static_cast<std::ptrdiff_t>(message);
      const auto end = begin + p_.labels_of(links_[k].other);
      const float least = *std::min_element(begin, end);
      for (auto at = begin; at != end; ++at) *at -= least;
      bound += least;
    }
  }
  return bound;
}

// Each node in turn, given what those before it took and what those after it say (section 3.4 there).
std::vector<std::uint32_t> Solver::decided() const {
  std::vector<std::uint32_t> labels(p_.nodes(), 0);
  Costs sum;
  for (std::size_t node = 0; node < p_.nodes(); ++node) {
    if (p_.labels_of(node) == 0) continue;
    sum.assign(p_.unary.begin() + p_.first_label[node], p_.unary.begin() + p_.first_label[node + 1]);
    for (std::uint32_t k = first_link_[node]; k < first_link_[node + 1]; ++k) {
      const Link& link = links_[k];
      const std::size_t message = message_to(link.edge, node);
      for (std::uint32_t l = 0; l < sum.size(); ++l)
        sum[l] += link.other < node ? pair_cost(link, node, l, labels[link.other]) : messages_[message + l];
    }
    labels[node] = static_cast<std::uint32_t>(std::min_element(sum.begin(), sum.end()) - sum.begin());
  }
  return labels;
}

double Solver::cost_of(const std::vector<std::uint32_t>& labels) const {
  double cost = 0;
  for (std::size_t n = 0; n < labels.size(); ++n)
    if (p_.labels_of(n) > 0) cost += p_.unary[p_.first_label[n] + labels[n]];
  for (const LabelProblem::Edge& e : p_.edges)
    cost += p_.pairwise[e.first_cost + labels[e.a] * p_.labels_of(e.b) + labels[e.b]];
  return cost;
}

Labelling Solver::solve(int most_sweeps) {
  constexpr double good_enough = 1e-3;  // of the cost, between it and the bound
  constexpr int sweeps_between_looks = 4;
  Labelling best;
  best.cost = std::numeric_limits<double>::infinity();
  best.lower_bound = -std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    (void)pass(true);
    best.lower_bound = std::max(best.lower_bound, pass(false));
    if (sweep % sweeps_between_looks != 0 && sweep + 1 != most_sweeps) continue;
    std::vector<std::uint32_t> labels = decided();
    const double cost = cost_of(labels);
    if (cost < best.cost) {
      best.cost = cost;
      best.labels = std::move(labels);
    }
    if (best.cost - best.lower_bound <= good_enough * best.cost) break;
  }
  return best;
}

}  // namespace

Labelling least_cost_labels(const LabelProblem& problem, int most_sweeps) {
  return Solver(problem).solve(std::max(1, most_sweeps));
}

}  // namespace drape::texturing
