// Whole files in and out, with errors that name them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace drape {

/// The bytes of a file. Error{input} if it is missing, a folder, or cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// Writes aside (`<file>.writing`) and renames, so that a reader sees the old file or the new one, never
/// half. Error{io}; on an error nothing of the new file stays.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// The same for a writer that wants a path: `write(path)` gets the name aside, which is renamed afterwards.
void write_file_aside(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);

/// Creates a folder and its parents. Error{io}.
void make_folder(const std::filesystem::path& folder);

/// Lower-case extension without its dot: "Scan.PLY" -> "ply".
[[nodiscard]] std::string extension(const std::filesystem::path& file);

}  // namespace drape
