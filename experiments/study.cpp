#include "experiments/study.hpp"

#include <filesystem>

#include "experiments/json_text.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/study_parts.hpp"
#include "experiments/text_file.hpp"
#include "experiments/value_rule.hpp"

namespace driftless {
namespace {

using nlohmann::json;

const std::string study_format = "driftless-study/1";

ValueRule format_rule() { return ValueRule::word({study_format}); }
ValueRule replicas_rule() { return ValueRule::integer(1, 100'000); }
/// Beyond 2^53 other readers of JSON, a browser's among them, round whole numbers.
ValueRule seed_rule() { return ValueRule::integer(0, (std::uint64_t{1} << 53u) - 1); }

json scenes_schema() {
  return {{"type", "array"}, {"items", scene_schema()}, {"minItems", 1}, {"maxItems", 1000}};
}

std::string name_from_source(const std::string& source) {
  const std::string stem = printable(std::filesystem::path(source).stem().string().substr(0, 100));
  return stem.empty() ? "study" : stem;
}

void check_size(const Study& study, const Location& location) {
  const double runs =
      static_cast<double>(study.scenes.size() * study.methods.size() * study.time_steps.size()) *
      study.replicas;
  if (runs <= 1e6) return;
  location.member("replicas")
      .refuse("is " + std::to_string(study.replicas) + ", which with " +
              std::to_string(study.scenes.size()) + " scenes, " +
              std::to_string(study.methods.size()) + " methods and " +
              std::to_string(study.time_steps.size()) + " time steps makes " + describe(runs) +
              " runs; allowed is at most 1e6 of them");
}

void check_keys(const json& object, const Location& location) {
  std::vector<std::string> names;
  for (const auto& key : study_keys()) names.emplace_back(key.name);
  require_object(object,
                 location.path().empty() ? Location(location.source(), "the whole file") : location,
                 "{\"format\": \"" + study_format + "\", ...}");
  require_known_keys(object, location, "a study", names);
  for (const auto& key : study_keys()) {
    if (key.required) {
      require_key(object, location, std::string(key.name), std::string(key.meaning));
    }
  }
  if (object.contains("scene") == object.contains("scenes")) {
    location.member(object.contains("scene") ? "scene" : "scenes")
        .refuse(object.contains("scene")
                    ? "is given beside scenes; allowed is one of the two"
                    : "is missing; allowed is a list of scenes, or one scene under the key scene");
  }
}

}  // namespace

// The durations come before the time steps, which must divide them.
const std::vector<StudyKey>& study_keys() {
  static const std::vector<StudyKey> keys = {
      {"format", true, "\"driftless-study/1\"", [] { return format_rule().schema(); },
       [](const json& value, const Location& location, Study&) {
         format_rule().check(value, location);
       }},
      {"name", false, "what results call the study; the file's name if not given",
       [] { return ValueRule::name().schema(); },
       [](const json& value, const Location& location, Study& study) {
         ValueRule::name().check(value, location);
         study.name = value.get<std::string>();
       }},
      {"scene", false, "the scene, where there is one", scene_schema,
       [](const json& value, const Location& location, Study& study) {
         study.scenes = {read_scene(value, location)};
         if (study.scenes[0].name.empty()) study.scenes[0].name = study.scenes[0].preset;
       }},
      {"scenes", false, "the scenes", scenes_schema,
       [](const json& value, const Location& location, Study& study) {
         study.scenes = read_scenes(value, location);
       }},
      {"methods", true, "\"all\" or a list of methods, each a name or {\"name\", \"options\"}",
       methods_schema,
       [](const json& value, const Location& location, Study& study) {
         study.methods = read_methods(value, location);
       }},
      {"duration", true, "the simulated times {\"equilibrate\", \"measure\", \"sample_every\"}",
       duration_schema, read_duration},
      {"time_steps", true, "a list of numbers > 0, or {\"from\", \"to\", \"count\", \"spacing\"}",
       time_steps_schema,
       [](const json& value, const Location& location, Study& study) {
         study.time_steps = read_time_steps(value, location, study);
       }},
      {"replicas", false, "independent runs of each cell; 2 if not given",
       [] { return replicas_rule().schema(); },
       [](const json& value, const Location& location, Study& study) {
         replicas_rule().check(value, location);
         study.replicas = static_cast<unsigned>(to_integer(value));
       }},
      {"seed", false, "what every random number depends on; 1 if not given",
       [] { return seed_rule().schema(); },
       [](const json& value, const Location& location, Study& study) {
         seed_rule().check(value, location);
         study.seed = to_integer(value);
       }},
  };
  return keys;
}

Study parse_study(const std::string& text, const std::string& source) {
  const json object = parse_json_text(text, source);
  const Location location(source);
  check_keys(object, location);
  Study study;
  study.name = name_from_source(source);
  for (const auto& key : study_keys()) {
    const auto value = object.find(std::string(key.name));
    if (value != object.end()) key.read(*value, location.member(key.name), study);
  }
  check_size(study, location);
  return study;
}

Study read_study(const std::string& path) { return parse_study(read_text_file(path), path); }

json to_json(const Study& study) {
  json object = {{"format", study_format},
                 {"name", study.name},
                 {"scenes", json::array()},
                 {"methods", json::array()},
                 {"time_steps", study.time_steps},
                 {"duration",
                  {{"equilibrate", study.equilibrate},
                   {"measure", study.measure},
                   {"sample_every", study.sample_every}}},
                 {"replicas", study.replicas},
                 {"seed", study.seed}};
  for (const auto& scene : study.scenes) object["scenes"].push_back(to_json(scene));
  for (const auto& method : study.methods) object["methods"].push_back(to_json(method));
  return object;
}

}  // namespace driftless
