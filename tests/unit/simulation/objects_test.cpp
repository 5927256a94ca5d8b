#include "drape/simulation/objects.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/metrics/surface_distance.hpp"
#include "drape/simulation/ray_caster.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;

constexpr double coarse = 2.5;

/// The clutter has no finer mesh than it needs.
double coarse_enough(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::teapot:
    case ObjectKind::statue:
      return coarse;
    case ObjectKind::head:
    case ObjectKind::chair:
    case ObjectKind::vase:
    case ObjectKind::machine_part:
      return 1.8;
    case ObjectKind::aircraft:
      return 1.2;  // its wings ask for it
    default:
      return 1;
  }
}

class EveryObject : public testing::TestWithParam<ObjectKind> {};
INSTANTIATE_TEST_SUITE_P(Objects, EveryObject,
                         testing::Values(ObjectKind::teapot, ObjectKind::statue, ObjectKind::head,
                                         ObjectKind::machine_part, ObjectKind::aircraft, ObjectKind::vase,
                                         ObjectKind::chair, ObjectKind::mug, ObjectKind::apple,
                                         ObjectKind::books));

TEST_P(EveryObject, IsOneClosedOutwardSurfaceOnTheTable) {
  const TriangleMesh mesh = make_object({GetParam(), 1, coarse_enough(GetParam())});
  EXPECT_EQ(problem_of(mesh), "");
  const MeshTopology topology = mesh_topology(mesh);
  EXPECT_TRUE(topology.closed_manifold());
  EXPECT_EQ(topology.components, 1U);
  EXPECT_GT(signed_volume(mesh), 0);
  const BoundingBox box = bounding_box(mesh.vertices);
  EXPECT_NEAR(box.min().z(), 0, 0.002);
  EXPECT_LT(box.center().head<2>().norm(), 0.03);
  EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
  EXPECT_EQ(mesh.colors.size(), mesh.vertices.size());
}

TEST_P(EveryObject, NormalsPointOutwards) {
  const TriangleMesh mesh = make_object({GetParam(), 1, coarse_enough(GetParam())});
  const std::vector<Eigen::Vector3f> from_faces = vertex_normals(mesh);
  std::size_t agree = 0;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) agree += mesh.normals[i].dot(from_faces[i]) > 0.7F;
  // Where edges are sharper than the mesh is fine the two may differ.
  EXPECT_GT(static_cast<double>(agree), 0.9 * static_cast<double>(mesh.normals.size()));
}

TEST(Objects, DetailChangesTheFacesAndNotTheShape) {
  for (const ObjectKind kind : {ObjectKind::teapot, ObjectKind::statue}) {
    const TriangleMesh fine = make_object({kind, 1, 1.6});
    const TriangleMesh rough = make_object({kind, 1, 3.2});
    EXPECT_GT(fine.faces.size(), rough.faces.size() * 5 / 4);
    EXPECT_NEAR(signed_volume(fine) / signed_volume(rough), 1, 0.04);
  }
}

TEST(Objects, ScaleMultipliesLengthsAndKeepsThePaint) {
  const ObjectSpec one{ObjectKind::teapot, 1, coarse};
  const ObjectSpec three{ObjectKind::teapot, 3, coarse};
  const TriangleMesh small = make_object(one);
  const TriangleMesh large = make_object(three);
  ASSERT_EQ(small.faces, large.faces);
  for (std::size_t i = 0; i < small.vertices.size(); i += 7) {
    EXPECT_LT((3 * small.vertices[i] - large.vertices[i]).norm(), 1e-12);
    EXPECT_EQ(object_color(one, small.vertices[i]), small.colors[i]);
  }
}

TEST(Objects, ColoursAreColours) {
  for (const ObjectKind kind : {ObjectKind::teapot, ObjectKind::statue, ObjectKind::head,
                                ObjectKind::machine_part, ObjectKind::aircraft, ObjectKind::vase}) {
    const ObjectSpec spec{kind, 1, coarse_enough(kind)};
    const TriangleMesh mesh = make_object(spec);
    Eigen::Vector3f least = mesh.colors[0];
    Eigen::Vector3f most = mesh.colors[0];
    for (const Eigen::Vector3f& color : mesh.colors) {
      least = least.cwiseMin(color);
      most = most.cwiseMax(color);
    }
    EXPECT_GE(least.minCoeff(), 0);
    EXPECT_LE(most.maxCoeff(), 1);
    EXPECT_GT((most - least).minCoeff(), 0.3F);  // painted, not plain
  }
}

TEST(Teapot, LightPassesThroughTheHandleAndNotThroughTheBody) {
  const RayCaster caster(make_object({ObjectKind::teapot, 1, coarse}));
  EXPECT_FALSE(caster.blocked({-0.078, -1, 0.057}, Vector3d::UnitY()));  // the handle's eye
  EXPECT_TRUE(caster.blocked({-0.100, -1, 0.062}, Vector3d::UnitY()));   // the handle
  EXPECT_TRUE(caster.blocked({0, -1, 0.05}, Vector3d::UnitY()));
  EXPECT_TRUE(caster.blocked({0.095, -1, 0.088}, Vector3d::UnitY()));  // the spout
}

TEST(Statue, IsHollowFromBehind) {
  const RayCaster caster(make_object({ObjectKind::statue, 1, coarse}));
  for (const double height : {0.11, 0.15, 0.2}) {
    const auto front = caster.first_hit({0, -1, height}, Vector3d::UnitY());
    const auto back = caster.first_hit({0, 1, height}, -Vector3d::UnitY());
    ASSERT_TRUE(front && back);
    const double wall = (1 - back->distance) - (front->distance - 1);
    EXPECT_GT(wall, 0.003) << height;
    EXPECT_LT(wall, 0.012) << height;
  }
}

/// Distance of the moved vertices from the surface itself, but for the 5 % where the lattice that the object
/// was meshed on cuts edges differently.
double change(const TriangleMesh& mesh, const Eigen::Matrix3d& motion) {
  std::vector<Vector3d> moved;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 11) moved.emplace_back(motion * mesh.vertices[i]);
  return metrics::surface_distance(moved, mesh).percentile_95;
}

Eigen::Matrix3d turn_about_z(double radians) {
  return Eigen::AngleAxisd(radians, Vector3d::UnitZ()).toRotationMatrix();
}

TEST(Symmetry, WhatAnObjectSaysOfItselfHolds) {
  for (const ObjectKind kind : {ObjectKind::teapot, ObjectKind::head, ObjectKind::machine_part,
                                ObjectKind::vase, ObjectKind::chair}) {
    const TriangleMesh mesh = make_object({kind, 1, coarse_enough(kind)});
    const ObjectSymmetry symmetry = object_symmetry(kind);
    const Vector3d normal = symmetry.mirror.value_or(Vector3d::UnitX());
    const Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity() - 2 * normal * normal.transpose();
    constexpr double tolerance_m = 0.001;  // under half a lattice pitch
    EXPECT_EQ(change(mesh, mirror) < tolerance_m, symmetry.mirror || symmetry.about_z) << object_name(kind);
    EXPECT_EQ(change(mesh, turn_about_z(0.7)) < tolerance_m, symmetry.about_z) << object_name(kind);
  }
}

TEST(MachinePart, LightPassesThroughItsHoles) {
  const RayCaster caster(make_object({ObjectKind::machine_part, 1, 1.8}));
  EXPECT_FALSE(caster.blocked({-0.016, -1, 0.062}, Vector3d::UnitY()));    // the bore
  EXPECT_FALSE(caster.blocked({-0.066, -0.034, 1}, -Vector3d::UnitZ()));   // a bolt
  EXPECT_FALSE(caster.blocked({0.02, 0.036, 1}, -Vector3d::UnitZ()));      // the slot
  EXPECT_FALSE(caster.blocked({-1, 0.027, 0.046}, Vector3d(1, 0.06, 0)));  // the eye
  EXPECT_TRUE(caster.blocked({-0.066, 0.034, 1}, -Vector3d::UnitZ()));     // where the fourth bolt is not
}

TEST(Aircraft, ItsWingsAreThin) {
  const RayCaster caster(make_object({ObjectKind::aircraft, 1, 1.2}));
  for (const double x : {-0.09, 0.09}) {
    const auto above = caster.first_hit({x, -0.014, 1}, -Vector3d::UnitZ());
    const auto below = caster.first_hit({x, -0.014, -1}, Vector3d::UnitZ());
    ASSERT_TRUE(above && below);
    const double thickness = (1 - above->distance) - (below->distance - 1);
    EXPECT_GT(thickness, 0.003);
    EXPECT_LT(thickness, 0.006);
  }
}

}  // namespace
}  // namespace drape::simulation
