#include "experiments/files.hpp"

#include <unistd.h>

#include <fstream>

#include "experiments/study.hpp"

namespace driftless {

void write_atomically(const std::filesystem::path& path, const std::string& text) {
  const auto temporary = path.parent_path() / (path.filename().string() + ".partial");
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(temporary, path, error);
  if (!file || error) throw InputError(path.string() + ": cannot be written");
}

void make_output_folder(const std::filesystem::path& directory, const std::string& inner) {
  std::error_code error;
  std::filesystem::create_directories(directory / inner, error);
  if (error) {
    throw InputError(directory.string() + ": the output folder cannot be made (" + error.message() +
                     ")");
  }
  const auto probe = directory / inner / "probe";
  write_atomically(probe, "");
  std::filesystem::remove(probe, error);
}

}  // namespace driftless
