// Light taken out of photos whose light is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "delit_photos.hpp"
#include "like_paint.hpp"
#include "linear_light.hpp"
#include "painted_object.hpp"
#include "photo_sights.hpp"
#include "support.hpp"

namespace drape::texturing {
namespace {

using Eigen::Vector3d;

// A unit sphere under a lamp far away and even light: colours of Lambert's law, in linear light.
Paint under(const Paint& paint, const Vector3d& towards, double lamp, double around) {
  return [=](const Vector3d& x) {
    const double light = around + lamp * std::max(0.0, x.normalized().dot(towards.normalized()));
    Vector3d stored = paint(x);
    for (double& value : stored)
      value = byte_from_linear(static_cast<float>(light) *
                               linear_from_byte(static_cast<std::uint8_t>(std::lround(value))));
    return stored;
  };
}

// Two colours in squares of about a quarter of a radian.
Vector3d squares(const Vector3d& x) {
  const int cell = static_cast<int>(std::floor(4 * std::atan2(x.y(), x.x()))) +
                   static_cast<int>(std::floor(4 * std::asin(std::clamp(x.z(), -1.0, 1.0))));
  return cell % 2 == 0 ? Vector3d(200, 150, 120) : Vector3d(150, 170, 190);
}

struct Delit {
  std::vector<Shot> shots;
  Delighting result;
};
Delit delit(const std::vector<Vector3d>& eyes, const std::vector<Vector3d>& lamps) {
  const TriangleMesh mesh = test::sphere(1, 32);
  Delit d;
  std::vector<TextureView> views;
  d.shots.reserve(eyes.size());  // views refer to them
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    const Camera camera = look_at(eyes[i], Vector3d::Zero(), Vector3d::UnitZ(), 80, 80, 35);
    d.shots.push_back(photographed(mesh, camera, under(squares, lamps[i], 0.7, 0.2)));
    views.push_back(d.shots.back().view());
  }
  const Sights sights = sights_of(mesh, mesh, views, {}, {});
  std::vector<PhotoPixels> photos;
  for (const Shot& shot : d.shots) photos.push_back({&shot.photo});
  d.result = delit_photos(mesh, sights.sights, photos, {});
  return d;
}

// The standard deviation of log(picture / paint), green, where the photo sees the sphere at under 70 degrees.
double unevenness(const Delit& d, std::size_t i, const Image8& picture) {
  const Camera& camera = d.shots[i].camera;
  double sum = 0;
  double squared = 0;
  double count = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const Vector3d way = camera.unproject({x + 0.5, y + 0.5}, 1) - camera.center();
      const double middle = -camera.center().dot(way) / way.squaredNorm();
      const double off = (camera.center() + middle * way).squaredNorm();
      if (off > 0.88) continue;
      const Vector3d point = camera.center() + middle * way - std::sqrt(1 - off) * way.normalized();
      const double log = std::log(linear_from_byte(picture.at(x, y, 1)) /
                                  linear_from_byte(static_cast<std::uint8_t>(squares(point).y())));
      sum += log;
      squared += log * log;
      count += 1;
    }
  return std::sqrt(squared / count - sum * sum / count / count);
}

// Of the unevenness that light makes, over all photos, how much is left.
double share_left(const Delit& d) {
  double before = 0;
  double after = 0;
  for (std::size_t i = 0; i < d.shots.size(); ++i) {
    before += unevenness(d, i, d.shots[i].photo);
    after += unevenness(d, i, d.result.photos[i].rgb);
  }
  return after / before;
}

TEST(DelitPhotos, UnderOneLightShareIt) {
  const Delit d = delit({{4, 0, 1}, {2, 3.5, 1}}, {{1, 2, 2}, {1, 2, 2}});
  const PhotoLight& a = d.result.lights[0];
  const PhotoLight& b = d.result.lights[1];
  ASSERT_EQ(a.lamps.size(), b.lamps.size());
  EXPECT_LT((a.around / a.around(0, 0) - b.around / b.around(0, 0)).norm(),
            0.05 * (a.around / a.around(0, 0)).norm());
  EXPECT_LT(share_left(d), 0.6);
}

TEST(DelitPhotos, UnderTwoLightsAgreeOnThePaint) {
  const Delit d = delit({{4, 0, 1}, {3, 2.6, 1}}, {{1, 2, 2}, {1, -2, 1}});
  EXPECT_GT(d.result.spread.before, 0.2);
  EXPECT_LT(d.result.spread.after, 0.3 * d.result.spread.before);
  EXPECT_LT(share_left(d), 0.6);
}

TEST(LikePaint, IsOfOneChromaticityHoweverBright) {
  const std::vector<Eigen::Vector3f> paints = {{0.6F, 0.3F, 0.2F}, {0.3F, 0.32F, 0.4F}};
  std::vector<LightSample> samples;
  for (int i = 0; i < 400; ++i) {
    const float light = 0.15F + 0.002F * static_cast<float>(i);
    const Eigen::Vector3f color = light * paints[static_cast<std::size_t>(i % 2)];
    samples.push_back({0, {}, Transfer::Zero(), color.array().log()});
  }
  // As dark as noise: no chromaticity can be told.
  for (int i = 0; i < 50; ++i)
    samples.push_back({0, {}, Transfer::Zero(), Eigen::Vector3f::Constant(std::log(0.003F))});
  std::vector<std::uint32_t> own;
  for (std::uint32_t i = 0; i < samples.size(); ++i) own.push_back(i);
  const std::vector<LightPair> pairs = pairs_of_like_paint(samples, own);
  EXPECT_GT(pairs.size(), 2000U);
  double farthest = 0;
  for (const LightPair& p : pairs) {
    ASSERT_LT(std::max(p.a, p.b), 400U);
    ASSERT_NE(p.a, p.b);
    EXPECT_EQ(p.a % 2, p.b % 2);
    farthest = std::max<double>(farthest, std::abs(static_cast<double>(p.a) - p.b));
  }
  EXPECT_GT(farthest, 300);
}

}  // namespace
}  // namespace drape::texturing
