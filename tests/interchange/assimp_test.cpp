// What assimp, which shares nothing with drape, reads from the files that drape writes.
#include <gtest/gtest.h>

#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <vector>

#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "model_kinds.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

// A corner of a face: where it is, and what its texture shows there (v upwards, as assimp has it).
using Corner = std::array<double, 5>;

std::vector<Corner> corners_of(const aiScene& scene) {
  std::vector<Corner> corners;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k) {
        const unsigned v = mesh.mFaces[f].mIndices[k];
        const aiVector3D x = mesh.mVertices[v];
        const aiVector3D uv = mesh.HasTextureCoords(0) ? mesh.mTextureCoords[0][v] : aiVector3D();
        corners.push_back({x.x, x.y, x.z, uv.x, uv.y});
      }
  }
  return corners;
}

std::vector<Corner> corners_of(const TexturedMesh& model, bool textured) {
  std::vector<Corner> corners;
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& x = model.mesh.vertices[model.mesh.faces[f][k]];
      const bool picture = textured && !model.materials[model.face_materials[f]].image.empty();
      const Eigen::Vector2f uv = model.corner_uvs[f][k];
      corners.push_back({x.x(), x.y(), x.z(), picture ? uv.x() : 0.0, picture ? 1.0 - uv.y() : 0.0});
    }
  return corners;
}

// Readers may order faces and vertices as they like: every corner has its like.
void expect_same(std::vector<Corner> read, std::vector<Corner> written) {
  ASSERT_EQ(read.size(), written.size());
  const auto rounded = [](std::vector<Corner>& corners) {
    for (Corner& corner : corners)
      for (double& value : corner) value = std::round(value * 1e4);
    std::sort(corners.begin(), corners.end());
  };
  rounded(read);
  rounded(written);
  std::size_t apart = 0;
  for (std::size_t i = 0; i < read.size(); ++i)
    for (std::size_t k = 0; k < 5; ++k) apart += std::abs(read[i][k] - written[i][k]) > 1 ? 1 : 0;
  EXPECT_EQ(apart, 0U);
}

std::size_t pictures_of(const TexturedMesh& model) {
  return static_cast<std::size_t>(std::count_if(model.materials.begin(), model.materials.end(),
                                                [](const Material& m) { return !m.image.empty(); }));
}

TEST(Assimp, ReadsEveryKindOfGlb) {
  const ScratchFolder folder;
  for (const ModelKind& kind : model_kinds()) {
    const auto file = folder / (kind.name + ".glb");
    io::write_glb(file, kind.model, Eigen::Affine3d::Identity(), {0, 0, 0}, kind.options);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure);
    ASSERT_NE(scene, nullptr) << kind.name << ": " << importer.GetErrorString();
    SCOPED_TRACE(kind.name);
    expect_same(corners_of(*scene), corners_of(kind.model, true));
    std::size_t with_picture = 0;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
      aiString name;
      if (scene->mMaterials[scene->mMeshes[m]->mMaterialIndex]->GetTexture(aiTextureType_BASE_COLOR, 0,
                                                                           &name) == aiReturn_SUCCESS) {
        ++with_picture;
        EXPECT_NE(scene->GetEmbeddedTexture(name.C_Str()), nullptr);
      }
    }
    EXPECT_EQ(with_picture, pictures_of(kind.model));
  }
}

TEST(Assimp, ReadsObjWithItsMaterials) {
  const ScratchFolder folder;
  for (const ModelKind& kind : model_kinds()) {
    (void)io::write_obj(folder / "model.obj", kind.model);
    Assimp::Importer importer;
    const aiScene* scene =
        importer.ReadFile((folder / "model.obj").string(), aiProcess_ValidateDataStructure);
    ASSERT_NE(scene, nullptr) << kind.name << ": " << importer.GetErrorString();
    SCOPED_TRACE(kind.name);
    expect_same(corners_of(*scene), corners_of(kind.model, true));
    std::size_t with_picture = 0;
    for (unsigned m = 0; m < scene->mNumMaterials; ++m) {
      aiString name;
      if (scene->mMaterials[m]->GetTexture(aiTextureType_DIFFUSE, 0, &name) != aiReturn_SUCCESS) continue;
      ++with_picture;
      EXPECT_EQ(
          io::read_photo(folder / name.C_Str()).rgb,
          std::find_if(kind.model.materials.begin(), kind.model.materials.end(), [&](const Material& known) {
            return std::string(name.C_Str()).find(known.name + ".png") != std::string::npos;
          })->image);
    }
    EXPECT_EQ(with_picture, pictures_of(kind.model));
  }
}

TEST(Assimp, ReadsStlAndPly) {
  const ScratchFolder folder;
  const ModelKind kind = model_kinds().front();
  io::write_stl(folder / "model.stl", kind.model.mesh);
  io::write_mesh_ply(folder / "model.ply", io::with_vertex_colors(kind.model));
  for (const char* name : {"model.stl", "model.ply"}) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile((folder / name).string(), aiProcess_ValidateDataStructure);
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    SCOPED_TRACE(name);
    expect_same(corners_of(*scene), corners_of(kind.model, false));
    EXPECT_EQ(scene->mMeshes[0]->HasVertexColors(0), std::string(name) == "model.ply");
  }
}

}  // namespace
}  // namespace drape::test
