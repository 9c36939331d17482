#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "experiments/campaign.hpp"
#include "experiments/commands/commands.hpp"
#include "experiments/report.hpp"
#include "experiments/study_warnings.hpp"

namespace driftless::commands {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string study, directory;
  unsigned threads = 0;
  std::optional<std::uint64_t> seed;
  bool quiet = false;
};

/// "1 scene", "2 scenes".
std::string counted(std::size_t count, const std::string& thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

/// The study, after what there is to say against it.
Study read_and_warn(const std::string& file) {
  Study study = read_study(file);
  for (const auto& warning : study_warnings(study, file)) {
    fmt::print(stderr, "{}: warning: {}\n", file, warning);
  }
  return study;
}

void check(const std::string& file) {
  const Study study = read_and_warn(file);
  fmt::print("{}: a valid study of {}, {}, {} and {}\n", file,
             counted(study.scenes.size(), "scene"), counted(study.methods.size(), "method"),
             counted(study.time_steps.size(), "time step"), counted(study.replicas, "replica"));
}

void run(const Arguments& arguments) {
  Study study = read_and_warn(arguments.study);
  if (arguments.seed) study.seed = *arguments.seed;
  const fs::path directory = arguments.directory.empty()
                                 ? fs::path("driftless-results") / fs::path(arguments.study).stem()
                                 : fs::path(arguments.directory);
  std::string command =
      program_with_methods() + fmt::format(" run {} -o {}", arguments.study, directory.string());
  if (arguments.seed) command += fmt::format(" --seed {}", *arguments.seed);
  const auto result = run_campaign(study, {directory, arguments.threads, command, arguments.quiet});
  print_written(summary(result), write_report(result, directory));
}

}  // namespace

void add_run(CLI::App& app) {
  auto* command = app.add_subcommand("run", "run a study; finished cells are not run again");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("study", arguments->study, "study file (JSON)")->required();
  command->add_option("-o,--output", arguments->directory,
                      "folder of the result (default: the study file's name without its ending, in "
                      "driftless-results/)");
  add_threads(*command, arguments->threads);
  command->add_option("--seed", arguments->seed, "another seed than the study's");
  command->add_flag("-q,--quiet", arguments->quiet, "no progress");
  command->callback([arguments] { run(*arguments); });
}

void add_check(CLI::App& app) {
  auto* command = app.add_subcommand("check", "check a study file");
  const auto file = std::make_shared<std::string>();
  command->add_option("study", *file, "study file (JSON)")->required();
  command->callback([file] { check(*file); });
}

}  // namespace driftless::commands
