#include "experiments/scene_keys.hpp"
#include "experiments/schema/schema_texts.hpp"
#include "experiments/study_parts.hpp"

namespace driftless {

using nlohmann::json;

json scene_schema() {
  json properties = json::object();
  for (const auto& key : scene_keys()) {
    json& property = properties[std::string(key.name)] = key.rule.schema();
    property["description"] = key.meaning;
  }
  return {{"type", "object"},
          {"properties", properties},
          {"required", {"preset"}},
          {"additionalProperties", false}};
}

json study_schema() {
  json properties = json::object();
  json required = json::array();
  for (const auto& key : study_keys()) {
    json& property = properties[std::string(key.name)] = key.schema();
    property["description"] = key.meaning;
    if (key.required) required.push_back(key.name);
  }
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", "A Driftless study: scenes x methods x time steps x replicas"},
          {"type", "object"},
          {"properties", properties},
          {"required", required},
          {"oneOf", {{{"required", {"scene"}}}, {{"required", {"scenes"}}}}},
          {"additionalProperties", false}};
}

json result_schema() { return json::parse(result_schema_text()); }

json comparison_schema() { return json::parse(comparison_schema_text()); }

json judgement_schema() { return json::parse(judgement_schema_text()); }

json papers_schema() { return json::parse(papers_schema_text()); }

}  // namespace driftless
