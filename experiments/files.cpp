#include "experiments/files.hpp"

#include <unistd.h>

#include <fstream>
#include <iterator>

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

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || file.bad()) throw InputError(path.string() + ": cannot be read");
  return text;
}

}  // namespace driftless
