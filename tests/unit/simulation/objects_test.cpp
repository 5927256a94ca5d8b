#include "drape/simulation/objects.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/geometry/ray_caster.hpp"
#include "drape/metrics/surface_distance.hpp"

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

void expect_closed_outward_and_on_the_table(const TriangleMesh& mesh) {
  EXPECT_EQ(problem_of(mesh), "");
  const MeshTopology topology = mesh_topology(mesh);
  EXPECT_TRUE(topology.closed_manifold());
  EXPECT_EQ(topology.components, 1U);
  EXPECT_GT(signed_volume(mesh), 0);
  const BoundingBox box = bounding_box(mesh.vertices);
  EXPECT_NEAR(box.min().z(), 0, 0.002);
  EXPECT_LT(box.center().head<2>().norm(), 0.03);
}

void expect_normals_outwards(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  const std::vector<Eigen::Vector3f> from_faces = vertex_normals(mesh);
  std::size_t agree = 0;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) agree += mesh.normals[i].dot(from_faces[i]) > 0.7F;
  // Where edges are sharper than the mesh is fine the two may differ.
  EXPECT_GT(static_cast<double>(agree), 0.9 * static_cast<double>(mesh.normals.size()));
}

void expect_colours(const TriangleMesh& mesh, bool painted) {
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
  Eigen::Vector3f least = mesh.colors[0];
  Eigen::Vector3f most = mesh.colors[0];
  for (const Eigen::Vector3f& color : mesh.colors) {
    least = least.cwiseMin(color);
    most = most.cwiseMax(color);
  }
  EXPECT_GE(least.minCoeff(), 0);
  EXPECT_LE(most.maxCoeff(), 1);
  if (painted) {
    EXPECT_GT((most - least).minCoeff(), 0.3F);
  }
}

/// Distance of the moved vertices from the surface itself, but for the 5 % where the lattice that the object
/// was meshed on cuts edges differently.
double change(const TriangleMesh& mesh, const Eigen::Matrix3d& motion) {
  std::vector<Vector3d> moved;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 11) moved.emplace_back(motion * mesh.vertices[i]);
  return metrics::surface_distance(moved, mesh).percentile_95;
}

void expect_symmetry_as_said(const TriangleMesh& mesh, const ObjectSymmetry& symmetry) {
  const Vector3d normal = symmetry.mirror.value_or(Vector3d::UnitX());
  const Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity() - 2 * normal * normal.transpose();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()).toRotationMatrix();
  constexpr double tolerance_m = 0.001;  // under half a lattice pitch
  EXPECT_EQ(change(mesh, mirror) < tolerance_m, symmetry.mirror || symmetry.about_z);
  EXPECT_EQ(change(mesh, turn) < tolerance_m, symmetry.about_z);
}

void expect_light_past_the_handle(const RayCaster& teapot) {
  EXPECT_FALSE(teapot.blocked({-0.078, -1, 0.057}, Vector3d::UnitY()));  // the handle's eye
  EXPECT_TRUE(teapot.blocked({-0.100, -1, 0.062}, Vector3d::UnitY()));   // the handle
  EXPECT_TRUE(teapot.blocked({0, -1, 0.05}, Vector3d::UnitY()));
  EXPECT_TRUE(teapot.blocked({0.095, -1, 0.088}, Vector3d::UnitY()));  // the spout
}

void expect_hollow_from_behind(const RayCaster& statue) {
  for (const double height : {0.11, 0.15, 0.2}) {
    const auto front = statue.first_hit({0, -1, height}, Vector3d::UnitY());
    const auto back = statue.first_hit({0, 1, height}, -Vector3d::UnitY());
    ASSERT_TRUE(front && back);
    const double wall = (1 - back->distance) - (front->distance - 1);
    EXPECT_GT(wall, 0.003) << height;
    EXPECT_LT(wall, 0.012) << height;
  }
}

void expect_light_through_the_holes(const RayCaster& machine_part) {
  EXPECT_FALSE(machine_part.blocked({-0.016, -1, 0.062}, Vector3d::UnitY()));    // the bore
  EXPECT_FALSE(machine_part.blocked({-0.066, -0.034, 1}, -Vector3d::UnitZ()));   // a bolt
  EXPECT_FALSE(machine_part.blocked({0.02, 0.036, 1}, -Vector3d::UnitZ()));      // the slot
  EXPECT_FALSE(machine_part.blocked({-1, 0.027, 0.046}, Vector3d(1, 0.06, 0)));  // the eye
  EXPECT_TRUE(machine_part.blocked({-0.066, 0.034, 1}, -Vector3d::UnitZ()));     // no fourth bolt
}

void expect_thin_wings(const RayCaster& aircraft) {
  for (const double x : {-0.09, 0.09}) {
    const auto above = aircraft.first_hit({x, -0.014, 1}, -Vector3d::UnitZ());
    const auto below = aircraft.first_hit({x, -0.014, -1}, Vector3d::UnitZ());
    ASSERT_TRUE(above && below);
    const double thickness = (1 - above->distance) - (below->distance - 1);
    EXPECT_GT(thickness, 0.003);
    EXPECT_LT(thickness, 0.006);
  }
}

bool is_clutter(ObjectKind kind) {
  return kind == ObjectKind::mug || kind == ObjectKind::apple || kind == ObjectKind::books;
}

class EveryObject : public testing::TestWithParam<ObjectKind> {};
INSTANTIATE_TEST_SUITE_P(Objects, EveryObject,
                         testing::Values(ObjectKind::teapot, ObjectKind::statue, ObjectKind::head,
                                         ObjectKind::machine_part, ObjectKind::aircraft, ObjectKind::vase,
                                         ObjectKind::chair, ObjectKind::mug, ObjectKind::apple,
                                         ObjectKind::books),
                         [](const auto& test) { return object_name(test.param); });

// One test an object, since meshing it takes longer than all that is then looked at.
TEST_P(EveryObject, IsAClosedPaintedSolidOfTheShapeItShouldHave) {
  const ObjectKind kind = GetParam();
  const TriangleMesh mesh = make_object({kind, 1, coarse_enough(kind)});
  expect_closed_outward_and_on_the_table(mesh);
  expect_normals_outwards(mesh);
  expect_colours(mesh, !is_clutter(kind) && kind != ObjectKind::chair);
  if (kind == ObjectKind::teapot || kind == ObjectKind::head || kind == ObjectKind::machine_part ||
      kind == ObjectKind::vase || kind == ObjectKind::chair)
    expect_symmetry_as_said(mesh, object_symmetry(kind));
  const RayCaster caster(mesh);
  if (kind == ObjectKind::teapot) expect_light_past_the_handle(caster);
  if (kind == ObjectKind::statue) expect_hollow_from_behind(caster);
  if (kind == ObjectKind::machine_part) expect_light_through_the_holes(caster);
  if (kind == ObjectKind::aircraft) expect_thin_wings(caster);
}

TEST(Objects, DetailChangesTheFacesAndNotTheShape) {
  const TriangleMesh fine = make_object({ObjectKind::teapot, 1, 2});
  const TriangleMesh rough = make_object({ObjectKind::teapot, 1, 3.2});
  EXPECT_GT(fine.faces.size(), rough.faces.size() * 5 / 4);
  EXPECT_NEAR(signed_volume(fine) / signed_volume(rough), 1, 0.04);
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

}  // namespace
}  // namespace drape::simulation
