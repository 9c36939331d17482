#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace driftless {

/// A comparison (see `compare`) for the terminal: a line for each test that is better or worse,
/// the counts, what the comparison could see, cost, and a sentence with the verdict at the end.
std::string comparison_text(const nlohmann::json& comparison);

}  // namespace driftless
