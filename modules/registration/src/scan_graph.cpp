#include "scan_graph.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace drape::registration {
namespace {

// How far two motions put the corners of a box apart, root mean square.
double apart(const Rigid3& a, const Rigid3& b, const BoundingBox& box) {
  double squares = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p = box.corner(static_cast<BoundingBox::CornerType>(corner));
    squares += (a * p - b * p).squaredNorm() / 8;
  }
  return std::sqrt(squares);
}

class Joiner {
 public:
  Joiner(std::span<const GraphScan> scans, std::span<const GraphEdge> edges, double tolerance)
      : scans_(scans), edges_(edges), tolerance_(tolerance) {
    graph_.against.resize(edges.size());
    const auto first_fixed = static_cast<std::size_t>(
        std::find_if(scans.begin(), scans.end(), [](const GraphScan& s) { return s.fixed; }) - scans.begin());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      graph_.group.push_back(scans[i].fixed ? first_fixed : i);
      graph_.group_from_scan.push_back(scans[i].fixed ? scans[i].group_from_scan : Rigid3::Identity());
    }
  }

  void join(std::size_t e, const std::function<bool(std::size_t, std::size_t, const Rigid3&)>& conflict) {
    const GraphEdge& edge = edges_[e];
    std::size_t target_group = graph_.group[edge.target];
    std::size_t source_group = graph_.group[edge.source];
    if (target_group == source_group) return;
    Rigid3 target_from_source = graph_.group_from_scan[edge.target] * edge.target_from_source *
                                graph_.group_from_scan[edge.source].inverse();
    if (!outweighs(target_from_source, source_group, target_group)) {
      graph_.against[e] = "it contradicts other pairs";
      return;
    }
    for (std::size_t s = 0; s < scans_.size(); ++s)
      for (std::size_t t = 0; t < scans_.size(); ++t)
        if (graph_.group[s] == source_group && graph_.group[t] == target_group &&
            conflict(s, t,
                     graph_.group_from_scan[t].inverse() * target_from_source * graph_.group_from_scan[s])) {
          graph_.against[e] = "it would put scans where others looked through";
          return;
        }
    // The frame of the group with the fixed scans, else of the lower first scan, stays.
    const bool keep_source = fixed(source_group) || (!fixed(target_group) && source_group < target_group);
    if (keep_source) {
      std::swap(source_group, target_group);
      target_from_source = target_from_source.inverse();
    }
    for (std::size_t i = 0; i < scans_.size(); ++i)
      if (graph_.group[i] == source_group) {
        graph_.group[i] = target_group;
        graph_.group_from_scan[i] = target_from_source * graph_.group_from_scan[i];
      }
  }

  ScanGraph finished() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const GraphEdge& edge = edges_[e];
      if (!graph_.against[e].empty() || graph_.group[edge.source] != graph_.group[edge.target]) continue;
      const Rigid3 placed =
          graph_.group_from_scan[edge.target].inverse() * graph_.group_from_scan[edge.source];
      if (apart(placed, edge.target_from_source, scans_[edge.source].box) > tolerance_)
        graph_.against[e] = "it contradicts other pairs";
    }
    return std::move(graph_);
  }

 private:
  [[nodiscard]] bool fixed(std::size_t group) const { return scans_[group].fixed; }

  // Whether the edges between two groups that agree with a motion outweigh the pairs whose edges do not.
  [[nodiscard]] bool outweighs(const Rigid3& target_from_source, std::size_t source_group,
                               std::size_t target_group) const {
    double balance = 0;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      GraphEdge edge = edges_[e];
      if (graph_.group[edge.source] == target_group && graph_.group[edge.target] == source_group) {
        std::swap(edge.source, edge.target);
        edge.target_from_source = edge.target_from_source.inverse();
      }
      if (graph_.group[edge.source] != source_group || graph_.group[edge.target] != target_group) continue;
      const Rigid3 placed = graph_.group_from_scan[edge.target].inverse() * target_from_source *
                            graph_.group_from_scan[edge.source];
      const bool agrees = apart(placed, edge.target_from_source, scans_[edge.source].box) <= tolerance_;
      balance += agrees ? edge.score : -edge.score;
    }
    return balance > 0;
  }

  std::span<const GraphScan> scans_;
  std::span<const GraphEdge> edges_;
  double tolerance_;
  ScanGraph graph_;
};

// target_from_source of an edge in the direction that is asked for.
Rigid3 along(const GraphEdge& edge, std::size_t source) {
  return edge.source == source ? edge.target_from_source : edge.target_from_source.inverse();
}
std::size_t other_end(const GraphEdge& edge, std::size_t scan) {
  return edge.source == scan ? edge.target : edge.source;
}

// Scores and what loops of three add to them.
std::vector<double> sureness(std::span<const GraphScan> scans, std::span<const GraphEdge> edges,
                             double tolerance) {
  std::vector<std::vector<std::size_t>> at(scans.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    at[edges[e].source].push_back(e);
    at[edges[e].target].push_back(e);
  }
  std::vector<double> result;
  for (const GraphEdge& edge : edges) {
    double sure = edge.score;
    for (const std::size_t first : at[edge.source])
      for (const std::size_t second : at[edge.target]) {
        const std::size_t middle = other_end(edges[first], edge.source);
        if (middle == edge.target || middle != other_end(edges[second], edge.target)) continue;
        const Rigid3 round = along(edges[second], middle) * along(edges[first], edge.source);
        if (apart(round, edge.target_from_source, scans[edge.source].box) <= tolerance)
          sure += std::min(edges[first].score, edges[second].score);
      }
    result.push_back(sure);
  }
  return result;
}

}  // namespace

ScanGraph join_scans(std::span<const GraphScan> scans, std::span<const GraphEdge> edges, double tolerance,
                     const std::function<bool(std::size_t, std::size_t, const Rigid3&)>& conflict) {
  const std::vector<double> sure = sureness(scans, edges, tolerance);
  std::vector<std::size_t> order(edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sure[a] > sure[b]; });
  Joiner joiner(scans, edges, tolerance);
  for (const std::size_t e : order) joiner.join(e, conflict);
  return joiner.finished();
}

}  // namespace drape::registration
