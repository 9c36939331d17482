#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "experiments/campaign.hpp"
#include "experiments/json_text.hpp"
#include "experiments/observables.hpp"
#include "experiments/provenance.hpp"
#include "experiments/report.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/text_file.hpp"

namespace {

using namespace driftless;
namespace fs = std::filesystem;

struct Arguments {
  std::string study, result, directory, kind;
  unsigned threads = 0;
  bool json = false, quiet = false;
};

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
      const std::string name(key.name);
      if (!values.contains(name)) continue;
      fmt::print("  {:<24} {:<24} {} ({})\n", name, values[name].dump(), key.meaning,
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
  fmt::print("{}\n", (kind == "study" ? study_schema() : result_schema()).dump(2));
}

void check(const Arguments& arguments) {
  const Study study = read_study(arguments.study);
  fmt::print("{}: a valid study of {} scenes, {} methods, {} steps and {} replicas\n",
             arguments.study, study.scenes.size(), study.methods.size(), study.time_steps.size(),
             study.replicas);
}

void run(const Arguments& arguments) {
  const Study study = read_study(arguments.study);
  const fs::path directory = arguments.directory.empty()
                                 ? fs::path("driftless-results") / fs::path(arguments.study).stem()
                                 : fs::path(arguments.directory);
  const std::string command =
      fmt::format("driftless run {} -o {}", arguments.study, directory.string());
  const auto result = run_campaign(study, {directory, arguments.threads, command, arguments.quiet});
  const auto page = write_report(result, directory);
  fmt::print("{}\nPage: {}\n", summary(result), fs::absolute(page).lexically_normal().string());
}

void report(const Arguments& arguments) {
  fs::path file = arguments.result;
  if (fs::is_directory(file)) file /= "result.json";
  const auto result = parse_json_text(read_text_file(file.string()), file.string());
  if (!result.is_object() || result.value("format", "") != "driftless-result/1") {
    throw InputError(file.string() + ": is not a result of format driftless-result/1");
  }
  const fs::path directory =
      arguments.directory.empty() ? file.parent_path() : fs::path(arguments.directory);
  std::error_code error;
  if (!directory.empty()) fs::create_directories(directory, error);
  const auto page = write_report(result, directory);
  fmt::print("{}\nPage: {}\n", summary(result), fs::absolute(page).lexically_normal().string());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "driftless: compares the integrators of dissipative particle dynamics with energy "
      "conservation (DPDE)"};
  app.set_version_flag("--version", "driftless " + version());
  app.require_subcommand(1);
  Arguments arguments;

  auto* run_command = app.add_subcommand("run", "run a study; finished cells are not run again");
  run_command->add_option("study", arguments.study, "study file (JSON)")->required();
  run_command->add_option("-o,--output", arguments.directory,
                          "folder of the result (default driftless-results/<study>)");
  run_command->add_option("-t,--threads", arguments.threads, "threads (default all)")
      ->check(CLI::Range(1U, 4096U));
  run_command->add_flag("-q,--quiet", arguments.quiet, "no progress");
  run_command->callback([&] { run(arguments); });

  auto* check_command = app.add_subcommand("check", "check a study file");
  check_command->add_option("study", arguments.study, "study file (JSON)")->required();
  check_command->callback([&] { check(arguments); });

  auto* report_command = app.add_subcommand("report", "write a result's page and summary anew");
  report_command->add_option("result", arguments.result, "result.json or its folder")->required();
  report_command->add_option("-o,--output", arguments.directory, "another folder");
  report_command->callback([&] { report(arguments); });

  app.add_subcommand("methods", "list the integrators")->callback(print_methods);
  auto* scenes = app.add_subcommand("scenes", "list the scenes and every key they set");
  scenes->add_flag("--json", arguments.json, "JSON alone");
  scenes->callback([&] { print_scenes(arguments.json); });
  app.add_subcommand("observables", "list the observables")->callback(print_observables);
  auto* schema = app.add_subcommand("schema", "print the JSON Schema of a file format");
  schema->add_option("kind", arguments.kind, "study or result")
      ->required()
      ->check(CLI::IsMember({"study", "result"}));
  schema->callback([&] { print_schema(arguments.kind); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const InputError& error) {
    std::cerr << "driftless: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "driftless: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
