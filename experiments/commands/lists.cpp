#include <fmt/format.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "experiments/commands/commands.hpp"
#include "experiments/compare/compare.hpp"
#include "experiments/observables.hpp"
#include "experiments/reproduce/papers.hpp"
#include "experiments/result_file.hpp"
#include "experiments/scene_keys.hpp"
#include "integrators/integrator.hpp"

namespace driftless::commands {
namespace {

using nlohmann::json;

std::string option_text(const OptionValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:g}", *number);
  return std::get<std::string>(value);
}

void print_methods() {
  for (const Method* method : methods()) {
    std::string closures;
    for (const auto closure : method->closures) {
      closures += (closures.empty() ? "" : ", ") + std::string(to_string(closure));
    }
    fmt::print("{}\n  {}\n  source: {}\n  conserves: {}\n  friction closures: {}\n", method->name,
               method->title, method->reference, method->conserves, closures);
    fmt::print("  order: {} (noise-free {}){}{}\n", method->weak_order, method->noise_free_order,
               method->consistent ? "" : "; not consistent with the model",
               method->galilean ? "" : "; depends on the observer's velocity");
    if (method->isothermal) fmt::print("  isothermal scenes: yes\n");
    for (const auto& option : method->options) {
      fmt::print("  option {} (default {}): {}\n", option.name, option_text(option.fallback),
                 option.meaning);
    }
  }
}

void print_scenes(bool as_json) {
  if (as_json) {
    auto all = nlohmann::json::array();
    for (const auto& preset : presets()) all.push_back(to_json(preset.scene));
    fmt::print("{}\n", all.dump(2));
    return;
  }
  for (const auto& preset : presets()) {
    fmt::print("{}\n  {}\n  source: {}\n", preset.name, preset.title, preset.source);
    const auto values = scene_parameters(preset.scene);
    for (const auto& key : scene_keys()) {
      if (const auto value = values.find(key.name); value != values.end()) {
        fmt::print("    {:<30} {}\n", key.name, value->dump());
      }
    }
  }
  fmt::print("keys that a scene may have beside its preset\n");
  for (const auto& key : scene_keys()) {
    if (key.name == "preset") continue;
    fmt::print("  {:<32} {} ({})\n", key.name, key.meaning, key.rule.allowed());
  }
}

void print_observables() {
  for (const auto& spec : observable_specs()) {
    fmt::print("{} [{}]\n  {}\n", spec.name, spec.unit, spec.meaning);
  }
}

const std::map<std::string, json (*)()>& schemas() {
  static const std::map<std::string, json (*)()> all = {{"study", study_schema},
                                                        {"result", result_schema},
                                                        {"comparison", comparison_schema},
                                                        {"judgement", judgement_schema},
                                                        {"papers", papers_schema}};
  return all;
}

}  // namespace

void add_lists(CLI::App& app) {
  app.add_subcommand("methods", "list the integrators")->callback(print_methods);
  auto* scenes = app.add_subcommand("scenes", "list the scenes and the keys they set");
  const auto as_json = std::make_shared<bool>(false);
  scenes->add_flag("--json", *as_json, "JSON alone");
  scenes->callback([as_json] { print_scenes(*as_json); });
  app.add_subcommand("observables", "list the observables")->callback(print_observables);
  auto* schema = app.add_subcommand("schema", "print the JSON Schema of a file format");
  const auto kind = std::make_shared<std::string>();
  schema->add_option("kind", *kind, "study, result, comparison, judgement or papers")
      ->required()
      ->check(CLI::IsMember(schemas()));
  schema->callback([kind] { fmt::print("{}\n", schemas().at(*kind)().dump(2)); });
}

}  // namespace driftless::commands
