#include <fmt/format.h>

#include <exception>

#include "experiments/study_parts.hpp"
#include "experiments/value_rule.hpp"

namespace driftless {
namespace {

using nlohmann::json;

const std::string everything = "all";

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto* method : methods()) names.emplace_back(method->name);
  return names;
}

const Method& find_named(const json& name, const Location& location,
                         const std::vector<std::string>& allowed) {
  ValueRule::word(allowed).check(name, location);
  return *find_method(name.get<std::string>());
}

ValueRule rule_of(const OptionSpec& spec) {
  if (std::holds_alternative<bool>(spec.fallback)) return ValueRule::boolean();
  if (std::holds_alternative<double>(spec.fallback)) return ValueRule::number();
  return ValueRule::name();
}

OptionValue option_value(const json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number()) return value.get<double>();
  return value.get<std::string>();
}

Options read_options(const Method& method, const json& object, const Location& location) {
  require_object(object, location, "{\"as_published\": true}");
  if (method.options.empty() && !object.empty()) {
    location.member(object.begin().key())
        .refuse("is no option of " + std::string(method.name) + ", which has none");
  }
  std::vector<Field> fields;
  for (const auto& spec : method.options) {
    fields.push_back({spec.name, rule_of(spec), false, spec.meaning});
  }
  check_fields(object, location, std::string(method.name) + "'s options", fields);
  Options options;
  for (const auto& [key, value] : object.items()) options[key] = option_value(value);
  try {
    if (method.make) method.make(options);
  } catch (const std::exception& error) {
    location.refuse("is refused by " + std::string(method.name) + ": " + error.what());
  }
  return options;
}

MethodChoice read_choice(const json& value, const Location& location,
                         const std::vector<std::string>& words) {
  const auto names = method_names();
  if (!value.is_object()) return {std::string(find_named(value, location, words).name), {}};
  require_known_keys(value, location, "a method", {"name", "options"});
  const auto& name = require_key(value, location, "name", either(names, true));
  const Method& method = find_named(name, location.member("name"), names);
  MethodChoice choice{std::string(method.name), {}};
  if (const auto options = value.find("options"); options != value.end()) {
    choice.options = read_options(method, *options, location.member("options"));
  }
  return choice;
}

void add(const MethodChoice& choice, const Location& location, std::vector<MethodChoice>& chosen) {
  for (const auto& other : chosen) {
    if (!same(choice, other)) continue;
    location.refuse("is \"" + choice.name + "\" with the same options a second time; allowed is " +
                    "a method once, or with other options");
  }
  chosen.push_back(choice);
}

/// Where a list may hold "all" too.
std::vector<std::string> names_and_all() {
  auto words = method_names();
  words.push_back(everything);
  return words;
}

json option_schema(const OptionSpec& spec) {
  json schema = rule_of(spec).schema();
  schema["default"] = std::visit([](const auto& value) -> json { return value; }, spec.fallback);
  schema["description"] = spec.meaning;
  return schema;
}

json choice_schema(const Method& method) {
  json options = json::object();
  for (const auto& spec : method.options) options[std::string(spec.name)] = option_schema(spec);
  return {{"type", "object"},
          {"description", method.title},
          {"properties",
           {{"name", {{"const", method.name}}},
            {"options",
             {{"type", "object"}, {"properties", options}, {"additionalProperties", false}}}}},
          {"required", {"name"}},
          {"additionalProperties", false}};
}

}  // namespace

std::string to_string(const MethodChoice& choice) {
  std::string text = choice.name;
  const char* separator = ":";
  for (const auto& [option, value] : choice.options) {
    text += separator + option + "=";
    text += std::visit(
        [](const auto& given) {
          using Value = std::decay_t<decltype(given)>;
          if constexpr (std::is_same_v<Value, double>) return fmt::format("{:g}", given);
          return fmt::format("{}", given);
        },
        value);
    separator = ",";
  }
  return text;
}

bool same(const MethodChoice& one, const MethodChoice& other) {
  if (one.name != other.name) return false;
  const auto value = [](const MethodChoice& choice, const OptionSpec& spec) {
    const auto given = choice.options.find(std::string(spec.name));
    return given == choice.options.end() ? spec.fallback : given->second;
  };
  for (const auto& spec : find_method(one.name)->options) {
    if (value(one, spec) != value(other, spec)) return false;
  }
  return true;
}

MethodChoice read_method(const json& value, const Location& location) {
  return read_choice(value, location, method_names());
}

std::vector<MethodChoice> read_methods(const json& value, const Location& location) {
  const bool all = value.is_string() && value == everything;
  const json list = all ? json::array({everything}) : value;
  if (!list.is_array() || list.empty() || list.size() > 1000) {
    location.refuse("is " + describe(value) +
                    "; allowed is \"all\" or a list of 1 to 1000 methods"
                    " such as [\"shardlow-s1\"]");
  }
  std::vector<MethodChoice> chosen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Location place = all ? location : location.element(i);
    if (list[i].is_string() && list[i] == everything) {
      for (const auto& name : method_names()) add({name, {}}, place, chosen);
    } else {
      add(read_choice(list[i], place, names_and_all()), place, chosen);
    }
  }
  return chosen;
}

json methods_schema() {
  json choices = json::array({{{"enum", names_and_all()}}});
  for (const auto* method : methods()) choices.push_back(choice_schema(*method));
  return {{"anyOf",
           {{{"const", everything}},
            {{"type", "array"},
             {"minItems", 1},
             {"maxItems", 1000},
             {"items", {{"anyOf", choices}}}}}}};
}

json to_json(const Options& options) {
  json object = json::object();
  for (const auto& [name, value] : options) {
    std::visit([&, key = name](const auto& given) { object[key] = given; }, value);
  }
  return object;
}

json to_json(const MethodChoice& choice) {
  return {{"name", choice.name}, {"options", to_json(choice.options)}};
}

}  // namespace driftless
