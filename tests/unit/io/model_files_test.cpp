#include "drape/io/model_files.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "gltf_check.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::ScratchFolder;

Image8 picture(int width, int height, std::uint8_t red) {
  Image8 image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.at(x, y, 0) = red;
      image.at(x, y, 1) = static_cast<std::uint8_t>(x * 255 / width);
      image.at(x, y, 2) = static_cast<std::uint8_t>(y * 255 / height);
    }
  return image;
}

/// A torus: faces whose centre has x > 0 show picture a, those with y > 0 of the others picture b, the rest
/// is flat. (u, v) is a planar projection per material, so that corners differ only between materials.
TexturedMesh model() {
  TexturedMesh model;
  model.mesh = test::torus(1, 0.3, 24, 12);
  model.mesh.normals = vertex_normals(model.mesh);
  for (const Eigen::Vector3d& v : model.mesh.vertices)
    model.mesh.colors.emplace_back(static_cast<float>(std::lround((v.x() + 2) * 60)) / 255.0F, 0.2F, 1.0F);
  model.materials = {{"a", picture(16, 8, 10), Eigen::Vector3f::Ones()},
                     {"b_2", picture(5, 7, 200), Eigen::Vector3f::Ones()},
                     {"unseen", {}, Eigen::Vector3f(0.5F, 0.25F, 1.0F)}};
  for (const Face& face : model.mesh.faces) {
    const Eigen::Vector3d center =
        (model.mesh.vertices[face[0]] + model.mesh.vertices[face[1]] + model.mesh.vertices[face[2]]) / 3;
    const std::uint32_t m = center.x() > 0 ? 0 : center.y() > 0 ? 1 : 2;
    model.face_materials.push_back(m);
    std::array<Eigen::Vector2f, 3> uvs;
    for (std::size_t k = 0; k < 3; ++k)
      uvs[k] =
          m == 2
              ? Eigen::Vector2f(0, 0)
              : Eigen::Vector2f((model.mesh.vertices[face[k]].head<2>().cast<float>().array() + 1.5F) / 3.0F);
    model.corner_uvs.push_back(uvs);
  }
  return model;
}

/// +Y up from +z up, and a shift.
Eigen::Affine3d y_up() {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return Eigen::Translation3d(0.5, 0, -7) * transform;
}

TEST(Glb, KeepsTheRulesAndTheModel) {
  const ScratchFolder folder;
  const TexturedMesh m = model();
  for (const bool jpeg : {false, true}) {
    io::GlbOptions options;
    options.jpeg_textures = jpeg;
    options.unlit = jpeg;
    io::write_glb(folder / "x.glb", m, y_up(), {1e6, 2, 3}, options);
    EXPECT_EQ(test::gltf_problems(folder / "x.glb"), std::vector<std::string>{});
    const test::GltfModel glb = test::read_gltf(folder / "x.glb");
    EXPECT_EQ(glb.origin, (std::vector<double>{1e6, 2, 3}));
    ASSERT_EQ(glb.primitives.size(), 3U);
    for (std::uint32_t i = 0; i < 3; ++i) {
      const test::GltfPrimitive& p = glb.primitives[i];
      EXPECT_EQ(p.unlit, jpeg);
      EXPECT_EQ(p.material, m.materials[i].name);
      std::size_t at = 0;
      std::set<std::uint32_t> vertices;
      for (std::size_t f = 0; f < m.mesh.faces.size(); ++f) {
        if (m.face_materials[f] != i) continue;
        for (std::size_t k = 0; k < 3; ++k, ++at) {
          ASSERT_LT(at, p.indices.size());
          const std::uint32_t v = p.indices[at];
          vertices.insert(m.mesh.faces[f][k]);
          EXPECT_EQ(p.positions[v], (y_up() * m.mesh.vertices[m.mesh.faces[f][k]]).cast<float>());
          EXPECT_LT((p.normals[v] -
                     (y_up().linear() * m.mesh.normals[m.mesh.faces[f][k]].cast<double>()).cast<float>())
                        .norm(),
                    1e-6F);
          if (i < 2) {
            EXPECT_EQ(p.uvs[v], m.corner_uvs[f][k]);
          }
        }
      }
      EXPECT_EQ(at, p.indices.size());
      EXPECT_EQ(p.positions.size(), vertices.size()) << "no vertex is split without need";
      EXPECT_EQ(p.colors.empty(), i < 2);
      EXPECT_EQ(p.uvs.empty(), i == 2);
      EXPECT_EQ(p.image.empty(), i == 2);
      if (i < 2) {
        write_file(folder / "image", p.image);
        const Image8 image = io::read_photo(folder / "image").rgb;
        EXPECT_EQ(image.width(), m.materials[i].image.width());
        if (!jpeg) {
          EXPECT_EQ(image, m.materials[i].image);
        }
      }
    }
    // sRGB 0.5 is 0.21404 in linear light (IEC 61966-2-1).
    EXPECT_NEAR(glb.primitives[2].base_color.x(), 0.21404, 1e-5);
    EXPECT_NEAR(glb.primitives[2].base_color.y(), 0.05088, 1e-5);
    EXPECT_EQ(glb.primitives[2].base_color.z(), 1.0F);
    EXPECT_NEAR(glb.primitives[2].colors[0].y(), 0.03310, 1e-5);
  }
}

TEST(Glb, VerticesAreSplitOnlyWhereCornersDiffer) {
  const ScratchFolder folder;
  TexturedMesh m;
  m.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  m.mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  m.materials = {{"p", picture(4, 4, 0), Eigen::Vector3f::Ones()}};
  m.face_materials = {0, 0};
  const Eigen::Vector2f a(0, 0), b(1, 0), c(1, 1), d(0, 1), other(0.5F, 0.5F);
  m.corner_uvs = {{a, b, c}, {a, c, d}};
  io::write_glb(folder / "x.glb", m, Eigen::Affine3d::Identity(), {0, 0, 0});
  EXPECT_EQ(test::read_gltf(folder / "x.glb").primitives.at(0).positions.size(), 4U);
  m.corner_uvs = {{a, b, c}, {a, other, d}};
  io::write_glb(folder / "x.glb", m, Eigen::Affine3d::Identity(), {0, 0, 0});
  EXPECT_EQ(test::gltf_problems(folder / "x.glb"), std::vector<std::string>{});
  EXPECT_EQ(test::read_gltf(folder / "x.glb").primitives.at(0).positions.size(), 5U);
}

TEST(Glb, AMirroringTransformKeepsTheOutside) {
  const ScratchFolder folder;
  TexturedMesh m = model();
  m.mesh.normals.clear();
  Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
  mirror.linear() = Eigen::Vector3d(1, 1, -2).asDiagonal();
  io::write_glb(folder / "x.glb", m, mirror, {0, 0, 0});
  EXPECT_EQ(test::gltf_problems(folder / "x.glb"), std::vector<std::string>{});
  for (const test::GltfPrimitive& p : test::read_gltf(folder / "x.glb").primitives)
    for (std::size_t i = 0; i < p.indices.size(); i += 3) {
      const Eigen::Vector3f x = p.positions[p.indices[i]], y = p.positions[p.indices[i + 1]],
                            z = p.positions[p.indices[i + 2]];
      EXPECT_GT((y - x).cross(z - x).dot(p.normals[p.indices[i]]), 0);
    }
}

TEST(Glb, BadModelsAreRefused) {
  const ScratchFolder folder;
  const auto problem = [&](auto spoil) {
    TexturedMesh m = model();
    spoil(m);
    const std::string message = error_message(ErrorCode::input, [&] {
      io::write_glb(folder / "x.glb", m, Eigen::Affine3d::Identity(), {0, 0, 0});
    });
    EXPECT_FALSE(std::filesystem::exists(folder / "x.glb"));
    EXPECT_FALSE(error_message(ErrorCode::input, [&] { (void)io::write_obj(folder / "x.obj", m); }).empty());
    return message;
  };
  EXPECT_NE(problem([](TexturedMesh& m) { m = TexturedMesh(); }).find("no faces"), std::string::npos);
  EXPECT_NE(problem([](TexturedMesh& m) { m.face_materials[3] = 9; }).find("face 3"), std::string::npos);
  EXPECT_NE(problem([](TexturedMesh& m) { m.corner_uvs[5][1].x() = NAN; }).find("face 5"), std::string::npos);
  EXPECT_NE(problem([](TexturedMesh& m) { m.mesh.faces[0][0] = 99999; }).find("99999"), std::string::npos);
  EXPECT_NE(problem([](TexturedMesh& m) { m.materials[0].name = "../x"; }).find("name"), std::string::npos);
  EXPECT_NE(problem([](TexturedMesh& m) { m.materials[1].name = "a"; }).find("two materials"),
            std::string::npos);
}

TEST(GltfCheck, SeesWhatIsBroken) {
  const ScratchFolder folder;
  io::write_glb(folder / "x.glb", model(), y_up(), {0, 0, 0});
  const std::string good = read_file(folder / "x.glb");
  const auto problems = [&](const std::string& bytes) {
    std::filesystem::remove(folder / "y.glb");
    write_file(folder / "y.glb", bytes);
    return test::gltf_problems(folder / "y.glb");
  };
  EXPECT_TRUE(problems(good).empty());
  const auto replaced = [&](const std::string& from, const std::string& to) {
    EXPECT_EQ(from.size(), to.size());
    std::string bytes = good;
    const std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return bytes.replace(at, from.size(), to);
  };
  for (const auto& [from, to] :
       std::map<std::string, std::string>{{"glTF", "glTG"},
                                          {"\"2.0\"", "\"2.1\""},
                                          {"\"POSITION\":0", "\"POSITION\":9"},
                                          {"\"VEC2\"", "\"VEC9\""},
                                          {"\"min\":[", "\"mix\":["},
                                          {"\"image/png\"", "\"image/gif\""},
                                          {"\"TEXCOORD_0\"", "\"TEXCOORD_7\""},
                                          {"5126", "5122"},
                                          {"\"metallicFactor\":0", "\"metallicFactor\":7"}})
    EXPECT_FALSE(problems(replaced(from, to)).empty()) << from;
  for (std::size_t size = 0; size < good.size(); size += 97)
    EXPECT_FALSE(problems(good.substr(0, size)).empty()) << size;
  EXPECT_FALSE(problems(good + "    ").empty());
}

TEST(Obj, ReadsBackWithPicturesBesideIt) {
  const ScratchFolder folder;
  const TexturedMesh m = model();
  const auto written = io::write_obj(folder / "my model.obj", m);
  ASSERT_EQ(written.size(), 4U);
  EXPECT_EQ(written[0].filename(), "my model.obj");
  EXPECT_EQ(written[1].filename(), "my_model.mtl");
  EXPECT_EQ(written[2].filename(), "my_model_a.png");
  EXPECT_EQ(written[3].filename(), "my_model_b_2.png");
  for (const auto& file : written) EXPECT_TRUE(std::filesystem::exists(file)) << file;
  EXPECT_EQ(io::read_photo(written[2]).rgb, m.materials[0].image);
  const std::string mtl = read_file(written[1]);
  EXPECT_NE(mtl.find("newmtl a\n"), std::string::npos);
  EXPECT_NE(mtl.find("map_Kd my_model_a.png\n"), std::string::npos);
  EXPECT_NE(mtl.find("Kd 0.5 0.25 1\n"), std::string::npos);
  EXPECT_EQ(mtl.find("Tr "), std::string::npos);
  const TriangleMesh back = io::read_mesh(written[0]);
  EXPECT_EQ(back.vertices, m.mesh.vertices);
  EXPECT_EQ(back.faces.size(), m.mesh.faces.size());
  EXPECT_EQ(back.colors, m.mesh.colors);
  ASSERT_EQ(back.normals.size(), m.mesh.normals.size());
  for (std::size_t i = 0; i < back.normals.size(); ++i)
    EXPECT_LT((back.normals[i] - m.mesh.normals[i]).norm(), 1e-6F);
  const std::string text = read_file(written[0]);
  EXPECT_NE(text.find("mtllib my_model.mtl\n"), std::string::npos);
  EXPECT_EQ(text.find('\r'), std::string::npos);
  // v is counted from the bottom.
  const std::size_t vt = text.find("vt ");
  const std::size_t first = static_cast<std::size_t>(
      std::find(m.face_materials.begin(), m.face_materials.end(), 0U) - m.face_materials.begin());
  const double v = std::stod(text.substr(text.find(' ', vt + 3)));
  EXPECT_NEAR(v, 1 - m.corner_uvs[first][0].y(), 1e-7);
}

TEST(Obj, PicturesOfSixteenBitsAreTiffs) {
  const ScratchFolder folder;
  TexturedMesh m = model();
  Image16 deep = deep_from_bytes(m.materials[0].image);
  for (std::size_t i = 0; i < deep.data().size(); ++i)  // what bytes do not hold
    deep.data()[i] = static_cast<std::uint16_t>(std::min<std::size_t>(65535, deep.data()[i] + i % 97));
  m.materials[0].deep_image = deep;
  m.materials[0].image = bytes_from_deep(deep);
  const auto written = io::write_obj(folder / "m.obj", m);
  ASSERT_EQ(written.size(), 4U);
  EXPECT_EQ(written[2].filename(), "m_a.tif");
  EXPECT_EQ(written[3].filename(), "m_b_2.png");
  EXPECT_NE(read_file(written[1]).find("map_Kd m_a.tif\n"), std::string::npos);
  io::write_textured_ply(folder / "m.ply", m, {"m_a.tif", "m_b_2.png", ""});
  const TexturedMesh back = io::read_textured_ply(folder / "m.ply", {});
  EXPECT_EQ(back.materials[0].deep_image, deep);
  EXPECT_EQ(back.materials[0].image, m.materials[0].image);
  EXPECT_TRUE(back.materials[1].deep_image.empty());
}

TEST(TexturedPly, ReadsBack) {
  const ScratchFolder folder;
  TexturedMesh m = model();
  for (std::size_t f = 0; f < m.mesh.faces.size(); ++f) m.mesh.filled.push_back(f % 5 == 0 ? 1 : 0);
  make_folder(folder / "pictures");
  io::write_image(folder / "pictures/one.png", m.materials[0].image);
  io::write_image(folder / "pictures/two.png", m.materials[1].image);
  io::write_textured_ply(folder / "x.ply", m, {"one.png", "two.png", ""});
  const TexturedMesh back = io::read_textured_ply(folder / "x.ply", folder / "pictures");
  EXPECT_EQ(back.mesh.vertices, m.mesh.vertices);
  EXPECT_EQ(back.mesh.faces, m.mesh.faces);
  EXPECT_EQ(back.mesh.normals, m.mesh.normals);
  EXPECT_EQ(back.mesh.colors, m.mesh.colors);
  EXPECT_EQ(back.mesh.filled, m.mesh.filled);
  EXPECT_EQ(back.face_materials, m.face_materials);
  ASSERT_EQ(back.materials.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.materials[i].name, m.materials[i].name);
    EXPECT_EQ(back.materials[i].image, m.materials[i].image);
    EXPECT_EQ(back.materials[i].flat_color, m.materials[i].flat_color);
  }
  for (std::size_t f = 0; f < m.corner_uvs.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(back.corner_uvs[f][k].x(), m.corner_uvs[f][k].x());
      // 1 - v in float32 is good to half its last place.
      EXPECT_NEAR(back.corner_uvs[f][k].y(), m.corner_uvs[f][k].y(), std::ldexp(1.0, -24));
    }
  EXPECT_EQ(io::read_mesh(folder / "x.ply").faces, m.mesh.faces);
}

TEST(TexturedPly, WithoutFlatFacesThereAreNoVertexColors) {
  const ScratchFolder folder;
  TexturedMesh m = model();
  for (std::uint32_t& material : m.face_materials) material = 0;
  io::write_image(folder / "one.png", m.materials[0].image);
  io::write_image(folder / "two.png", m.materials[1].image);
  io::write_textured_ply(folder / "x.ply", m, {"one.png", "two.png", ""});
  const TexturedMesh back = io::read_textured_ply(folder / "x.ply", {});
  EXPECT_TRUE(back.mesh.colors.empty());
  EXPECT_EQ(back.materials.size(), 3U);
}

TEST(TexturedPly, PicturesStayInTheFolderAndLiesAreNamed) {
  const ScratchFolder folder;
  io::write_image(folder / "one.png", picture(4, 4, 0));
  const auto problem = [&](const std::string& picture_file, const std::string& face) {
    write_file(
        folder / "x.ply",
        "ply\nformat ascii 1.0\ncomment TextureFile " + picture_file +
            "\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int "
            "texnumber\n"
            "end_header\n0 0 0\n1 0 0\n0 1 0\n" +
            face + "\n");
    return error_message(ErrorCode::input, [&] { (void)io::read_textured_ply(folder / "x.ply", {}); });
  };
  const std::string good = "3 0 1 2 6 0 0 1 0 0 1 0";
  EXPECT_NE(problem("/etc/passwd", good).find("does not lie beside it"), std::string::npos);
  EXPECT_NE(problem("../one.png", good).find("does not lie beside it"), std::string::npos);
  EXPECT_NE(problem("none.png", good).find("none.png: no such file"), std::string::npos);
  EXPECT_NE(problem("one.png", "3 0 1 2 8 0 0 1 0 0 1 0 0 0").find("x.ply:16: "), std::string::npos);
  EXPECT_NE(problem("one.png", "3 0 1 2 6 0 0 1 0 0 1 1").find("x.ply:16: "), std::string::npos);
  EXPECT_NE(problem("one.png", "3 0 1 2 6 0 0 1 0 0 1 -1").find("x.ply:16: "), std::string::npos);
}

TEST(VertexColors, AreWhatTheTexturesShow) {
  TexturedMesh m = model();
  m.materials[0].image = Image8(4, 4, 3, 77);
  m.materials[1].image = Image8(4, 4, 3, 77);
  m.materials[2].flat_color = Eigen::Vector3f::Ones();
  for (Eigen::Vector3f& c : m.mesh.colors) c = Eigen::Vector3f::Constant(77 / 255.F);
  const TriangleMesh colored = io::with_vertex_colors(m);
  ASSERT_EQ(colored.colors.size(), m.mesh.vertices.size());
  for (const Eigen::Vector3f& c : colored.colors)
    EXPECT_LT((c - Eigen::Vector3f::Constant(77 / 255.F)).norm(), 1e-4F);
  m.materials[0].image = Image8(4, 4, 3, 255);  // where x > 0
  const TriangleMesh other = io::with_vertex_colors(m);
  for (std::size_t v = 0; v < other.colors.size(); ++v) {
    const double x = m.mesh.vertices[v].x();
    if (x > 0.3) {
      EXPECT_GT(other.colors[v].x(), 0.99F);
    }
    if (x < -0.3) {
      EXPECT_LT(other.colors[v].x(), 0.4F);
    }
  }
}

}  // namespace
}  // namespace drape
