#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.hpp"
#include "experiments/compare/compare.hpp"
#include "experiments/compare/compare_text.hpp"
#include "experiments/files.hpp"
#include "experiments/judge/judge.hpp"
#include "experiments/recommend.hpp"
#include "experiments/report.hpp"
#include "experiments/reproduce/papers.hpp"
#include "experiments/result_file.hpp"
#include "experiments/study.hpp"

namespace driftless::commands {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

void report(const std::string& given, const std::string& output) {
  fs::path directory = fs::is_directory(given) ? fs::path(given) : fs::path(given).parent_path();
  if (!output.empty()) directory = output;
  const auto papers = reproduce::read_papers(given);
  const auto judgement = papers ? std::nullopt : judge::read_judgement(given);
  const auto result = papers || judgement ? json() : read_result(given);
  std::error_code error;
  if (!directory.empty()) fs::create_directories(directory, error);
  if (papers) {
    print_written(reproduce::papers_summary(*papers), reproduce::write_papers(*papers, directory));
  } else if (judgement) {
    print_written(judge::judgement_summary(*judgement),
                  judge::write_judgement(*judgement, directory));
  } else {
    print_written(summary(result), write_report(result, directory));
  }
}

struct ComparedFiles {
  std::string base, changed, json;
  bool gate = false;
};

/// The exit code.
int compare_files(const ComparedFiles& files, CompareOptions options) {
  options.all_cells = files.gate;
  json comparison;
  try {
    comparison = compare(read_result(files.base), read_result(files.changed), options);
  } catch (const NotComparable& fault) {
    throw InputError(fmt::format("{} (BASE) and {} (NEW) cannot be compared: {}", files.base,
                                 files.changed, fault.what()));
  }
  if (!files.json.empty()) write_atomically(files.json, comparison.dump(1) + "\n");
  fmt::print("{}", comparison_text(comparison));
  if (!files.gate) return 0;
  return comparison["verdict"] == "worse" ? 1 : comparison["verdict"] == "too_little_data" ? 2 : 0;
}

void keep_numbers(const std::string& result, const std::string& file) {
  write_atomically(file, without_curves(read_result(result)).dump(1) + "\n");
}

}  // namespace

void add_report(CLI::App& app) {
  auto* command = app.add_subcommand(
      "report", "write the page and summary of a result, judgement or reproduction anew");
  struct Files {
    std::string result, output;
  };
  const auto files = std::make_shared<Files>();
  command
      ->add_option("result", files->result,
                   "result.json, judgement.json, papers.json or their folder")
      ->required();
  command->add_option("-o,--output", files->output, "another folder");
  command->callback([files] { report(files->result, files->output); });
}

void add_recommend(CLI::App& app) {
  const auto question = std::make_shared<Question>();
  auto* command = app.add_subcommand(
      "recommend",
      "name the cheapest method and step within a tolerance, from finished results or judgements");
  command
      ->add_option("result", question->results,
                   "result.json or judgement.json files or their folders")
      ->required();
  command->add_option("--tolerance", question->tolerance,
                      "largest error, as 0.5% or 0.005; a number for drifts and distances");
  command->add_option("--observable", question->observable,
                      "what is to be right (default equilibrium: both temperatures and "
                      "the variance of the internal energy)");
  command->add_option("--budget", question->budget,
                      "core-s per unit time: name the most accurate "
                      "method within this cost");
  command->add_option("--scene", question->scene, "this scene alone");
  command->callback([question] { fmt::print("{}", recommend(*question)); });
}

void add_compare(CLI::App& app, int& exit_code) {
  struct Arguments {
    ComparedFiles files;
    CompareOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  auto* command = app.add_subcommand(
      "compare",
      "what became better or worse from one result to another, beyond chance; exit code 0, or 2 if "
      "they cannot be compared");
  command->add_option("base", arguments->files.base, "result.json or its folder: as it was")
      ->required();
  command->add_option("new", arguments->files.changed, "result.json or its folder: as it is")
      ->required();
  command->add_flag(
      "--gate", arguments->files.gate,
      "exit code 1 if anything is worse; 2 also if anything of BASE is missing in NEW or most "
      "tests have too little data");
  command->add_option("--json", arguments->files.json, "write the comparison to this file too");
  command->add_option("--only", arguments->options.method, "this method alone");
  command
      ->add_option("--minimum-effect", arguments->options.minimum_effect,
                   "smaller differences are the same, as a share of the exact value")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  command
      ->add_option("--wanted-effect", arguments->options.wanted_effect,
                   "what a test must be able to see, or it has too little data")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  command->callback(
      [arguments, &exit_code] { exit_code = compare_files(arguments->files, arguments->options); });
}

void add_keep(CLI::App& app) {
  struct Files {
    std::string result, kept;
  };
  const auto files = std::make_shared<Files>();
  auto* command = app.add_subcommand(
      "keep", "write a result's numbers alone, without curves: small enough to be committed");
  command->add_option("result", files->result, "result.json or its folder")->required();
  command->add_option("file", files->kept, "file to write")->required();
  command->callback([files] { keep_numbers(files->result, files->kept); });
}

}  // namespace driftless::commands
