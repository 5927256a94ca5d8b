#include <algorithm>

#include "drape/base/error.hpp"
#include "drape/base/random.hpp"
#include "drape/io/photo.hpp"
#include "drape/segmentation/segment_photo.hpp"
#include "drape/stages/segment_files.hpp"
#include "rows.hpp"
#include "segments_json.hpp"
#include "strokes.hpp"

namespace drape::stages {
namespace {

Image8 given_mask(const std::filesystem::path& file, const Image8& rgb) {
  Image8 mask = io::read_stencil(file, rgb.width(), rgb.height());
  const std::vector<std::uint8_t>& pixels = mask.data();
  if (std::find(pixels.begin(), pixels.end(), stencil::object) == pixels.end())
    throw input_error("{}: is an empty stencil: no pixel of it is object (white)", file.string());
  return mask;
}

// The strokes over the scribbles, later ones over earlier ones.
void draw_strokes(const std::vector<pipeline::PhotoStroke>& strokes, const Image8& rgb, Image8& scribbles) {
  if (strokes.empty()) return;
  if (scribbles.empty()) scribbles = Image8(rgb.width(), rgb.height(), 1, stencil::unknown);
  for (const pipeline::PhotoStroke& stroke : strokes)
    draw_line(scribbles, stroke.points_px, stroke.width_px,
              stroke.object ? stencil::object : stencil::background);
}

segmentation::PhotoRegion region_of(const pipeline::PhotoInput& input, const Image8& rgb) {
  segmentation::PhotoRegion region{input.box_px, input.click_px};
  if (!input.scribbles.empty())
    region.scribbles = io::read_stencil(input.scribbles, rgb.width(), rgb.height());
  draw_strokes(input.strokes, rgb, region.scribbles);
  if (!input.background.empty()) region.empty_scene = io::read_photo(input.background).rgb;
  return region;
}

void run(const segmentation::SegmentOptions& options, pipeline::StageRun& run) {
  const auto& photos = run.input().photos;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    const Progress progress =
        run.progress().part(static_cast<double>(i) / static_cast<double>(photos.size()),
                            static_cast<double>(i + 1) / static_cast<double>(photos.size()));
    const std::string folder = three_digits(i);
    const segmentation::Segmentation segmented =
        write_segment_files(photos[i], options, item_seed(run.seed(), i),
                            run.output(folder + "/stencil.png").parent_path(), progress);
    run.metric("photo_" + folder + "_confidence", segmented.confidence);
    run.metric("photo_" + folder + "_how", segmented.how);
  }
}

}  // namespace

segmentation::Segmentation write_segment_files(const pipeline::PhotoInput& input,
                                               const segmentation::SegmentOptions& options,
                                               std::uint64_t seed, const std::filesystem::path& folder,
                                               const Progress& progress) {
  progress.update(0, input.image.filename().string());
  const io::Photo photo = io::read_photo(input.image);
  // A mask that was made by hand says more than an alpha channel.
  const Image8 mask = input.mask.empty() ? photo.alpha : given_mask(input.mask, photo.rgb);
  segmentation::SegmentOptions of_photo = options;
  if (!input.segments.empty()) {
    of_photo.pick = segmentation::Pick::indices;
    of_photo.indices = input.segments;
  }
  segmentation::Segmentation segmented =
      segmentation::segment_photo(photo.rgb, mask, region_of(input, photo.rgb), of_photo, seed, progress);
  io::write_image(folder / "segments.png", segmentation::paint_labels(segmented));
  write_segments(folder / "segments.json", segmented);
  io::write_image(folder / "stencil.png", segmented.stencil);
  return segmented;
}

pipeline::Stage segment_stage() {
  pipeline::Stage stage;
  stage.name = "segment";
  stage.version = 4;
  stage.summary = "Finds the object in each photo, without the mesh: segments and an image stencil.";
  stage.input_parts = {"photos", "photo_regions"};
  stage.writes = {"*/segments.png", "*/segments.json", "*/stencil.png"};
  stage.applies = [](const pipeline::Input& input) { return !input.photos.empty(); };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
