#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace driftless {

/// The self-contained HTML page of a bench with scaling, from its JSON; throws
/// nlohmann::json::exception where something is missing.
std::string bench_page(const nlohmann::json& bench);

}  // namespace driftless
