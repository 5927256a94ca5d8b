#include "delit_photos.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/rendering/shadow_map.hpp"
#include "like_paint.hpp"
#include "linear_light.hpp"

namespace drape::texturing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double samples_per_photo = 6000;
constexpr double least_cosine = 0.25;  // of surface that is sampled: what is flatter tells little
constexpr int clipped = 252;           // brighter pixels may be any brighter
constexpr int coarse_side = 512;       // texels of shadow maps for the search
constexpr int coarse_maps = 4;
constexpr int fine_side = 1024;
constexpr int fine_maps = 8;
constexpr float brightest = 0.93F;  // albedo that 99.5 % of the samples are below

// Mean linear light of size x size pixels about a place in a photo; nothing where few of them can be used.
std::optional<Eigen::Vector3f> light_about(const Image8& rgb, const Image8& trusted, const Vector2d& pixel,
                                           int size) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int count = 0;
  const int left = static_cast<int>(std::floor(pixel.x() - 0.5 * (size - 1)));
  const int top = static_cast<int>(std::floor(pixel.y() - 0.5 * (size - 1)));
  for (int y = std::max(0, top); y < std::min(rgb.height(), top + size); ++y)
    for (int x = std::max(0, left); x < std::min(rgb.width(), left + size); ++x) {
      if (trusted.at(x, y) != trust::full) continue;
      if (std::max({rgb.at(x, y, 0), rgb.at(x, y, 1), rgb.at(x, y, 2)}) >= clipped) continue;
      for (int c = 0; c < 3; ++c) sum[c] += linear_from_byte(rgb.at(x, y, c));
      ++count;
    }
  if (2 * count < size * size) return std::nullopt;
  return Eigen::Vector3f(sum / static_cast<float>(count));
}

Eigen::Vector3f log_of(const Eigen::Vector3f& light) {
  constexpr float floor = 0.003F;
  return light.cwiseMax(floor).array().log();
}

// A photo's camera at a size at which the object has about so many pixels, and how many photo pixels one is.
struct CoarseView {
  Camera camera;
  int step = 1;
};
CoarseView coarse_view(const PhotoSight& sight) {
  double object = 0;
  for (const std::uint8_t t : sight.trusted().data()) object += t == trust::full ? 1 : 0;
  const int step = std::max(1, static_cast<int>(std::lround(std::sqrt(object / samples_per_photo))));
  return {sight.camera().resized(std::max(1, sight.camera().width / step),
                                 std::max(1, sight.camera().height / step)),
          step};
}

class Gatherer {
 public:
  Gatherer(const TriangleMesh& mesh, rendering::Renderer& renderer, std::span<const PhotoSight> sights,
           const std::vector<PhotoPixels>& photos)
      : mesh_(mesh), renderer_(renderer), sights_(sights), photos_(photos), normals_(mesh) {}

  LightEvidence gathered() {
    LightEvidence evidence;
    evidence.photos = static_cast<int>(sights_.size());
    for (std::size_t i = 0; i < sights_.size(); ++i) add_photo(i, evidence);
    for (std::size_t i = 0; i < sights_.size(); ++i) add_shared(i, evidence);
    return evidence;
  }

 private:
  void add_photo(std::size_t i, LightEvidence& evidence) {
    const PhotoSight& sight = sights_[i];
    const CoarseView view = coarse_view(sight);
    steps_.push_back(view.step);
    const rendering::DepthMap map = renderer_.depth_map(view.camera);
    const int width = view.camera.width;
    const int height = view.camera.height;
    constexpr std::int64_t nothing = -1;
    std::vector<std::int64_t> at(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), nothing);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (map.faces.at(x, y) == rendering::DepthMap::no_face) continue;
        const auto face = static_cast<std::uint32_t>(map.faces.at(x, y));
        const Vector3d point = view.camera.unproject({x + 0.5, y + 0.5}, map.depth.at(x, y));
        const Vector3d normal = normals_.at(face, point);
        if (normal.dot(sight.camera().towards_camera(point)) < least_cosine) continue;
        const auto light = light_about(*photos_[i].rgb, sight.trusted(), sight.pixel_of(point), view.step);
        if (!light) continue;
        at[static_cast<std::size_t>(y * width + x)] = static_cast<std::int64_t>(evidence.samples.size());
        evidence.samples.push_back(
            {static_cast<int>(i), {face, point, normal}, Transfer::Zero(), log_of(*light)});
      }
    add_pairs(at, width, height, evidence);
    std::vector<std::uint32_t> own;
    for (const std::int64_t s : at)
      if (s != nothing) own.push_back(static_cast<std::uint32_t>(s));
    const std::vector<LightPair> like = pairs_of_like_paint(evidence.samples, own);
    evidence.pairs.insert(evidence.pairs.end(), like.begin(), like.end());
  }

  // Near and farther neighbours: shading goes on smoothly, so its share grows with the distance.
  static void add_pairs(const std::vector<std::int64_t>& at, int width, int height, LightEvidence& evidence) {
    constexpr std::array<std::array<int, 2>, 8> offsets = {
        {{1, 0}, {0, 1}, {3, 0}, {0, 3}, {3, 3}, {-3, 3}, {8, 0}, {0, 8}}};
    constexpr double most_slope = 3;  // of the distance in space, to that of pixels side by side
    const auto sample = [&](int x, int y) {
      return x < 0 || y < 0 || x >= width || y >= height ? std::int64_t{-1}
                                                         : at[static_cast<std::size_t>(y * width + x)];
    };
    const auto distance = [&](std::int64_t a, std::int64_t b) {
      return (evidence.samples[static_cast<std::size_t>(a)].place.point -
              evidence.samples[static_cast<std::size_t>(b)].place.point)
          .norm();
    };
    std::vector<double> sides;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x + 1 < width; ++x)
        if (sample(x, y) >= 0 && sample(x + 1, y) >= 0)
          sides.push_back(distance(sample(x, y), sample(x + 1, y)));
    if (sides.empty()) return;
    std::nth_element(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2),
                     sides.end());
    const double pixel = sides[sides.size() / 2];
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (const auto& [dx, dy] : offsets) {
          const std::int64_t a = sample(x, y);
          const std::int64_t b = sample(x + dx, y + dy);
          if (a < 0 || b < 0 || distance(a, b) > most_slope * pixel * std::hypot(dx, dy)) continue;
          evidence.pairs.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
        }
  }

  // Every other sample of photo i, in the photos that see it too.
  void add_shared(std::size_t i, LightEvidence& evidence) const {
    for (std::uint32_t s = 0; s < evidence.samples.size(); s += 2) {
      const LightSample& sample = evidence.samples[s];
      if (sample.photo == static_cast<int>(i)) continue;
      const SurfacePlace& place = sample.place;
      const PhotoSight& sight = sights_[i];
      if (place.normal.dot(sight.camera().towards_camera(place.point)) < least_cosine) continue;
      if (sight.sees(place.point, place.normal, normals_.of_face(place.face)) != trust::full) continue;
      const auto light =
          light_about(*photos_[i].rgb, sight.trusted(), sight.pixel_of(place.point), steps_[i]);
      if (light) evidence.shared.push_back({s, static_cast<int>(i), log_of(*light)});
    }
  }

  const TriangleMesh& mesh_;
  rendering::Renderer& renderer_;
  std::span<const PhotoSight> sights_;
  const std::vector<PhotoPixels>& photos_;
  SurfaceNormals normals_;
  std::vector<int> steps_;
};

// What a photo is divided by, at one point of the surface.
class Shading {
 public:
  Shading(const TriangleMesh& mesh, rendering::Renderer& renderer, const LightTransfer& transfer,
          const PhotoLight& light)
      : transfer_(transfer), light_(light), normals_(mesh) {
    const BoundingBox box = bounding_box(mesh.vertices);
    for (const Lamp& lamp : light.lamps)
      shadows_.emplace_back(renderer, box, lamp.towards, lamp.radius_rad, fine_maps, fine_side);
  }
  [[nodiscard]] Eigen::Array3d at(std::uint32_t face, const Vector3d& point) const {
    const Vector3d normal = normals_.at(face, point);
    std::array<float, 4> arrives{};
    for (std::size_t l = 0; l < shadows_.size(); ++l) {
      const auto cosine = static_cast<float>(normal.dot(light_.lamps[l].towards));
      if (cosine > 0) arrives[l] = cosine * shadows_[l].lit(point, normals_.of_face(face));
    }
    return light_.shading(transfer_.at(face, point), {arrives.data(), shadows_.size()});
  }

 private:
  const LightTransfer& transfer_;
  const PhotoLight& light_;
  SurfaceNormals normals_;
  std::vector<rendering::SoftShadow> shadows_;
};

template <class Sample>
void divide(Sample& stored, double light) {
  stored = stored_as<Sample>(linear_from(stored) / static_cast<float>(light));
}

Image16 deep_pixels(const PhotoPixels& pixels) {
  return pixels.deep != nullptr && !pixels.deep->empty() ? *pixels.deep : deep_from_bytes(*pixels.rgb);
}

DelitPhoto delit(const PhotoPixels& pixels, const PhotoSight& sight, rendering::Renderer& renderer,
                 const Shading& shading, float factor) {
  const Image8& rgb = *pixels.rgb;
  const Camera camera = depth_camera(sight.camera());
  const rendering::DepthMap map = renderer.depth_map(camera);
  const double scale_x = static_cast<double>(camera.width) / rgb.width();
  const double scale_y = static_cast<double>(camera.height) / rgb.height();
  DelitPhoto photo{rgb, pixels.paint_deep ? deep_pixels(pixels) : Image16(), sight.trusted()};
  parallel_for(static_cast<std::size_t>(rgb.height()), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < rgb.width(); ++x) {
        if (photo.trusted.at(x, y) == trust::none) continue;
        // The warp moves what lies here by a few pixels; to first order, what came here is as far the other
        // way.
        const Vector2d here(x + 0.5, y + 0.5);
        const Vector2d from = 2 * here - sight.pixel_of(sight.camera().unproject(here, 1));
        const int column = static_cast<int>(std::floor(from.x() * scale_x));
        const int row = static_cast<int>(std::floor(from.y() * scale_y));
        if (!map.faces.contains(column, row) || map.faces.at(column, row) == rendering::DepthMap::no_face) {
          photo.trusted.at(x, y) = trust::none;
          continue;
        }
        const Vector3d point = camera.unproject({column + 0.5, row + 0.5}, map.depth.at(column, row));
        const Eigen::Array3d light = shading.at(static_cast<std::uint32_t>(map.faces.at(column, row)), point);
        for (int c = 0; c < 3; ++c)
          if (pixels.paint_deep)
            divide(photo.deep_rgb.at(x, y, c), light[c] / factor);
          else
            divide(photo.rgb.at(x, y, c), light[c] / factor);
      }
  });
  if (pixels.paint_deep) photo.rgb = bytes_from_deep(photo.deep_rgb);
  return photo;
}

// Makes the brightest paint fit into what a picture can hold.
float brightness_factor(const LightEvidence& evidence, const std::vector<PhotoLight>& lights,
                        const Arrivals& arrivals) {
  std::vector<float> albedos;
  for (std::size_t s = 0; s < evidence.samples.size(); ++s) {
    const LightSample& sample = evidence.samples[s];
    const auto p = static_cast<std::size_t>(sample.photo);
    const Eigen::Array3d light = shading_at(sample, s, lights[p], arrivals[p]);
    albedos.push_back((sample.log_color.array().exp() / light.cast<float>()).maxCoeff());
  }
  if (albedos.empty()) return 1;
  const auto nearly_all =
      albedos.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(albedos.size() - 1));
  std::nth_element(albedos.begin(), nearly_all, albedos.end());
  return std::min(1.F, brightest / std::max(*nearly_all, 1e-6F));
}

}  // namespace

Delighting delit_photos(const TriangleMesh& mesh, std::span<const PhotoSight> sights,
                        const std::vector<PhotoPixels>& photos, const Progress& progress) {
  rendering::Renderer renderer(mesh);
  LightEvidence evidence = Gatherer(mesh, renderer, sights, photos).gathered();
  std::vector<SurfacePlace> places;
  for (const LightSample& sample : evidence.samples) places.push_back(sample.place);
  const LightTransfer transfer(mesh, renderer, places, progress.part(0, 0.4));
  for (LightSample& sample : evidence.samples)
    sample.transfer = transfer.at(sample.place.face, sample.place.point);
  const BoundingBox box = bounding_box(mesh.vertices);
  const LampLight lamp_light = [&](const Vector3d& towards, double radius_rad) {
    const rendering::SoftShadow shadow(renderer, box, towards, radius_rad, coarse_maps, coarse_side);
    std::vector<float> arrives(places.size());
    parallel_for(places.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto cosine = static_cast<float>(places[i].normal.dot(towards));
        if (cosine > 0) arrives[i] = cosine * shadow.lit(places[i].point, places[i].normal);
      }
    });
    return arrives;
  };
  Delighting result;
  result.lights = fitted_lights(evidence, transfer.lit_places(), lamp_light, progress.part(0.4, 0.8));
  const Arrivals arrivals = arrivals_of(result.lights, lamp_light);
  result.spread = albedo_spread(evidence, result.lights, arrivals);
  const float factor = brightness_factor(evidence, result.lights, arrivals);
  for (std::size_t i = 0; i < sights.size(); ++i) {
    progress.update(0.8 + 0.2 * static_cast<double>(i) / static_cast<double>(sights.size()),
                    "taking light out");
    const Shading shading(mesh, renderer, transfer, result.lights[i]);
    result.photos.push_back(delit(photos[i], sights[i], renderer, shading, factor));
  }
  return result;
}

}  // namespace drape::texturing
