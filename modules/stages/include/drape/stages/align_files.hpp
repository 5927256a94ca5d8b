// One photo's camera, as files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "drape/alignment/align.hpp"
#include "drape/base/progress.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/pipeline/input.hpp"

namespace drape::stages {

struct PhotoToAlign {
  io::Photo photo;
  Image8 stencil;                           // as segmentation found it; may show no object
  double stencil_confidence = 1;            // 0..1
  Image<std::int32_t> segments{};           // labels; may be left out where align.evidence is not segments
  io::WorkspaceFrame frame{};               // of the mesh
  std::size_t index = 0;                    // in the input's photos
  std::optional<io::CameraRecord> given{};  // a camera that is kept as it is
  std::optional<Camera>
      stated{};  // by the scan file that carries the photo: its lens, and a hint at its place
};

[[nodiscard]] bool shows_object(const Image8& stencil);

/// What is told of the photo, its lens and its camera; it refers to the photo, which must outlive it.
/// Error{config} for numbers that are no lens or no camera.
[[nodiscard]] alignment::PhotoEvidence evidence_of(const PhotoToAlign& photo,
                                                   const alignment::AlignOptions& options,
                                                   const pipeline::Input& input);

/// Without the photo's name and the path of its stencil.
[[nodiscard]] io::CameraRecord to_record(const alignment::Alignment& alignment, const std::string& method);

struct AlignedPhoto {
  io::CameraRecord record;  // without the path of its stencil
  std::optional<alignment::AlignmentMetrics> metrics;
};

/// Finds the photo's camera (where a scan file states one, near that at first, and anywhere if that does not
/// hold) and writes stencil.png, the final one, and overlay.png into `folder`, which must
/// be there. A photo whose stencil shows no object is rejected where nothing but the stencil is asked. Errors
/// as those of align_photo.
[[nodiscard]] AlignedPhoto write_alignment_files(const TriangleMesh& mesh, const PhotoToAlign& photo,
                                                 const pipeline::Input& input,
                                                 const alignment::AlignOptions& options, std::uint64_t seed,
                                                 const std::filesystem::path& folder,
                                                 const Progress& progress);

}  // namespace drape::stages
