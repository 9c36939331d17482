#include "experiments/text_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "experiments/location.hpp"

namespace driftless {
namespace {

constexpr std::size_t longest_file = 256u << 20u;  // bytes; velocities of a million particles fit

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t position) {
  const auto byte = [&](std::size_t i) {
    return position + i < text.size() ? static_cast<unsigned char>(text[position + i]) : 0u;
  };
  const unsigned first = byte(0);
  if (position < text.size() && first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return 0;
  }
  const unsigned second = byte(1);
  // Overlong forms, surrogates, and what lies beyond U+10FFFF.
  const bool legal = !(first == 0xE0 && second < 0xA0) && !(first == 0xED && second > 0x9F) &&
                     !(first == 0xF0 && second < 0x90) && !(first == 0xF4 && second > 0x8F);
  return legal ? length : 0;
}

std::string read_text_file(const std::string& path) {
  const Location place(path);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    place.refuse("is a folder; allowed is a file");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::vector<char> block(1u << 16u);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > longest_file) place.refuse("is longer than 256 MiB; allowed is less");
  }
  if (!file.eof()) {
    const std::string cause = errno != 0 ? std::strerror(errno) : "unknown cause";
    place.refuse("cannot be read (" + cause + "); allowed is a readable file");
  }
  return text;
}

}  // namespace driftless
