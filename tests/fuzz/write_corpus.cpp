// Writes the files that fuzzing starts from: write_corpus FOLDER makes FOLDER/<extension>/<name>.
#include <filesystem>

#include "drape/base/files.hpp"
#include "scan_bytes.hpp"

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "corpus";
  for (const drape::test::ScanFile& file : drape::test::scanner_files()) {
    const std::filesystem::path place = folder / drape::extension(file.name);
    drape::make_folder(place);
    drape::write_file(place / file.name, file.bytes);
  }
}
