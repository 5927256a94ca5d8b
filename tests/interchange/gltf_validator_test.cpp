// GLB files under the Khronos glTF validator, which shares nothing with drape.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "drape/base/files.hpp"
#include "gltf_check.hpp"
#include "model_kinds.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;

fs::path validator() {
  return source("tests/interchange/validator");
}

std::string missing() {
  if (!fs::exists(validator() / "node_modules/gltf-validator"))
    return "needs the glTF validator: npm ci --prefix tests/interchange/validator";
  if (std::system("node --version >/dev/null 2>&1") != 0) return "needs node";
  return {};
}

struct Verdict {
  bool valid = false;
  std::string messages;
};
Verdict validated(const fs::path& folder) {
  std::string command = "node '" + (validator() / "validate.js").string() + "'";
  for (const auto& entry : fs::directory_iterator(folder)) command += " '" + entry.path().string() + "'";
  Verdict verdict;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return verdict;
  std::array<char, 4096> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) verdict.messages += part.data();
  verdict.valid = pclose(pipe) == 0;
  return verdict;
}

// Y up from z up, and a shift.
Eigen::Affine3d y_up() {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return Eigen::Translation3d(0.5, 0, -7) * transform;
}

TEST(GltfValidator, PassesEveryKindWithoutErrorOrWarning) {
  if (const std::string why = missing(); !why.empty()) GTEST_SKIP() << why;
  const ScratchFolder folder;
  for (const ModelKind& kind : model_kinds())
    io::write_glb(folder / (kind.name + ".glb"), kind.model, y_up(), {1e6, 2, 3}, kind.options);
  const Verdict verdict = validated(folder.path());
  EXPECT_TRUE(verdict.valid) << verdict.messages;
  EXPECT_EQ(verdict.messages, "");
}

TEST(GltfValidator, SeesWhatIsBroken) {
  if (const std::string why = missing(); !why.empty()) GTEST_SKIP() << why;
  const ScratchFolder folder;
  const ModelKind kind = model_kinds().front();
  io::write_glb(folder / "x.glb", kind.model, y_up(), {0, 0, 0}, kind.options);
  std::string bytes = read_file(folder / "x.glb");
  const std::string two = "\"2.0\"";
  bytes.replace(bytes.find(two), two.size(), "\"7.0\"");
  fs::remove(folder / "x.glb");
  write_file(folder / "x.glb", bytes);
  EXPECT_FALSE(validated(folder.path()).valid);
}

TEST(NormalMap, IsInLitFilesWithTangentsAndInNoUnlitOne) {
  const ScratchFolder folder;
  int with = 0;
  for (const ModelKind& kind : model_kinds()) {
    const fs::path file = folder / (kind.name + ".glb");
    io::write_glb(file, kind.model, y_up(), {0, 0, 0}, kind.options);
    EXPECT_EQ(gltf_problems(file), std::vector<std::string>{}) << kind.name;
    for (const GltfPrimitive& p : read_gltf(file).primitives) {
      EXPECT_EQ(p.normal_map.empty(), p.tangents.empty()) << kind.name;
      if (p.unlit) {
        EXPECT_TRUE(p.normal_map.empty()) << kind.name;
      }
      with += p.normal_map.empty() ? 0 : 1;
    }
  }
  EXPECT_EQ(with, 3);  // two materials and one
}

}  // namespace
}  // namespace drape::test
