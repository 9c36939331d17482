#include <fmt/format.h>

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
    // A start that is given takes keys that mean nothing to the preset's own.
    Scene given = preset.scene;
    given.initial_state = InitialState::given;
    const auto of_given = scene_parameters(given);
    for (const auto& key : scene_keys()) {
      const std::string name(key.name);
      if (!values.contains(name) && !of_given.contains(name)) continue;
      fmt::print("  {:<24} {:<24} {} ({})\n", name,
                 values.contains(name) ? values[name].dump() : "-", key.meaning,
                 key.rule.allowed());
    }
  }
}

void print_observables() {
  for (const auto& spec : observable_specs()) {
    fmt::print("{} [{}]\n  {}\n", spec.name, spec.unit, spec.meaning);
  }
}

void print_schema(const std::string& kind) {
  const json schema = kind == "study"    ? study_schema()
                      : kind == "result" ? result_schema()
                      : kind == "papers" ? papers_schema()
                                         : comparison_schema();
  fmt::print("{}\n", schema.dump(2));
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
  schema->add_option("kind", *kind, "study, result, comparison or papers")
      ->required()
      ->check(CLI::IsMember({"study", "result", "comparison", "papers"}));
  schema->callback([kind] { print_schema(*kind); });
}

}  // namespace driftless::commands
