// The pieces that an atlas is made of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "atlas_packing.hpp"
#include "drape/base/random.hpp"
#include "face_edges.hpp"
#include "outline_warp.hpp"
#include "support.hpp"
#include "tree_reweighted.hpp"
#include "triangle_raster.hpp"
#include "unseen_surface.hpp"

namespace drape::texturing {
namespace {

// Random costs on the given edges; nodes have one to three labels.
LabelProblem random_problem(std::uint32_t nodes, const std::vector<std::array<std::uint32_t, 2>>& edges,
                            std::uint64_t seed) {
  Rng rng(seed);
  LabelProblem problem;
  for (std::uint32_t n = 0; n < nodes; ++n) {
    for (std::uint64_t l = 1 + rng.below(3); l > 0; --l)
      problem.unary.push_back(static_cast<float>(rng.uniform()));
    problem.first_label.push_back(static_cast<std::uint32_t>(problem.unary.size()));
  }
  for (const auto& [a, b] : edges) {
    problem.edges.push_back({a, b, static_cast<std::uint32_t>(problem.pairwise.size())});
    for (std::uint32_t i = 0; i < problem.labels_of(a) * problem.labels_of(b); ++i)
      problem.pairwise.push_back(static_cast<float>(rng.uniform()));
  }
  return problem;
}

double cost_of(const LabelProblem& p, const std::vector<std::uint32_t>& labels) {
  double cost = 0;
  for (std::size_t n = 0; n < labels.size(); ++n) cost += p.unary[p.first_label[n] + labels[n]];
  for (const auto& e : p.edges)
    cost += p.pairwise[e.first_cost + labels[e.a] * p.labels_of(e.b) + labels[e.b]];
  return cost;
}

// By trying all labellings.
double least_cost(const LabelProblem& p) {
  std::vector<std::uint32_t> labels(p.nodes(), 0);
  double least = std::numeric_limits<double>::infinity();
  for (;;) {
    least = std::min(least, cost_of(p, labels));
    std::size_t n = 0;
    while (n < labels.size() && ++labels[n] == p.labels_of(n)) labels[n++] = 0;
    if (n == labels.size()) return least;
  }
}

TEST(TreeReweighted, IsExactOnTrees) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const LabelProblem p =
        random_problem(9, {{0, 1}, {1, 2}, {1, 3}, {3, 7}, {2, 4}, {2, 5}, {5, 6}, {6, 8}}, seed);
    const Labelling found = least_cost_labels(p, 30);
    EXPECT_NEAR(found.cost, least_cost(p), 1e-5);
    EXPECT_NEAR(found.cost, cost_of(p, found.labels), 1e-9);
    EXPECT_NEAR(found.lower_bound, found.cost, 2e-3 * found.cost);
  }
}

TEST(TreeReweighted, BoundsTheLeastCostOfGraphsWithLoops) {
  int exact = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const LabelProblem p = random_problem(
        9, {{0, 1}, {1, 2}, {3, 4}, {4, 5}, {6, 7}, {7, 8}, {0, 3}, {3, 6}, {1, 4}, {4, 7}, {2, 5}, {5, 8}},
        seed);
    const Labelling found = least_cost_labels(p, 60);
    const double least = least_cost(p);
    EXPECT_LE(found.lower_bound, least + 1e-5);
    EXPECT_GE(found.cost, least - 1e-5);
    if (found.cost < least + 1e-5) ++exact;
  }
  EXPECT_GE(exact, 24);
}

TEST(TreeReweighted, NodesWithoutLabelsAreLeftOut) {
  LabelProblem p;
  p.first_label = {0, 0, 2, 2};
  p.unary = {3, 1};
  EXPECT_EQ(least_cost_labels(p, 3).labels, (std::vector<std::uint32_t>{0, 1, 0}));
}

TEST(FaceEdges, AreAllOfAClosedMesh) {
  const TriangleMesh torus = test::torus(1, 0.4, 12, 8);
  const std::vector<FaceEdge> edges = face_edges(torus);
  EXPECT_EQ(edges.size(), torus.faces.size() * 3 / 2);
  for (const FaceEdge& e : edges) {
    EXPECT_LT(e.first, e.second);
    for (const std::uint32_t f : {e.first, e.second})
      for (const std::uint32_t v : {e.low, e.high})
        EXPECT_NE(std::find(torus.faces[f].begin(), torus.faces[f].end(), v), torus.faces[f].end());
  }
}

TEST(Packing, NeverOverlaps) {
  Rng rng(3);
  std::vector<Rectangle> rectangles;
  for (int i = 0; i < 400; ++i)
    rectangles.push_back({1 + static_cast<int>(rng.below(60)), 1 + static_cast<int>(rng.below(40))});
  for (const int most : {64, 200, 4096}) {
    const Packing packing = packed(rectangles, most);
    if (most == 4096) {
      EXPECT_EQ(packing.sides.size(), 1U);
    }
    std::vector<Image8> taken;
    double area = 0;
    for (const int side : packing.sides) {
      EXPECT_LE(side, most);
      taken.emplace_back(side, side, 1, 0);
      area += static_cast<double>(side) * side;
    }
    double used = 0;
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
      const Placement& p = packing.placements[i];
      Image8& page = taken[static_cast<std::size_t>(p.page)];
      used += static_cast<double>(rectangles[i].width) * rectangles[i].height;
      ASSERT_LE(p.left + rectangles[i].width, page.width());
      ASSERT_LE(p.top + rectangles[i].height, page.height());
      for (int y = p.top; y < p.top + rectangles[i].height; ++y)
        for (int x = p.left; x < p.left + rectangles[i].width; ++x) {
          ASSERT_EQ(page.at(x, y), 0);
          page.at(x, y) = 1;
        }
    }
    EXPECT_GT(used, 0.6 * area);
  }
  EXPECT_TRUE(packed({}, 64).sides.empty());
}

TEST(TriangleRaster, TakesEachTexelOfTwoFacesOnceAndWeighsCorners) {
  const std::array<Eigen::Vector2d, 3> low = {Eigen::Vector2d(1.2, 1.1), {14.7, 3.3}, {3.1, 12.9}};
  const std::array<Eigen::Vector2d, 3> high = {low[2], low[1], Eigen::Vector2d(15.2, 14.8)};
  int count = 0;
  for (const auto& t : {low, high})
    for_texels(t, 0, {0, 0, 16, 16}, [&](int x, int y, const Eigen::Vector3d& weights) {
      ++count;
      const Eigen::Vector2d again = weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2];
      EXPECT_NEAR((again - Eigen::Vector2d(x + 0.5, y + 0.5)).norm(), 0, 1e-9);
    });
  const auto area = [](const auto& t) {
    const Eigen::Vector2d u = t[1] - t[0];
    const Eigen::Vector2d v = t[2] - t[0];
    return std::abs(u.x() * v.y() - u.y() * v.x()) / 2;
  };
  EXPECT_NEAR(count, area(low) + area(high), 8);
  for_texels(
      {Eigen::Vector2d(1, 1), {5, 5}, {9, 9}}, 2, {0, 0, 16, 16},
      [](int, int, const Eigen::Vector3d&) { ADD_FAILURE() << "a triangle without area has no texels"; });
}

Image8 disc(double x, double y, double radius_x, double radius_y) {
  Image8 stencil(240, 200, 1, stencil::background);
  for (int v = 0; v < 200; ++v)
    for (int u = 0; u < 240; ++u)
      if (std::pow((u + 0.5 - x) / radius_x, 2) + std::pow((v + 0.5 - y) / radius_y, 2) < 1)
        stencil.at(u, v) = stencil::object;
  return stencil;
}

TEST(OutlineWarp, BringsTheOutlinesTogether) {
  // Shifted by (2, -1) and wider by 1.5 px a side.
  const SnappedOutline snapped = snapped_outline(disc(120, 100, 70, 60), disc(122, 99, 71.5, 60), 5);
  for (const double angle : {0.0, 0.7, 1.6, 2.5, 3.1, 4.0, 5.2}) {
    const Eigen::Vector2d on_model(120 + 70 * std::cos(angle), 100 + 60 * std::sin(angle));
    const Eigen::Vector2d moved = snapped.warp(on_model);
    const double ratio =
        std::hypot((moved.x() - 122) / 71.5, (moved.y() - 99) / 60);  // 1 on the photo's outline
    EXPECT_NEAR((ratio - 1) * 65, 0, 0.35);
  }
  EXPECT_NEAR((snapped.warp({120, 100}) - Eigen::Vector2d(122, 99)).norm(), 0, 0.6);
  EXPECT_GT(snapped.largest_px, 2);
}

TEST(OutlineWarp, IsBoundedAndSwitchedOff) {
  const Image8 here = disc(120, 100, 70, 60);
  const Image8 there = disc(124, 100, 70, 60);
  EXPECT_LE(snapped_outline(here, there, 3).largest_px, 3 + 1e-9);
  EXPECT_EQ(snapped_outline(here, there, 0).largest_px, 0);
  EXPECT_EQ(snapped_outline(here, here, 4).largest_px, 0);
  const Eigen::Vector2d pixel(33.5, 7.25);
  EXPECT_EQ(snapped_outline(here, here, 4).warp(pixel), pixel);
  // A bite that another thing takes from the object is no outline of it.
  Image8 bitten = here;
  for (int y = 60; y < 140; ++y)
    for (int x = 150; x < 240; ++x) bitten.at(x, y) = stencil::background;
  EXPECT_LT(snapped_outline(here, bitten, 4).largest_px, 1);
}

// A grid in the plane z = 0.
TriangleMesh grid(int steps) {
  TriangleMesh mesh;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) mesh.vertices.emplace_back(i, j, 0);
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (steps + 1) + i); };
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

// Two large faces side by side, the first of them painted.
TEST(Ribbons, EndAtTheReachOfPaintedSurface) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 10, 0}, {-10, 5, 0}, {10, 5, 0}};
  mesh.faces = {{0, 2, 1}, {0, 1, 3}};
  const std::vector<std::uint8_t> painted = {1, 0};
  EXPECT_EQ(faces_within_reach(mesh, painted, 2), (std::vector<std::uint8_t>{0, 0}));
  const SplitMesh split = split_edges(mesh, ends_of_reach(mesh, painted, 2));
  std::vector<std::uint8_t> still_painted;
  for (const std::uint32_t parent : split.parents) still_painted.push_back(painted[parent]);
  const std::vector<std::uint8_t> within = faces_within_reach(split.mesh, still_painted, 2);
  double area = 0;
  for (std::size_t f = 0; f < within.size(); ++f) {
    if (within[f] == 0) continue;
    area += scaled_face_normal(split.mesh, f).norm() / 2;
    for (const std::uint32_t v : split.mesh.faces[f]) EXPECT_LT(split.mesh.vertices[v].x(), 2);
  }
  EXPECT_GT(area, 10);
  EXPECT_EQ(std::count(still_painted.begin(), still_painted.end(), 1), 1);
  EXPECT_TRUE(ends_of_reach(mesh, painted, 30).empty());
}

TEST(HarmonicColors, GoOnLinearlyBetweenWhatIsKnown) {
  TriangleMesh mesh = grid(10);
  const auto color = [](const Eigen::Vector3d& x) {
    return Eigen::Vector3f(static_cast<float>(0.05 * x.x()), static_cast<float>(0.02 * x.y()), 0.3F);
  };
  SeenColors known(mesh.vertices.size());
  for (std::size_t v = 0; v < known.size(); ++v) {
    const Eigen::Vector3d& x = mesh.vertices[v];
    if (x.x() == 0 || x.y() == 0 || x.x() == 10 || x.y() == 10) known[v] = color(x);
  }
  // A piece of its own of which nothing is known.
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double x : {20.0, 21.0, 22.0}) mesh.vertices.emplace_back(x, x * x, 0);
  mesh.faces.push_back({first, first + 1, first + 2});
  known.resize(mesh.vertices.size());
  const Eigen::Vector3f elsewhere(0.5F, 0.25F, 0.125F);
  const std::vector<Eigen::Vector3f> colors = harmonic_colors(mesh, known, elsewhere);
  for (std::size_t v = 0; v < first; ++v) EXPECT_LT((colors[v] - color(mesh.vertices[v])).norm(), 1e-5);
  for (std::size_t v = first; v < colors.size(); ++v) EXPECT_LT((colors[v] - elsewhere).norm(), 1e-4);
}

}  // namespace
}  // namespace drape::texturing
