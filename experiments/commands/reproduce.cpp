#include <fmt/format.h>

#include <memory>
#include <optional>

#include "experiments/commands/commands.hpp"
#include "experiments/judge/judge.hpp"
#include "experiments/reproduce/papers.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/study.hpp"

namespace driftless::commands {
namespace {

using nlohmann::json;

struct Arguments {
  std::vector<std::string> experiments;
  std::string method, directory = "reproduction";
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool list = false, quick = false, quiet = false;
};

void list_experiments() {
  for (const auto* experiment : reproduce::experiments()) {
    fmt::print("{}\n  {}\n  source: {}\n", experiment->name, experiment->title, experiment->source);
  }
}

/// What is run, after what a method leaves out.
std::vector<const reproduce::Experiment*> read_experiments(
    const Arguments& arguments, const std::optional<MethodChoice>& method) {
  if (!method) return reproduce::read_experiments(arguments.experiments);
  std::vector<std::string> left_out;
  auto experiments = reproduce::experiments_run_by(*method, arguments.experiments, left_out);
  for (const auto& sentence : left_out) fmt::print(stderr, "left out: {}\n", sentence);
  return experiments;
}

/// The exit code.
int run(const Arguments& arguments) {
  if (arguments.list) {
    list_experiments();
    return 0;
  }
  if (arguments.experiments.empty()) {
    throw InputError("reproduce: names of experiments are missing, or `all`; --list names them");
  }
  std::optional<MethodChoice> method;
  if (!arguments.method.empty()) method = judge::read_method_option(arguments.method);
  const auto experiments = read_experiments(arguments, method);
  std::string command = program_with_methods();
  command += fmt::format(" reproduce {} --seed {} -o {}", fmt::join(arguments.experiments, " "),
                         arguments.seed, arguments.directory);
  if (method) command += " --method " + arguments.method;
  if (arguments.quick) command += " --quick";
  const auto effort = arguments.quick ? reproduce::Effort::quick : reproduce::Effort::full;
  const auto earlier = reproduce::read_papers(arguments.directory);
  const auto papers = reproduce::run_experiments(experiments, {arguments.directory,
                                                               {effort, arguments.seed, method},
                                                               arguments.threads,
                                                               command,
                                                               arguments.quiet});
  const auto all = reproduce::united(earlier, papers);
  print_written(reproduce::papers_summary(all), reproduce::write_papers(all, arguments.directory));
  const auto& shown = all["experiments"];
  return std::any_of(shown.begin(), shown.end(),
                     [](const json& one) { return one.contains("failure"); });
}

}  // namespace

void add_reproduce(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand(
      "reproduce",
      "run the papers' experiments, their values beside ours; finished parts are kept");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("experiment", arguments->experiments, "names of experiments, or all")
      ->delimiter(',');
  command->add_flag("--list", arguments->list, "name all experiments and end");
  command->add_option(
      "--method", arguments->method,
      "NAME or NAME:option=value,option=value: this method in the place of the papers' own; `all` "
      "then leaves out what it cannot run, and methods-transport, which measures every method");
  command->add_flag("--quick", arguments->quick,
                    "smaller systems or shorter runs than the papers'");
  command->add_option("-o,--output", arguments->directory,
                      "folder of the report (default: reproduction)");
  command->add_option("--seed", arguments->seed, "of all noise (default 1)");
  add_threads(*command, arguments->threads);
  command->add_flag("-q,--quiet", arguments->quiet, "no progress");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace driftless::commands
