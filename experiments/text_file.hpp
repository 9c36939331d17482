#pragma once

#include <string>
#include <string_view>

namespace driftless {

/// The bytes of a file; throws InputError in one sentence if it is missing, a folder, unreadable,
/// or longer than any study.
std::string read_text_file(const std::string& path);

/// Bytes of the UTF-8 character at `position`, 0 if what stands there is none.
std::size_t utf8_length(std::string_view text, std::size_t position);

}  // namespace driftless
