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

}  // namespace driftless
