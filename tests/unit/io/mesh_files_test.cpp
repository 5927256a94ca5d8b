#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>

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

template <class Number>
std::string raw(Number value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  return {bytes.begin(), bytes.end()};
}

std::string ascii_stl(const TriangleMesh& mesh) {
  std::string text = "solid a name\n";
  for (const Face& face : mesh.faces) {
    text += "facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t v : face)
      text += fmt::format("    vertex {} {} {}\n", mesh.vertices[v].x(), mesh.vertices[v].y(),
                          mesh.vertices[v].z());
    text += "  endloop\nendfacet\n";
  }
  return text + "endsolid a name\n";
}

std::string binary_stl(const TriangleMesh& mesh) {
  // Many programs write this word into the header of a binary file.
  std::string bytes = "solid";
  bytes.resize(80, ' ');
  bytes += raw(static_cast<std::uint32_t>(mesh.faces.size()));
  for (const Face& face : mesh.faces) {
    bytes += std::string(12, '\0');
    for (const std::uint32_t v : face)
      for (const double x : mesh.vertices[v]) bytes += raw(static_cast<float>(x));
    bytes += "ab";
  }
  return bytes;
}

TEST(MeshFiles, StlIsWelded) {
  const TriangleMesh torus = test::torus(1, 0.25, 12, 8);
  for (const std::string& bytes : {ascii_stl(torus), binary_stl(torus)}) {
    const TriangleMesh mesh = read("x.stl", bytes);
    EXPECT_EQ(mesh.vertices.size(), torus.vertices.size());
    EXPECT_EQ(mesh.faces.size(), torus.faces.size());
    EXPECT_TRUE(mesh_topology(mesh).closed_manifold());
    EXPECT_NEAR(signed_volume(mesh), signed_volume(torus), 1e-6);
  }
  // -0 and 0 are one place; a facet of no area goes.
  EXPECT_EQ(
      read("x.stl",
           "SOLID\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 "
           "0\nENDLOOP\nENDFACET\n"
           "facet normal 0 0 1\nouter loop\nvertex -0 0 0\nvertex 0 1 0\nvertex -1 0 0\nendloop\nendfacet\n"
           "facet normal 0 0 1\nouter loop\nvertex 5 5 5\nvertex 5 5 5\nvertex 0 1 "
           "0\nendloop\nendfacet\nendsolid\n")
          .vertices.size(),
      4U);
}

TEST(MeshFiles, StlLiesAreNamedWithTheirPlace) {
  const std::string binary = binary_stl(test::box({0, 0, 0}, {1, 1, 1}));
  expect_problem("x.stl", binary + "x", ": byte 80: the STL claims 12 facets");
  expect_problem("x.stl", binary.substr(0, binary.size() - 1), ": byte 80: ");
  expect_problem("x.stl", binary.substr(0, 83), ": ");
  std::string lie = binary;
  lie.replace(80, 4, raw(0xFFFFFFFFU));
  expect_problem("x.stl", lie, ": byte 80: the STL claims 4294967295 facets, which take 214748364834 bytes");
  std::string bad = binary;
  bad.replace(84 + 12, 4, raw(std::numeric_limits<float>::infinity()));
  expect_problem("x.stl", bad, ": byte 84: ");
  const std::string ascii = ascii_stl(test::box({0, 0, 0}, {1, 1, 1}));
  expect_problem("x.stl", ascii.substr(0, ascii.size() - 16), ":85: the STL ends without");
  expect_problem("x.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", ":4: ");
  expect_problem("x.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n", ":5: ");
  expect_problem("x.stl", "solid\nendsolid\n", ": has no faces");
}

TEST(MeshFiles, OffKinds) {
  const std::vector<Face> faces{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}};
  const std::string body = "0 0 0\n1 0 0 # a comment\n1 1 0\n\n0 1 0\n4 0 1 2 3\n3 0 1 2 255 0 0\n";
  EXPECT_EQ(read("x.off", "OFF\n# comment\n4 2 0\n" + body).faces, faces);
  EXPECT_EQ(read("x.off", "OFF 4 2 0\n" + body).faces, faces);
  EXPECT_EQ(read("x.off", "4 2 0\n" + body).faces, faces);
  EXPECT_EQ(read("named.wrongly", "OFF 4 2 0\n" + body).faces, faces);
  const TriangleMesh colored =
      read("x.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 51 255\n3 0 1 2\n");
  EXPECT_EQ(colored.colors.at(2), Eigen::Vector3f(0, 0, 0.2F));
  EXPECT_EQ(read("x.off", "NOFF\n3 1 0\n0 0 0 0 0 2\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n").normals.at(0),
            Eigen::Vector3f(0, 0, 1));
}

TEST(MeshFiles, OffLiesAreNamedWithTheirLine) {
  const std::string body = "0 0 0\n1 0 0\n0 1 0\n";
  expect_problem("x.off", "OFF\n4294967294 1 0\n" + body, ":2: 4294967294 vertices");
  expect_problem("x.off", "OFF\n3 4294967294 0\n" + body, ":2: ");
  expect_problem("x.off", "OFF\n-3 1 0\n" + body, ":2: ");
  expect_problem("x.off", "OFF\n3 1 0\n" + body, ":5: the file ends");
  expect_problem("x.off", "OFF\n3 1 0\n" + body + "3 0 1 3\n", ":6: the face names vertex 3");
  expect_problem("x.off", "OFF\n3 1 0\n" + body + "3 0 1 -1\n", ":6: ");
  expect_problem("x.off", "OFF\n3 1 0\n" + body + "9999999 0 1 2\n", ":6: ");
  expect_problem("x.off", "OFF\n3 1 0\n" + body + "3 0 1\n", ":6: too few");
  expect_problem("x.off", "OFF\n3 1 0\n" + body + "3 0 1 2\n3 0 1 2\n", ":7: data go on");
  expect_problem("x.off", "4OFF\n3 1 0\n" + body, ":1: ");
  expect_problem("x.off", "OFF BINARY\n3 1 0\n" + body, ":1: ");
}

TEST(MeshFiles, AVertexThatIsNotFiniteGoesIfNoFaceUsesIt) {
  const TriangleMesh mesh = read("x.obj", "v 0 0 0\nv nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 4\n");
  EXPECT_EQ(mesh.vertices.size(), 3U);
  EXPECT_EQ(mesh.faces.at(0), (Face{0, 1, 2}));
}

TEST(MeshFiles, RealMeshes) {
  struct Real {
    std::string name;
    std::size_t vertices, faces, loops, borders;
  };
  for (const Real& real :
       {Real{"meshes/bun_zipper.ply", 35947, 69451, 5, 5}, Real{"meshes/Laurana50k.ply", 27861, 49954, 4, 4},
        Real{"meshes/many_small_holes.ply", 2004, 3524, 38, 32},
        Real{"meshes/teapot.obj", 3644, 6320, 48, 10}, Real{"photos/lmo/can.ply", 22831, 45666, 0, 0},
        Real{"meshes/conrod.stl", 0, 6442, 0, 0}}) {
    if (!test::have_data(real.name)) GTEST_SKIP() << "needs " << real.name << " of DRAPE_TEST_DATA";
    const TriangleMesh mesh = io::read_mesh(test::data(real.name));
    if (real.vertices > 0) {
      EXPECT_EQ(mesh.vertices.size(), real.vertices) << real.name;
    }
    EXPECT_EQ(mesh.faces.size(), real.faces) << real.name;
    EXPECT_EQ(problem_of(mesh), "") << real.name;
    if (real.loops > 0) {
      EXPECT_EQ(mesh_topology(mesh).boundary_loops, real.loops) << real.name;
      EXPECT_EQ(mesh_topology(mesh).borders, real.borders) << real.name;
    }
  }
}

}  // namespace
}  // namespace drape
