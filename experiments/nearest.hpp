#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftless {

/// The candidate that a mistyped word most likely stands for: fewest insertions, deletions,
/// replacements and swaps of neighbours, without regard to case or to '-' against '_', a
/// candidate that the word is a part of, or one that it begins with. Nothing if none is near.
std::optional<std::string> nearest(std::string_view word,
                                   const std::vector<std::string>& candidates);

/// The end of a message: "; did you mean "x"?", or "; allowed is a, b or c" where none is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace driftless
