#include <fmt/core.h>

#include <algorithm>

#include "drape/base/error.hpp"
#include "drape/base/random.hpp"
#include "drape/io/photo.hpp"
#include "drape/segmentation/segment_photo.hpp"
#include "rows.hpp"
#include "segments_json.hpp"

namespace drape::stages {
namespace {

Image8 given_mask(const std::filesystem::path& file, const Image8& rgb) {
  Image8 mask = io::read_stencil(file, rgb.width(), rgb.height());
  const std::vector<std::uint8_t>& pixels = mask.data();
  if (std::find(pixels.begin(), pixels.end(), stencil::object) == pixels.end())
    throw input_error("{}: is an empty stencil: no pixel of it is object (white)", file.string());
  return mask;
}

void run(const segmentation::SegmentOptions& options, pipeline::StageRun& run) {
  const auto& photos = run.input().photos;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    const pipeline::PhotoInput& input = photos[i];
    const std::string name = input.image.filename().string();
    const Progress progress =
        run.progress().part(static_cast<double>(i) / static_cast<double>(photos.size()),
                            static_cast<double>(i + 1) / static_cast<double>(photos.size()));
    progress.update(0, name);
    const io::Photo photo = io::read_photo(input.image);
    // A mask that was made by hand says more than an alpha channel.
    const Image8 mask = input.mask.empty() ? photo.alpha : given_mask(input.mask, photo.rgb);
    const segmentation::Segmentation segmented = segmentation::segment_photo(
        photo.rgb, mask, {input.box_px, input.click_px}, options, item_seed(run.seed(), i), progress);
    const std::string folder = three_digits(i);
    io::write_image(run.output(folder + "/segments.png"), segmentation::paint_labels(segmented));
    write_segments(run.output(folder + "/segments.json"), segmented);
    io::write_image(run.output(folder + "/stencil.png"), segmented.stencil);
    run.metric("photo_" + folder + "_confidence", segmented.confidence);
    run.metric("photo_" + folder + "_how", segmented.how);
  }
}

}  // namespace

pipeline::Stage segment_stage() {
  pipeline::Stage stage;
  stage.name = "segment";
  stage.summary = "Finds the object in each photo, without the mesh: segments and an image stencil.";
  stage.input_parts = {"photos", "photo_regions"};
  stage.writes = {"*/segments.png", "*/segments.json", "*/stencil.png"};
  stage.applies = [](const pipeline::Input& input) { return !input.photos.empty(); };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
