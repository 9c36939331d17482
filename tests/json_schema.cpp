#include "tests/json_schema.hpp"

#include <algorithm>
#include <set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace driftless {
namespace {

using JsonPath = std::vector<std::string>;

/// Whether `outer` leads to `inner`, or to something that contains it.
bool contains(const JsonPath& outer, const JsonPath& inner) {
  return outer.size() <= inner.size() && std::equal(outer.begin(), outer.end(), inner.begin());
}

/// The validator's ["<root>", "[cells]", "[0]", "[status]"] as cells[0].status.
std::string join(const JsonPath& path) {
  std::string text;
  for (const auto& step : path) {
    if (step.size() < 2 || step.front() != '[') continue;
    const std::string key = step.substr(1, step.size() - 2);
    const bool index = key.find_first_not_of("0123456789") == std::string::npos;
    text += index ? step : (text.empty() ? "" : ".") + key;
  }
  return text.empty() ? "the whole file" : text;
}

}  // namespace

std::vector<std::string> schema_errors(const nlohmann::json& schema,
                                       const nlohmann::json& instance) {
  using Adapter = valijson::adapters::NlohmannJsonAdapter;
  valijson::Schema rules;
  valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(Adapter(schema), rules);
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  if (validator.validate(rules, Adapter(instance), &results)) return {};
  std::set<std::string> lines;
  for (const auto& error : results) {
    const bool has_deeper = std::any_of(results.begin(), results.end(), [&](const auto& other) {
      return other.context.size() > error.context.size() && contains(error.context, other.context);
    });
    if (!has_deeper) lines.insert(join(error.context) + ": " + error.description);
  }
  if (lines.empty()) lines.insert("the whole file: breaks the schema");
  return {lines.begin(), lines.end()};
}

}  // namespace driftless
