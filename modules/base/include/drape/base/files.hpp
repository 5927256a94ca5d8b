// Whole files in and out, with errors that name them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace drape {

/// The bytes of a file. Error{input} if it is missing, a folder, or cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// The bytes of a file that may be larger than memory: small files are loaded, larger ones mapped, so that
/// the system can drop what was read. A mapped file must not shrink meanwhile. Error{input} as read_file.
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& file);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;
  [[nodiscard]] std::string_view view() const { return view_; }

 private:
  std::string loaded_;
  void* mapped_ = nullptr;
  std::string_view view_;
};

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
