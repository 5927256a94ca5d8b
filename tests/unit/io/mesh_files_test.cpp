#include <gtest/gtest.h>

#include <cstring>

#include "drape/base/files.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/io/mesh_files.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::ScratchFolder;

TriangleMesh read(const std::string& name, const std::string& bytes) {
  const ScratchFolder folder;
  write_file(folder / name, bytes);
  return io::read_mesh(folder / name);
}

void expect_problem(const std::string& name, const std::string& bytes, const std::string& what) {
  const std::string message = error_message(ErrorCode::input, [&] { (void)read(name, bytes); });
  EXPECT_NE(message.find(name + what), std::string::npos) << message;
}

TEST(MeshFiles, PlyReadsBackToTheSameBits) {
  const ScratchFolder folder;
  TriangleMesh mesh = test::torus(1.0 / 3, 1e-9);
  mesh.faces.push_back({7, 7, 8});  // of no area: kept all the same
  io::write_mesh_ply(folder / "plain.ply", mesh);
  EXPECT_EQ(io::read_mesh(folder / "plain.ply").vertices, mesh.vertices);
  EXPECT_EQ(io::read_mesh(folder / "plain.ply").faces, mesh.faces);
  Rng rng(1);
  const auto random = [&] { return static_cast<float>(rng.uniform()); };
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.normals.emplace_back(random(), random(), random());
    mesh.colors.emplace_back(random(), random(), random());
    mesh.intensities.push_back(random());
    mesh.confidences.push_back(random());
  }
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) mesh.filled.push_back(i % 3 == 0 ? 1 : 0);
  io::write_mesh_ply(folder / "full.ply", mesh);
  const TriangleMesh back = io::read_mesh(folder / "full.ply");
  EXPECT_EQ(back.vertices, mesh.vertices);
  EXPECT_EQ(back.faces, mesh.faces);
  EXPECT_EQ(back.normals, mesh.normals);
  EXPECT_EQ(back.colors, mesh.colors);
  EXPECT_EQ(back.intensities, mesh.intensities);
  EXPECT_EQ(back.confidences, mesh.confidences);
  EXPECT_EQ(back.filled, mesh.filled);
}

TEST(MeshFiles, ObjFacesOfAllKinds) {
  const TriangleMesh mesh =
      read("x.obj",
           "# a comment\r\nmtllib nothing.mtl\no thing\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\n"
           "v 0 1 0 1 1 1\nvt 0 0\nvn 0 0 2\nusemtl red\nf 1 2/1 3/1/1 4//1\nf -4 \\\n -3 -2 # end\n");
  ASSERT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.faces, (std::vector<Face>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(mesh.colors.at(1), Eigen::Vector3f(0, 1, 0));
  EXPECT_TRUE(mesh.normals.empty());  // not every corner has one
}

TEST(MeshFiles, ObjNormalsWhereEachVertexHasOne) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nvn 0 0 2\nvn 1 0 0\n";
  EXPECT_EQ(read("x.obj", vertices + "f 1//1 2//1 3//2\n").normals.at(1), Eigen::Vector3f(0, 0, 1));
  EXPECT_TRUE(read("x.obj", vertices + "f 1//1 2//1 3//1\nf 1//2 3//1 2//1\n").normals.empty());
}

TEST(MeshFiles, ObjLiesAreNamedWithTheirLine) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_problem("x.obj", "", ": is empty");
  expect_problem("x.obj", "# nothing\n", ": holds no vertex");
  expect_problem("x.obj", vertices, ": has no faces");
  expect_problem("x.obj", vertices + "f 1 2 999999//1\n", ":4: ");
  expect_problem("x.obj", vertices + "f 1 2 4\n", ":4: the face names vertex 4");
  expect_problem("x.obj", vertices + "f 1 2 -4\n", ":4: ");
  expect_problem("x.obj", vertices + "f 1 2 0\n", ":4: ");
  expect_problem("x.obj", vertices + "f 1 2 99999999999999999999\n", ":4: ");
  expect_problem("x.obj", vertices + "f 1 2 3//1\n", ":4: the face names normal 1");
  expect_problem("x.obj", vertices + "f 1 2 3/x\n", ":4: ");
  expect_problem("x.obj", vertices + "f 1 2 /\n", ":4: ");
  expect_problem("x.obj", "v 0 0\n", ":1: too few");
  expect_problem("x.obj", "v 0 0 1,5\n", ":1: ");
  expect_problem("x.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ":4: the face uses vertex 1");
  expect_problem("x.obj", vertices + std::string("\0\0\0\n", 4), ":4: ");
  expect_problem("x.xyz", "hello", ": is no mesh format");
  const ScratchFolder folder;
  EXPECT_NE(error_message(ErrorCode::input, [&] { (void)io::read_mesh(folder.path()); }).find("is a folder"),
            std::string::npos);
}

TEST(MeshFiles, AVertexThatIsNotFiniteGoesIfNoFaceUsesIt) {
  const TriangleMesh mesh = read("x.obj", "v 0 0 0\nv nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 4\n");
  EXPECT_EQ(mesh.vertices.size(), 3U);
  EXPECT_EQ(mesh.faces.at(0), (Face{0, 1, 2}));
}

TEST(MeshFiles, RealMeshes) {
  struct Real {
    std::string name;
    std::size_t vertices, faces,
        loops;  // 0: holes touch each other, so that their number is a matter of taste
  };
  for (const Real& real :
       {Real{"meshes/bun_zipper.ply", 35947, 69451, 5}, Real{"meshes/Laurana50k.ply", 27861, 49954, 4},
        Real{"meshes/many_small_holes.ply", 2004, 3524, 0}, Real{"meshes/teapot.obj", 3644, 6320, 0},
        Real{"photos/lmo/can.ply", 22831, 45666, 0}}) {
    if (!test::have_data(real.name)) GTEST_SKIP() << "needs " << real.name << " of DRAPE_TEST_DATA";
    const TriangleMesh mesh = io::read_mesh(test::data(real.name));
    EXPECT_EQ(mesh.vertices.size(), real.vertices) << real.name;
    EXPECT_EQ(mesh.faces.size(), real.faces) << real.name;
    EXPECT_EQ(problem_of(mesh), "") << real.name;
    if (real.loops > 0) {
      EXPECT_EQ(mesh_topology(mesh).boundary_loops, real.loops) << real.name;
    }
  }
}

}  // namespace
}  // namespace drape
