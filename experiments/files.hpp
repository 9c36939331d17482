#pragma once

#include <filesystem>
#include <string>

namespace driftless {

/// Writes a file so that a reader finds the old text or the new one, never a part: a temporary file
/// beside it, renamed. Throws InputError if the place cannot be written.
void write_atomically(const std::filesystem::path& path, const std::string& text);

/// Makes `inner` in a folder for results, with all folders above it, and tries that it can be
/// written. Throws InputError naming the folder.
void make_output_folder(const std::filesystem::path& directory, const std::string& inner);

}  // namespace driftless
