#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace driftless {

/// Why the instance breaks the schema (draft 7), a line each; empty if it does not. A validator
/// complains of a fault on every level above it too: only the deepest complaints are kept.
std::vector<std::string> schema_errors(const nlohmann::json& schema,
                                       const nlohmann::json& instance);

}  // namespace driftless
