#pragma once

#include <string_view>

namespace driftless {

/// The texts of the files *.schema.json, which the build puts into the program.
std::string_view result_schema_text();
std::string_view comparison_schema_text();
std::string_view judgement_schema_text();
std::string_view papers_schema_text();

}  // namespace driftless
