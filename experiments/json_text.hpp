#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace driftless {

/// Reads JSON with // and /* */ comments, strictly: UTF-8 throughout, no key twice in an object, no
/// number beyond a double, no more than a few levels of lists and objects. Throws InputError with
/// `source`, line and column (or the path of the value) in one sentence.
nlohmann::json parse_json_text(const std::string& text, const std::string& source);

/// The same with every number that is not an integer rounded to six digits.
nlohmann::json rounded(const nlohmann::json& value);

}  // namespace driftless
