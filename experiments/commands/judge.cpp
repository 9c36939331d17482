#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.hpp"
#include "experiments/judge/judge.hpp"

namespace driftless::commands {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> methods, examinations;
  std::string directory, depth = "quick";
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool quiet = false;
};

void run(const Arguments& arguments) {
  const auto candidates = judge::read_candidates(arguments.methods);
  const auto examinations = judge::read_examinations(arguments.examinations);
  const fs::path directory = arguments.directory.empty()
                                 ? fs::path("driftless-results") / "judgement"
                                 : fs::path(arguments.directory);
  std::string command = program_with_methods();
  command += fmt::format(" judge {} --depth {} --seed {} -o {}", fmt::join(arguments.methods, " "),
                         arguments.depth, arguments.seed, directory.string());
  for (const auto& name : arguments.examinations) command += " --examination " + name;
  const auto depth = arguments.depth == "full" ? judge::Depth::full : judge::Depth::quick;
  const auto earlier = judge::read_judgement(directory);
  auto judgement = judge::run_judgement(
      candidates, examinations,
      {directory, {depth, arguments.seed}, arguments.threads, command, arguments.quiet});
  if (earlier) judgement = judge::united(*earlier, std::move(judgement));
  print_written(judge::judgement_summary(judgement), judge::write_judgement(judgement, directory));
}

}  // namespace

void add_judge(CLI::App& app) {
  auto* command =
      app.add_subcommand("judge", "put methods to every examination; finished parts are kept");
  const auto arguments = std::make_shared<Arguments>();
  command
      ->add_option("method", arguments->methods,
                   "names of methods, NAME:option=value,option=value, or all")
      ->required();
  command
      ->add_option("--depth", arguments->depth,
                   "quick: minutes on 4 cores for a few methods; full: hours for all")
      ->check(CLI::IsMember({"quick", "full"}));
  command->add_option("--examination", arguments->examinations,
                      "this examination alone (may be given several times); the others stay as "
                      "they are in the folder");
  command->add_option("-o,--output", arguments->directory,
                      "folder of the judgement (default: driftless-results/judgement)");
  command->add_option("--seed", arguments->seed, "of all noise (default 1)");
  add_threads(*command, arguments->threads);
  command->add_flag("-q,--quiet", arguments->quiet, "no progress");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace driftless::commands
