#pragma once

#include <string_view>

namespace driftless {

/// The text of result.schema.json, which the build puts into the program.
std::string_view result_schema_text();

}  // namespace driftless
