#include "drape/segmentation/segment_photo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"
#include "support.hpp"

namespace drape::segmentation {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

void paint(Image8& image, int x, int y, const Rgb& color) {
  std::copy(color.begin(), color.end(), &image.at(x, y));
}

// A red disc with a darker half on a grey backdrop that falls off, with noise. Truth: the disc.
struct Studio {
  Image8 photo;
  Image8 truth;
};

Studio studio(int width, int height, double cx, double cy, double radius, double hole = 0) {
  Studio s{Image8(width, height, 3), Image8(width, height, 1)};
  Rng rng(7);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double r = std::hypot(x + 0.5 - cx, y + 0.5 - cy);
      const bool inside = r < radius && r >= hole;
      const double shade = inside ? (x + 0.5 < cx ? 1.0 : 0.55) : 0.75 + 0.25 * y / height;
      const std::array<double, 3> base =
          inside ? std::array<double, 3>{200, 50, 40} : std::array<double, 3>{150, 150, 155};
      for (int c = 0; c < 3; ++c)
        s.photo.at(x, y, c) = static_cast<std::uint8_t>(
            std::clamp(shade * base[static_cast<std::size_t>(c)] + 3 * rng.normal(), 0.0, 255.0));
      s.truth.at(x, y) = inside ? stencil::object : stencil::background;
    }
  return s;
}

double intersection_over_union(const Image8& a, const Image8& b) {
  double both = 0;
  double either = 0;
  for (std::size_t i = 0; i < a.data().size(); ++i) {
    const bool in_a = a.data()[i] == stencil::object;
    const bool in_b = b.data()[i] == stencil::object;
    both += in_a && in_b;
    either += in_a || in_b;
  }
  return either > 0 ? both / either : 0;
}

constexpr std::array all_found = {Method::automatic,     Method::kmeans, Method::divisive,
                                  Method::agglomerative, Method::em,     Method::grabcut,
                                  Method::background};

SegmentOptions with_method(Method method) {
  SegmentOptions options;
  options.method = method;
  return options;
}

Segmentation segmented(const Image8& photo, const SegmentOptions& options, const PhotoRegion& region = {}) {
  return segment_photo(photo, {}, region, options, 1);
}

void expect_consistent(const Segmentation& s, const Image8& photo) {
  ASSERT_EQ(s.labels.width(), photo.width());
  ASSERT_EQ(s.stencil.height(), photo.height());
  double percent = 0;
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    EXPECT_EQ(s.segments[i].label, static_cast<int>(i));
    percent += s.segments[i].area_percent;
    const auto [x, y] = s.segments[i].inside_px;
    EXPECT_EQ(s.labels.at(x, y), static_cast<int>(i));
  }
  EXPECT_NEAR(percent, 100, 1e-9);
  for (const std::int32_t label : s.labels.data()) ASSERT_LT(label, static_cast<int>(s.segments.size()));
}

TEST(SegmentPhoto, FindsADiscOfTwoTonesUnaided) {
  const Studio s = studio(160, 120, 85, 58, 34);
  for (const Method method : all_found) {
    const Segmentation found = segmented(s.photo, with_method(method));
    expect_consistent(found, s.photo);
    // Texture is measured in windows, so that clusters by it part a few pixels off the outline.
    const bool blunt = method == Method::em;
    EXPECT_GT(intersection_over_union(found.stencil, s.truth), blunt ? 0.85 : 0.97) << found.how;
    EXPECT_GT(found.confidence, blunt ? 0.01 : 0.6) << found.how;
  }
}

TEST(SegmentPhoto, OutlinesAtFullResolutionWhatItFindsOnAReducedPhoto) {
  const Studio s = studio(1200, 900, 560, 470, 240);
  SegmentOptions options = with_method(Method::kmeans);
  options.max_side_px = 150;  // 8 photo pixels to one
  for (const Method method : {Method::kmeans, Method::grabcut}) {
    options.method = method;
    const Segmentation found = segmented(s.photo, options);
    expect_consistent(found, s.photo);
    // A disc outlined in blocks of 8 pixels would miss about 2 pixels all along it: 0.983.
    EXPECT_GT(intersection_over_union(found.stencil, s.truth), 0.992);
  }
}

TEST(SegmentPhoto, KeepsOrClosesTheHoleOfARing) {
  const Studio s = studio(160, 120, 80, 60, 40, 18);
  SegmentOptions options = with_method(Method::kmeans);
  EXPECT_GT(intersection_over_union(segmented(s.photo, options).stencil, s.truth), 0.95);
  options.holes = Holes::close;
  const Studio disc = studio(160, 120, 80, 60, 40);
  EXPECT_GT(intersection_over_union(segmented(s.photo, options).stencil, disc.truth), 0.95);
}

TEST(SegmentPhoto, TakesTheOneOfTwoDiscsThatIsClickedOrBoxed) {
  Studio s = studio(200, 120, 50, 60, 30);
  const Studio other = studio(200, 120, 150, 60, 30);
  Image8 both = s.photo;
  for (int y = 0; y < 120; ++y)
    for (int x = 100; x < 200; ++x)
      paint(both, x, y, {other.photo.at(x, y, 0), other.photo.at(x, y, 1), other.photo.at(x, y, 2)});
  PhotoRegion click;
  click.click_px = {150, 62};
  PhotoRegion box;
  box.box_px = {112, 22, 76, 76};
  for (const Method method : {Method::kmeans, Method::grabcut})
    for (const PhotoRegion& region : {click, box})
      EXPECT_GT(intersection_over_union(segmented(both, with_method(method), region).stencil, other.truth),
                0.93);
}

TEST(SegmentPhoto, TheYamlOfASegmentPicksIt) {
  const Studio s = studio(160, 120, 85, 58, 34);
  SegmentOptions options = with_method(Method::kmeans);
  const Segmentation found = segmented(s.photo, options);
  const auto chosen =
      std::find_if(found.segments.begin(), found.segments.end(), [](const auto& i) { return i.chosen; });
  ASSERT_NE(chosen, found.segments.end());
  EXPECT_EQ(chosen->yaml_that_picks_it,
            "{method: kmeans, pick: indices, indices: [" + std::to_string(chosen->label) + "]}");
  options.pick = Pick::indices;
  options.indices = {static_cast<double>(chosen->label)};
  options.min_hole_percent = 0;
  const Segmentation again = segmented(s.photo, options);
  EXPECT_EQ(again.labels, found.labels);
  for (std::size_t i = 0; i < again.stencil.data().size(); ++i)
    ASSERT_TRUE(again.stencil.data()[i] != stencil::object || again.labels.data()[i] == chosen->label);
}

TEST(SegmentPhoto, ASegmentUnderTheClickIsThatSegmentAlone) {
  const Studio s = studio(160, 120, 85, 58, 34);
  SegmentOptions options = with_method(Method::kmeans);
  options.pick = Pick::segment;
  PhotoRegion region;
  region.click_px = {70, 58};  // the bright half
  const Segmentation found = segmented(s.photo, options, region);
  const double share = intersection_over_union(found.stencil, s.truth);
  EXPECT_GT(share, 0.4);
  EXPECT_LT(share, 0.6);
}

TEST(SegmentPhoto, MoreClustersGiveMoreSegments) {
  const Studio s = studio(160, 120, 85, 58, 34);
  for (const Method method : {Method::kmeans, Method::divisive, Method::agglomerative, Method::em}) {
    SegmentOptions options = with_method(method);
    options.clusters = 2;
    const auto few = segmented(s.photo, options).segments.size();
    options.clusters = 20;
    EXPECT_GT(segmented(s.photo, options).segments.size(), few);
  }
}

TEST(SegmentPhoto, TheWeightOfThePositionChangesTheSegments) {
  const Studio left = studio(200, 100, 40, 50, 25);
  for (const Method method : {Method::kmeans, Method::divisive, Method::agglomerative, Method::em}) {
    SegmentOptions options = with_method(method);
    options.clusters = 6;
    options.position_weight = 0;
    const Image<std::int32_t> by_color = segmented(left.photo, options).labels;
    options.position_weight = 3;
    EXPECT_NE(segmented(left.photo, options).labels, by_color);
  }
}

TEST(SegmentPhoto, AutomaticTakesTheBackdropsWordWhereThereIsOne) {
  const Studio s = studio(160, 120, 85, 58, 34);
  EXPECT_NE(segmented(s.photo, {}).how.find("background"), std::string::npos);
  Image8 cluttered = s.photo;  // a border of three colours is no backdrop
  for (int x = 0; x < 160; ++x)
    for (int y = 0; y < 12; ++y) {
      paint(cluttered, x, y, {20, 90, static_cast<std::uint8_t>(x < 80 ? 20 : 220)});
      paint(cluttered, x, 119 - y, {static_cast<std::uint8_t>(x < 40 ? 220 : 30), 120, 40});
    }
  EXPECT_NE(segmented(cluttered, {}).how.find("GrabCut"), std::string::npos);
  Image8 rough = s.photo;  // nor is grass, though any of its colours may be anywhere on the border
  Rng rng(9);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      if (s.truth.at(x, y) != stencil::object)
        paint(rough, x, y,
              {static_cast<std::uint8_t>(80 + rng.below(60)), static_cast<std::uint8_t>(110 + rng.below(90)),
               60});
  EXPECT_NE(segmented(rough, {}).how.find("GrabCut"), std::string::npos);
}

// What the light of the studio's lamp leaves out beside the disc: full under it, soft at its far end, and a
// little bluer than the backdrop.
void cast_shadow(Studio& s, double cx, double cy, double radius) {
  for (int y = 0; y < s.photo.height(); ++y)
    for (int x = 0; x < s.photo.width(); ++x) {
      if (s.truth.at(x, y) == stencil::object || x < cx || std::abs(y + 0.5 - cy) > radius) continue;
      const double beyond = std::hypot(x + 0.5 - cx - 1.2 * radius, y + 0.5 - cy) - 0.8 * radius;
      const double lit = 1 / (1 + std::exp(-beyond / 3));
      for (int c = 0; c < 3; ++c)
        s.photo.at(x, y, c) =
            static_cast<std::uint8_t>(s.photo.at(x, y, c) * (lit + (1 - lit) * (0.4 + 0.02 * c)));
    }
}

TEST(Background, AShadowOnItIsNoPartOfTheObject) {
  Studio s = studio(320, 240, 130, 116, 60);
  cast_shadow(s, 130, 116, 60);
  const Segmentation found = segmented(s.photo, with_method(Method::background));
  EXPECT_GT(intersection_over_union(found.stencil, s.truth), 0.97);
  // Neither is it shown as backdrop: where a part of the object has the backdrop's tint it looks the same.
  EXPECT_EQ(found.stencil.at(205, 116), stencil::unknown);
  EXPECT_EQ(found.stencil.at(300, 116), stencil::background);
  EXPECT_EQ(found.stencil.at(100, 116), stencil::object);
}

TEST(Background, ADarkThingWithASharpOutlineIsNoShadow) {
  Studio s = studio(160, 120, 85, 58, 34);
  Rng rng(5);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      if (s.truth.at(x, y) == stencil::object)
        for (int c = 0; c < 3; ++c) s.photo.at(x, y, c) = static_cast<std::uint8_t>(60 + 2 * rng.normal());
  EXPECT_GT(intersection_over_union(segmented(s.photo, with_method(Method::background)).stencil, s.truth),
            0.97);
}

TEST(Background, APhotoOfTheEmptySceneShowsTheObjectInClutter) {
  Studio s = studio(160, 120, 85, 58, 34);
  Image8 scene(160, 120, 3);
  Rng rng(3);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      constexpr std::array<Rgb, 5> tiles = {
          Rgb{40, 160, 70}, {220, 210, 60}, {60, 90, 220}, {230, 120, 200}, {90, 220, 220}};
      const Rgb color = tiles[static_cast<std::size_t>(3 * (x / 8) + y / 8) % tiles.size()];
      paint(scene, x, y, color);
      if (s.truth.at(x, y) == stencil::object) continue;
      // 12 % darker than without the object, and noisier
      for (int c = 0; c < 3; ++c)
        s.photo.at(x, y, c) =
            static_cast<std::uint8_t>(0.88 * color[static_cast<std::size_t>(c)] + 2 * rng.normal());
    }
  PhotoRegion region;
  region.empty_scene = scene;
  const Segmentation found = segmented(s.photo, with_method(Method::background), region);
  EXPECT_GT(intersection_over_union(found.stencil, s.truth), 0.95);
  EXPECT_LT(intersection_over_union(segmented(s.photo, with_method(Method::background)).stencil, s.truth),
            0.9);
}

TEST(Scribbles, TellWhichOfTwoDiscsIsMeant) {
  const Studio left = studio(200, 100, 50, 50, 30);
  const Studio right = studio(200, 100, 150, 50, 30);
  Image8 photo = left.photo;
  for (int y = 0; y < 100; ++y)
    for (int x = 100; x < 200; ++x)
      paint(photo, x, y, {right.photo.at(x, y, 0), right.photo.at(x, y, 1), right.photo.at(x, y, 2)});
  PhotoRegion region;
  region.scribbles = Image8(200, 100, 1, stencil::unknown);
  for (int i = -20; i <= 20; ++i) {
    region.scribbles.at(150 + i, 50) = stencil::object;
    region.scribbles.at(50 + i, 50) = stencil::background;
    region.scribbles.at(100 + i, 5) = stencil::background;
  }
  const Segmentation found = segmented(photo, with_method(Method::grabcut), region);
  EXPECT_GT(intersection_over_union(found.stencil, right.truth), 0.93);
}

TEST(SegmentPhoto, IsTheSameForAnyNumberOfThreads) {
  const Studio s = studio(300, 200, 140, 100, 60);
  PhotoRegion boxed;
  boxed.box_px = {70, 30, 140, 140};
  for (const Method method : all_found)
    for (const PhotoRegion& region : {PhotoRegion{}, boxed}) {
      set_thread_count(1);
      const Segmentation one = segmented(s.photo, with_method(method), region);
      set_thread_count(4);
      const Segmentation four = segmented(s.photo, with_method(method), region);
      set_thread_count(0);
      EXPECT_EQ(one.labels, four.labels);
      EXPECT_EQ(one.stencil, four.stencil);
      EXPECT_EQ(one.confidence, four.confidence);
    }
}

TEST(GivenMask, KeepsItsThreeStates) {
  Image8 photo(4, 2, 3, 90);
  Image8 mask(4, 2, 1, stencil::background);
  mask.at(1, 0) = stencil::object;
  mask.at(2, 0) = stencil::unknown;
  for (const Method method : {Method::automatic, Method::mask}) {
    const Segmentation found = segment_photo(photo, mask, {}, with_method(method), 1);
    EXPECT_EQ(found.stencil, mask);
    EXPECT_EQ(found.segments.size(), 3U);
    EXPECT_EQ(found.confidence, 1);
    expect_consistent(found, photo);
  }
}

TEST(GivenMask, OtherGreysAndAlphaAreSplitInTheMiddle) {
  Image8 photo(3, 1, 3, 90);
  Image8 grey(3, 1, 1);
  grey.data() = {127, 128, 200};
  EXPECT_EQ(segment_photo(photo, grey, {}, with_method(Method::mask), 1).stencil.data(),
            (std::vector<std::uint8_t>{0, 255, 255}));
  grey.data() = {0, 128, 255};  // half transparent, not unknown
  EXPECT_EQ(segment_photo(photo, grey, {}, with_method(Method::alpha), 1).stencil.data(),
            (std::vector<std::uint8_t>{0, 255, 255}));
}

TEST(GivenMask, WithoutAnObjectHasNoConfidence) {
  const Segmentation found = segment_photo(Image8(5, 5, 3, 9), Image8(5, 5, 1, 0), {}, {}, 1);
  EXPECT_EQ(found.confidence, 0);
  EXPECT_NE(found.how.find("no object"), std::string::npos);
}

TEST(PaintLabels, GivesEverySegmentItsColor) {
  const Studio s = studio(160, 120, 85, 58, 34);
  const Segmentation found = segmented(s.photo, with_method(Method::kmeans));
  const Image8 painted = paint_labels(found);
  std::vector<std::set<Rgb>> colors(found.segments.size());
  for (int y = 0; y < painted.height(); ++y)
    for (int x = 0; x < painted.width(); ++x)
      colors[static_cast<std::size_t>(found.labels.at(x, y))].insert(
          {painted.at(x, y, 0), painted.at(x, y, 1), painted.at(x, y, 2)});
  std::set<Rgb> all;
  for (const auto& of_segment : colors) {
    EXPECT_EQ(of_segment.size(), 1U);
    all.insert(*of_segment.begin());
  }
  EXPECT_EQ(all.size(), found.segments.size());
}

TEST(NastyPhotos, OneColorHasNothingThatStandsOut) {
  for (const Method method : all_found) {
    const Image8 photo(40, 30, 3, 128);
    const Segmentation found = segmented(photo, with_method(method));
    expect_consistent(found, photo);
    EXPECT_EQ(found.confidence, 0);
    EXPECT_EQ(std::count(found.stencil.data().begin(), found.stencil.data().end(), stencil::object), 0);
  }
}

TEST(NastyPhotos, OnePixelAndFewerPixelsThanClusters) {
  SegmentOptions options = with_method(Method::kmeans);
  options.clusters = 64;
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {3, 2}}) {
    Image8 photo(width, height, 3, 10);
    photo.at(width - 1, height - 1) = 250;
    for (const Method method : all_found) {
      options.method = method;
      expect_consistent(segmented(photo, options), photo);
    }
  }
}

TEST(NastyPhotos, ABoxThatHangsOutAndAClickOnTheBorderWork) {
  const Studio s = studio(160, 120, 85, 58, 34);
  PhotoRegion region;
  region.box_px = {40, -20, 400, 400};
  EXPECT_GT(
      intersection_over_union(segmented(s.photo, with_method(Method::grabcut), region).stencil, s.truth),
      0.9);
  region = {};
  region.click_px = {160, 120};
  expect_consistent(segmented(s.photo, with_method(Method::kmeans), region), s.photo);
}

TEST(BadInput, IsRefusedInWords) {
  const Image8 photo(10, 8, 3, 50);
  const auto message = [&](ErrorCode code, const Image8& rgb, const Image8& mask, const PhotoRegion& region,
                           const SegmentOptions& options) {
    return test::error_message(code, [&] { (void)segment_photo(rgb, mask, region, options, 1); });
  };
  EXPECT_NE(message(ErrorCode::input, {}, {}, {}, {}).find("no pixels"), std::string::npos);
  EXPECT_NE(message(ErrorCode::input, Image8(4, 4, 1), {}, {}, {}).find("1 channels"), std::string::npos);
  EXPECT_NE(message(ErrorCode::input, photo, Image8(9, 8, 1), {}, {}).find("9 x 8"), std::string::npos);
  EXPECT_NE(message(ErrorCode::config, photo, {}, {}, with_method(Method::mask)).find("needs a mask"),
            std::string::npos);
  EXPECT_NE(message(ErrorCode::config, photo, {}, {}, with_method(Method::alpha)).find("alpha"),
            std::string::npos);
  PhotoRegion region;
  region.click_px = {11, 2};
  EXPECT_NE(message(ErrorCode::config, photo, {}, region, {}).find("outside the photo"), std::string::npos);
  region = {};
  region.box_px = {20, 0, 5, 5};
  EXPECT_NE(message(ErrorCode::config, photo, {}, region, {}).find("holds no pixel"), std::string::npos);
  region = {};
  region.scribbles = Image8(10, 8, 1, stencil::object);
  EXPECT_NE(message(ErrorCode::input, photo, {}, region, {}).find("mark no background"), std::string::npos);
  region.scribbles = Image8(3, 3, 1, stencil::object);
  EXPECT_NE(message(ErrorCode::input, photo, {}, region, {}).find("3 x 3"), std::string::npos);
  region = {};
  region.empty_scene = Image8(7, 8, 3);
  EXPECT_NE(message(ErrorCode::input, photo, {}, region, {}).find("7 x 8"), std::string::npos);
  SegmentOptions options = with_method(Method::kmeans);
  options.pick = Pick::click;
  EXPECT_NE(message(ErrorCode::config, photo, {}, {}, options).find("click_px"), std::string::npos);
  options.pick = Pick::indices;
  EXPECT_NE(message(ErrorCode::config, photo, {}, {}, options).find("indices"), std::string::npos);
  options.indices = {99};
  EXPECT_NE(message(ErrorCode::config, photo, {}, {}, options).find("is no segment"), std::string::npos);
}

}  // namespace
}  // namespace drape::segmentation
