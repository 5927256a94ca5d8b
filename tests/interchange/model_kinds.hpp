// One model of every kind that drape writes.
#pragma once

#include <string>
#include <vector>

#include "drape/geometry/textured_mesh.hpp"
#include "drape/io/model_files.hpp"

namespace drape::test {

struct ModelKind {
  std::string name;
  TexturedMesh model;
  io::GlbOptions options;
};

/// Unlit and lit, with normal maps, with and without vertex colours, unseen surface, PNG and JPEG, one
/// material and several, nothing but a mesh.
[[nodiscard]] std::vector<ModelKind> model_kinds();

}  // namespace drape::test
