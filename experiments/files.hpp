#pragma once

#include <filesystem>
#include <string>

namespace driftless {

/// Writes a file so that a reader finds the old text or the new one, never a part: a temporary file
/// beside it, renamed. Throws InputError if the place cannot be written.
void write_atomically(const std::filesystem::path& path, const std::string& text);

}  // namespace driftless
