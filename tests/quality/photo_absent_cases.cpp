#include <algorithm>
#include <filesystem>

#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/simulation/objects.hpp"
#include "photo_cases.hpp"
#include "support.hpp"

namespace drape {
namespace {

constexpr int simulated_photos = 12;
const std::vector<std::string> mesh_files = {"rocker-arm.obj", "fandisk.obj", "cow.obj",   "spot.obj",
                                             "cessna.obj",     "teapot.obj",  "conrod.stl"};

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};
struct BoxedPhoto {
  std::string name;  // of what the box is round; no mesh of that name is tried
  std::string set;   // of photos that show each other's things
  Image8 rgb;
  std::array<double, 4> box{};
};

std::vector<NamedMesh> meshes(const std::filesystem::path& cache) {
  std::vector<NamedMesh> found;
  for (int i = 0; i < 7; ++i) {
    const PhotoCase photo = simulated_case(i, Scene::clutter, cache);
    found.push_back({photo.name, photo.mesh});
  }
  for (PhotoCase& photo : lmo_cases()) found.push_back({photo.name, std::move(photo.mesh)});
  for (const std::string& file : mesh_files)
    if (test::have_data("meshes/" + file))
      found.push_back(
          {std::filesystem::path(file).stem().string(), io::read_mesh(test::data("meshes/" + file))});
  return found;
}

std::vector<BoxedPhoto> photos(const std::filesystem::path& cache) {
  std::vector<BoxedPhoto> found;
  Rng rng(11);
  for (int i = 0; i < simulated_photos; ++i) {
    const PhotoCase photo = simulated_case(i, Scene::clutter, cache);
    found.push_back({photo.name, "simulated", photo.rgb, loose_box(photo.silhouette, rng)});
  }
  for (const PhotoCase& photo : lmo_cases())
    found.push_back({photo.name, "lmo", photo.rgb, loose_box(photo.silhouette, rng)});
  if (!test::have_data("segmentation")) return found;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(test::data("segmentation")))
    if (entry.path().extension() != ".png") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    const Image8 rgb = io::read_photo(file).rgb;
    const Image8 mask =
        io::read_stencil(file.parent_path() / (file.stem().string() + "_gt.png"), rgb.width(), rgb.height());
    found.push_back({file.stem().string(), "segmentation", rgb, loose_box(mask, rng)});
  }
  return found;
}

}  // namespace

std::vector<AbsentCase> absent_cases(int pairs, const std::filesystem::path& cache) {
  const std::vector<NamedMesh> all = meshes(cache);
  const std::vector<BoxedPhoto> shown = photos(cache);
  std::vector<AbsentCase> cases;
  // Diagonally, so that few pairs have many of both.
  for (std::size_t i = 0; i < all.size() * shown.size() && cases.size() < static_cast<std::size_t>(pairs);
       ++i) {
    const NamedMesh& mesh = all[i % all.size()];
    const BoxedPhoto& photo = shown[(i + i / (all.size() * shown.size() / 4)) % shown.size()];
    const bool both_lmo = photo.set == "lmo" && mesh.name.find("lmo") == 0;
    if (mesh.name == photo.name || both_lmo) continue;
    cases.push_back({mesh.name + " in " + photo.name, mesh.mesh, photo.rgb, photo.box});
  }
  return cases;
}

}  // namespace drape
