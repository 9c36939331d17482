#include "experiments/nearest.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "experiments/location.hpp"

namespace driftless {
namespace {

std::string folded(std::string_view word) {
  std::string result;
  for (const char c : word) {
    const bool upper = c >= 'A' && c <= 'Z';
    result += upper ? static_cast<char>(c - 'A' + 'a') : (c == '-' || c == ' ') ? '_' : c;
  }
  return result;
}

/// Damerau's distance with each letter moved at most once (optimal string alignment).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before = std::exchange(last, now);
  }
  return last[b.size()];
}

/// How far a word is from a candidate; beyond `unlike` they have nothing to do with each other.
constexpr std::size_t unlike = std::numeric_limits<std::size_t>::max();

std::size_t remoteness(const std::string& word, const std::string& candidate) {
  const std::size_t steps = distance(word, candidate);
  if (steps <= std::max<std::size_t>(1, std::max(word.size(), candidate.size()) / 3)) return steps;
  const bool part = word.size() >= 4 && candidate.find(word) != std::string::npos;
  const bool longer = candidate.size() >= 3 && word.find(candidate) == 0;
  return part || longer ? steps : unlike;
}

}  // namespace

std::optional<std::string> nearest(std::string_view word,
                                   const std::vector<std::string>& candidates) {
  const std::string sought = folded(word.substr(0, 100));
  std::optional<std::string> best;
  std::size_t least = unlike;
  for (const auto& candidate : candidates) {
    const std::size_t found = remoteness(sought, folded(candidate));
    if (found >= least) continue;
    least = found;
    best = candidate;
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  if (const auto near = nearest(word, candidates)) return "; did you mean \"" + *near + "\"?";
  return "; allowed is " + either(candidates, false);
}

}  // namespace driftless
