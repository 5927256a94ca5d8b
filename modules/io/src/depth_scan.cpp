// Depth pictures with known intrinsics.
#include <cmath>

#include "drape/base/error.hpp"
#include "exr_depth.hpp"
#include "picture_codec.hpp"
#include "picture_header.hpp"
#include "scan_builder.hpp"
#include "scan_formats.hpp"

namespace drape::io {

std::vector<RangeScan> read_depth_scan(const ScanSource& source) {
  if (!source.options.depth)
    throw input_error("{}: a depth picture needs input.depth: focal_px or K, and depth: z or range",
                      source.file);
  const DepthCamera& camera = *source.options.depth;
  const ImageF depth = [&] {
    if (looks_like_exr(source.bytes)) return decode_exr_depth(source.file, source.bytes);
    (void)read_picture_header(source.file, source.bytes);
    return decode_depth(source.file, source.bytes);
  }();
  const double cx = camera.center_px ? camera.center_px->x() : depth.width() / 2.0;
  const double cy = camera.center_px ? camera.center_px->y() : depth.height() / 2.0;
  ScanBuilder builder(source.file, {}, source.options.most_points);
  builder.set_grid(depth.height(), depth.width());
  for (int row = 0; row < depth.height(); ++row)
    for (int column = 0; column < depth.width(); ++column) {
      const double value = static_cast<double>(depth.at(column, row)) / camera.values_per_unit;
      if (!(value > 0) || !std::isfinite(value)) continue;
      const Eigen::Vector3d ray((column + 0.5 - cx) / camera.focal_px.x(),
                                (row + 0.5 - cy) / camera.focal_px.y(), 1);
      Sample sample;
      sample.position = ray * (camera.along_ray ? value / ray.norm() : value);
      builder.add(sample, row, column);
    }
  RangeScan scan = builder.finish();
  scan.view = {ScanView::Kind::origin, Eigen::Vector3d::Zero()};
  return {std::move(scan)};
}

}  // namespace drape::io
