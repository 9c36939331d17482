#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>

#include "experiments/bench/bench.hpp"
#include "experiments/campaign.hpp"
#include "experiments/compare/compare.hpp"
#include "experiments/compare/compare_text.hpp"
#include "experiments/files.hpp"
#include "experiments/judge/judge.hpp"
#include "experiments/observables.hpp"
#include "experiments/provenance.hpp"
#include "experiments/recommend.hpp"
#include "experiments/report.hpp"
#include "experiments/reproduce/papers.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/result_file.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/simulate.hpp"
#include "experiments/study_warnings.hpp"
#include "integrators/modules.hpp"

namespace {

using namespace driftless;
namespace fs = std::filesystem;
using nlohmann::json;

struct Arguments {
  std::string study, result, directory, kind;
  unsigned threads = 0;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> modules;
  bool json = false, quiet = false;
};

struct JudgeArguments {
  std::vector<std::string> methods, examinations;
  std::string directory, depth = "quick";
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool quiet = false;
};

struct ReproduceArguments {
  std::vector<std::string> experiments;
  std::string directory = "reproduction";
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool list = false, quick = false, quiet = false;
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

void check(const Arguments& arguments) {
  const Study study = read_and_warn(arguments.study);
  fmt::print("{}: a valid study of {}, {}, {} and {}\n", arguments.study,
             counted(study.scenes.size(), "scene"), counted(study.methods.size(), "method"),
             counted(study.time_steps.size(), "time step"), counted(study.replicas, "replica"));
}

void print_report(const nlohmann::json& result, const fs::path& directory) {
  const auto page = write_report(result, directory);
  fmt::print("{}\nPage: {}\n", summary(result), fs::absolute(page).lexically_normal().string());
}

void run(const Arguments& arguments) {
  Study study = read_and_warn(arguments.study);
  if (arguments.seed) study.seed = *arguments.seed;
  const fs::path directory = arguments.directory.empty()
                                 ? fs::path("driftless-results") / fs::path(arguments.study).stem()
                                 : fs::path(arguments.directory);
  std::string command = "driftless";
  for (const auto& module : loaded_modules()) command += " --methods " + module.string();
  command += fmt::format(" run {} -o {}", arguments.study, directory.string());
  if (arguments.seed) command += fmt::format(" --seed {}", *arguments.seed);
  print_report(run_campaign(study, {directory, arguments.threads, command, arguments.quiet}),
               directory);
}

void print_judgement(const nlohmann::json& judgement, const fs::path& directory) {
  const auto page = judge::write_judgement(judgement, directory);
  fmt::print("{}\nPage: {}\n", judge::judgement_summary(judgement),
             fs::absolute(page).lexically_normal().string());
}

void run_judge(const JudgeArguments& arguments) {
  const auto candidates = judge::read_candidates(arguments.methods);
  const auto examinations = judge::read_examinations(arguments.examinations);
  const fs::path directory = arguments.directory.empty()
                                 ? fs::path("driftless-results") / "judgement"
                                 : fs::path(arguments.directory);
  std::string command = "driftless";
  for (const auto& module : loaded_modules()) command += " --methods " + module.string();
  command += fmt::format(" judge {} --depth {} --seed {} -o {}", fmt::join(arguments.methods, " "),
                         arguments.depth, arguments.seed, directory.string());
  for (const auto& name : arguments.examinations) command += " --examination " + name;
  const auto depth = arguments.depth == "full" ? judge::Depth::full : judge::Depth::quick;
  const auto judgement = judge::run_judgement(
      candidates, examinations,
      {directory, {depth, arguments.seed}, arguments.threads, command, arguments.quiet});
  print_judgement(judgement, directory);
}

void list_experiments() {
  for (const auto* experiment : reproduce::experiments()) {
    fmt::print("{}\n  {}\n  source: {}\n", experiment->name, experiment->title, experiment->source);
  }
}

/// The exit code: 1 if an experiment could not be run to its end.
int print_papers(const nlohmann::json& papers, const fs::path& directory) {
  const auto page = reproduce::write_papers(papers, directory);
  fmt::print("{}\nPage: {}\n", reproduce::papers_summary(papers),
             fs::absolute(page).lexically_normal().string());
  const auto& all = papers["experiments"];
  return std::any_of(all.begin(), all.end(),
                     [](const json& one) { return one.contains("failure"); });
}

/// The exit code.
int run_reproduce(const ReproduceArguments& arguments) {
  if (arguments.list) {
    list_experiments();
    return 0;
  }
  if (arguments.experiments.empty()) {
    throw InputError("reproduce: names of experiments are missing, or `all`; --list names them");
  }
  const auto experiments = reproduce::read_experiments(arguments.experiments);
  std::string command =
      fmt::format("driftless reproduce {} --seed {} -o {}", fmt::join(arguments.experiments, " "),
                  arguments.seed, arguments.directory);
  if (arguments.quick) command += " --quick";
  const auto effort = arguments.quick ? reproduce::Effort::quick : reproduce::Effort::full;
  const auto earlier = reproduce::read_papers(arguments.directory);
  const auto papers = reproduce::run_experiments(
      experiments,
      {arguments.directory, {effort, arguments.seed}, arguments.threads, command, arguments.quiet});
  return print_papers(reproduce::united(earlier, papers), arguments.directory);
}

void report(const Arguments& arguments) {
  const fs::path given = arguments.result;
  const auto papers = reproduce::read_papers(given);
  const auto judgement = papers ? std::nullopt : judge::read_judgement(given);
  const auto result = papers ? *papers : judgement ? *judgement : read_result(given);
  fs::path directory = fs::is_directory(given) ? given : given.parent_path();
  if (!arguments.directory.empty()) directory = arguments.directory;
  std::error_code error;
  if (!directory.empty()) fs::create_directories(directory, error);
  if (papers) {
    print_papers(result, directory);
  } else {
    judgement ? print_judgement(result, directory) : print_report(result, directory);
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
  return files.gate && comparison["verdict"] == "worse" ? 1 : 0;
}

void keep_numbers(const std::string& result, const std::string& file) {
  write_atomically(file, without_curves(read_result(result)).dump(1) + "\n");
}

void add_simulate_options(CLI::App& command, SimulateArguments& simulated) {
  command.add_option("scene", simulated.scene, "a preset's name, or a JSON file of one scene")
      ->required();
  command.add_option("--method", simulated.method, "NAME or NAME:option=value,option=value")
      ->required();
  command.add_option("--time-step", simulated.time_step, "size of a step")->required();
  command.add_option("--duration", simulated.duration, "simulated time")->required();
  command.add_option("-o,--output", simulated.directory,
                     "folder of all files that are not named (default: the scene's and the "
                     "method's names, in driftless-results/)");
  command.add_option("--trajectory", simulated.trajectory,
                     "extended XYZ file, for OVITO and ASE (default: trajectory.xyz)");
  command.add_option(
      "--every", simulated.every,
      "simulated time between frames (default: 100 frames, fewer of a large system)");
  command.add_option("--fields", simulated.fields,
                     "averages on a grid, JSON (default: fields.json)");
  command.add_option("--bins", simulated.bins, "bins of the grid along x, y and z")
      ->delimiter(',')
      ->expected(3)
      ->default_str("8,8,8");
  command.add_option("--equilibrate", simulated.equilibrate,
                     "simulated time before the first sample of the fields (default: 0)");
  command.add_option("--monitor", simulated.monitor,
                     "energies, temperatures and momentum in time, JSON (default: monitor.json)");
  command.add_option(
      "--sample-every", simulated.sample_every,
      "simulated time between samples of fields and monitor (default: 1000 samples)");
  command.add_option("--checkpoint", simulated.checkpoint,
                     "what the run goes on from (default: checkpoint.cbor)");
  command.add_option("--checkpoint-every", simulated.checkpoint_every,
                     "seconds between checkpoints (default: 60)");
  command.add_option("-t,--threads", simulated.threads, "threads (default: all)")
      ->check(CLI::Range(1U, 4096U));
  command.add_option("--seed", simulated.seed, "of all random numbers (default: 1)");
  command.add_flag("-q,--quiet", simulated.quiet, "no progress");
  command.callback([&] { fmt::print("{}", simulate(simulated)); });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "driftless: compares the integrators of dissipative particle dynamics with energy "
      "conservation (DPDE)"};
  app.set_version_flag("--version", "driftless " + version());
  app.require_subcommand(1);
  app.fallthrough();  // --methods may stand behind the command too
  Arguments arguments;
  app.add_option("--methods", arguments.modules,
                 "shared objects with methods of your own, besides those of DRIFTLESS_METHODS")
      ->option_text("FILE...");
  app.parse_complete_callback([&] {
    for (const auto& module : arguments.modules) load_methods(module);
  });

  auto* run_command = app.add_subcommand("run", "run a study; finished cells are not run again");
  run_command->add_option("study", arguments.study, "study file (JSON)")->required();
  run_command->add_option(
      "-o,--output", arguments.directory,
      "folder of the result (default: the study file's name without its ending, in "
      "driftless-results/)");
  run_command
      ->add_option("-t,--threads", arguments.threads,
                   "threads (default: as many processors as this process may use)")
      ->check(CLI::Range(1U, 4096U));
  run_command->add_option("--seed", arguments.seed, "another seed than the study's");
  run_command->add_flag("-q,--quiet", arguments.quiet, "no progress");
  run_command->callback([&] { run(arguments); });

  auto* check_command = app.add_subcommand("check", "check a study file");
  check_command->add_option("study", arguments.study, "study file (JSON)")->required();
  check_command->callback([&] { check(arguments); });

  auto* report_command = app.add_subcommand(
      "report", "write the page and summary of a result, judgement or reproduction anew");
  report_command
      ->add_option("result", arguments.result,
                   "result.json, judgement.json, papers.json or their folder")
      ->required();
  report_command->add_option("-o,--output", arguments.directory, "another folder");
  report_command->callback([&] { report(arguments); });

  Question question;
  auto* recommend_command = app.add_subcommand(
      "recommend", "name the cheapest method and step within a tolerance, from finished results");
  recommend_command->add_option("result", question.results, "result.json files or their folders")
      ->required();
  recommend_command->add_option(
      "--tolerance", question.tolerance,
      "largest error, as 0.5% or 0.005; a number for drifts and distances");
  recommend_command->add_option("--observable", question.observable,
                                "what is to be right (default equilibrium: both temperatures and "
                                "the variance of the internal energy)");
  recommend_command->add_option("--budget", question.budget,
                                "core-s per unit time: name the most accurate "
                                "method within this cost");
  recommend_command->add_option("--scene", question.scene, "this scene alone");
  recommend_command->callback([&] { fmt::print("{}", recommend(question)); });

  JudgeArguments judged;
  auto* judge_command =
      app.add_subcommand("judge", "put methods to every examination; finished parts are kept");
  judge_command
      ->add_option("method", judged.methods,
                   "names of methods, NAME:option=value,option=value, or all")
      ->required();
  judge_command
      ->add_option("--depth", judged.depth,
                   "quick: minutes on 4 cores for a few methods; full: hours for all")
      ->check(CLI::IsMember({"quick", "full"}));
  judge_command->add_option("--examination", judged.examinations,
                            "this examination alone (may be given several times)");
  judge_command->add_option("-o,--output", judged.directory,
                            "folder of the judgement (default: driftless-results/judgement)");
  judge_command->add_option("--seed", judged.seed, "of all noise (default 1)");
  judge_command->add_option("-t,--threads", judged.threads, "threads (default: all)")
      ->check(CLI::Range(1U, 4096U));
  judge_command->add_flag("-q,--quiet", judged.quiet, "no progress");
  judge_command->callback([&] { run_judge(judged); });

  SimulateArguments simulated;
  for (int i = 0; i < argc; ++i) {
    simulated.command += i == 0 ? "driftless" : " " + std::string(argv[i]);
  }
  add_simulate_options(*app.add_subcommand("simulate",
                                           "run one scene under one method; the same command again "
                                           "goes on from its checkpoint"),
                       simulated);

  int exit_code = 0;
  ReproduceArguments reproduced;
  auto* reproduce_command = app.add_subcommand(
      "reproduce",
      "run the papers' experiments, their values beside ours; finished parts are kept");
  reproduce_command
      ->add_option("experiment", reproduced.experiments, "names of experiments, or all")
      ->delimiter(',');
  reproduce_command->add_flag("--list", reproduced.list, "name all experiments and end");
  reproduce_command->add_flag("--quick", reproduced.quick,
                              "smaller systems or shorter runs than the papers'");
  reproduce_command->add_option("-o,--output", reproduced.directory,
                                "folder of the report (default: reproduction)");
  reproduce_command->add_option("--seed", reproduced.seed, "of all noise (default 1)");
  reproduce_command->add_option("-t,--threads", reproduced.threads, "threads (default: all)")
      ->check(CLI::Range(1U, 4096U));
  reproduce_command->add_flag("-q,--quiet", reproduced.quiet, "no progress");
  reproduce_command->callback([&] { exit_code = run_reproduce(reproduced); });
  ComparedFiles files;
  CompareOptions compare_options;
  auto* compare_command = app.add_subcommand(
      "compare",
      "what became better or worse from one result to another, beyond chance; exit code 0, or 2 if "
      "they cannot be compared");
  compare_command->add_option("base", files.base, "result.json or its folder: as it was")
      ->required();
  compare_command->add_option("new", files.changed, "result.json or its folder: as it is")
      ->required();
  compare_command->add_flag(
      "--gate", files.gate,
      "exit code 1 if anything is worse, 2 also if a cell of BASE is missing");
  compare_command->add_option("--json", files.json, "write the comparison to this file too");
  compare_command->add_option("--only", compare_options.method, "this method alone");
  compare_command
      ->add_option("--minimum-effect", compare_options.minimum_effect,
                   "smaller differences are the same, as a share of the exact value")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  compare_command
      ->add_option("--wanted-effect", compare_options.wanted_effect,
                   "what a test must be able to see, or it has too little data")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  compare_command->callback([&] { exit_code = compare_files(files, compare_options); });

  std::string kept, kept_in;
  auto* keep_command = app.add_subcommand(
      "keep", "write a result's numbers alone, without curves: small enough to be committed");
  keep_command->add_option("result", kept, "result.json or its folder")->required();
  keep_command->add_option("file", kept_in, "file to write")->required();
  keep_command->callback([&] { keep_numbers(kept, kept_in); });

  app.add_subcommand("methods", "list the integrators")->callback(print_methods);
  auto* scenes = app.add_subcommand("scenes", "list the scenes and every key they set");
  scenes->add_flag("--json", arguments.json, "JSON alone");
  scenes->callback([&] { print_scenes(arguments.json); });
  app.add_subcommand("observables", "list the observables")->callback(print_observables);
  auto* schema = app.add_subcommand("schema", "print the JSON Schema of a file format");
  schema->add_option("kind", arguments.kind, "study, result, comparison or papers")
      ->required()
      ->check(CLI::IsMember({"study", "result", "comparison", "papers"}));
  schema->callback([&] { print_schema(arguments.kind); });

  BenchArguments bench;
  auto* bench_command = app.add_subcommand("bench", "time the kernels, the scenes and the methods");
  bench_command->add_flag("--quick", bench.quick, "fewer samples, no large system");
  bench_command->add_option("--json", bench.json, "write the tables to this file too");
  bench_command->add_flag(
      "--scaling", bench.scaling,
      "sizes to 10 million particles (--quick: 300000), threads, terms, limits");
  bench_command->add_option("--page", bench.page,
                            "write a page with charts to this HTML file; implies --scaling");
  bench_command->add_option("-t,--threads", bench.threads, "list of numbers of threads, as 1,4")
      ->delimiter(',')
      ->check(CLI::Range(1U, 4096U));
  bench_command->add_option("--particles", bench.particles, "list of sizes, as 3000,24000")
      ->delimiter(',')
      ->check(CLI::Range(least_bench_particles, std::size_t{100'000'000}));
  bench_command->callback([&] { run_bench(bench); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const InputError& error) {
    std::cerr << "driftless: " << error.what() << '\n';
    return 2;
  } catch (const ModuleError& error) {
    std::cerr << "driftless: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "driftless: " << error.what() << '\n';
    return 1;
  }
  return exit_code;
}
