// The objects of a batch, as people list them.
#pragma once

#include <filesystem>

#include "drape/pipeline/batch.hpp"

namespace drape::pipeline {

/// Reads a manifest, one of:
///   YAML   config, workspace, output (optional), and objects: a list of maps with id, the keys of `input:`
///          (scans, photos, poses, mesh, cameras, units, up), set (options by dotted name) and config
///   CSV    a line of names, then a line per object: id, the keys of `input:` (several values apart by ';'),
///          and options by dotted name; an empty cell says nothing
///   folder every folder in it is an object: drape.yaml, or scans/*, mesh.*, photos/* (NAME_mask.png is the
///   mask
///          of NAME.*), and a *.conf with the scans' poses; names that start with '.' or "drape-" are passed
///          over
/// Paths are relative to the manifest, those in a configuration relative to it. The workspace is
/// drape-workspace beside the manifest (in the folder), the output <name>-models. Error{config} with all
/// problems: a missing or repeated id, an id that is no name, unknown keys, no object. What is wrong with one
/// object's configuration is that object's failure, found when it is planned or run.
[[nodiscard]] Batch read_manifest(const std::filesystem::path& manifest);

}  // namespace drape::pipeline
