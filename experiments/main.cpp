#include <algorithm>
#include <iostream>

#include "experiments/commands/commands.hpp"
#include "experiments/nearest.hpp"
#include "experiments/provenance.hpp"
#include "experiments/study.hpp"
#include "integrators/modules.hpp"

namespace {

using namespace driftless;

/// "driftless ARGUMENTS...".
std::string call(int argc, char** argv) {
  std::string text = "driftless";
  for (int i = 1; i < argc; ++i) text += " " + std::string(argv[i]);
  return text;
}

int fault(const std::string& message, int exit_code) {
  std::cerr << "driftless: " << message << '\n';
  return exit_code;
}

/// What is wrong with a command line, with the nearest name to one that nothing has.
std::string advice(CLI::App& app, const CLI::ParseError& error) {
  const auto unknown = app.remaining(true);
  const auto given = app.get_subcommands();
  if (unknown.empty() && given.empty()) return "name a command; driftless --help lists them";
  if (unknown.empty()) return error.what();
  const bool is_option = unknown.front().rfind('-', 0) == 0;
  std::vector<std::string> names;
  if (given.empty() && !is_option) {
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    return "there is no command \"" + unknown.front() + '"' + suggestion(unknown.front(), names);
  }
  const CLI::App& command = given.empty() ? app : *given.front();
  if (!is_option) return command.get_name() + " takes no further \"" + unknown.front() + '"';
  for (const CLI::App* owner : {&command, static_cast<const CLI::App*>(&app)}) {
    for (const CLI::Option* option : owner->get_options()) {
      for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return command.get_name() + " takes no \"" + unknown.front() + '"' +
         suggestion(unknown.front(), names);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "driftless: compares the integrators of dissipative particle dynamics with energy "
      "conservation (DPDE)"};
  app.set_version_flag("--version", "driftless " + version());
  app.require_subcommand(1);
  app.fallthrough();  // --methods may stand behind the command too
  std::vector<std::string> modules;
  app.add_option("--methods", modules,
                 "shared objects with methods of your own, besides those of DRIFTLESS_METHODS")
      ->option_text("FILE...");
  app.parse_complete_callback([&] {
    for (const auto& module : modules) load_methods(module);
  });
  int exit_code = 0;
  commands::add_run(app);
  commands::add_check(app);
  commands::add_report(app);
  commands::add_recommend(app);
  commands::add_judge(app);
  commands::add_simulate(app, call(argc, argv));
  commands::add_reproduce(app, exit_code);
  commands::add_compare(app, exit_code);
  commands::add_keep(app);
  commands::add_lists(app);
  commands::add_bench(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : fault(advice(app, error), 2);
  } catch (const InputError& error) {
    return fault(error.what(), 2);
  } catch (const ModuleError& error) {
    return fault(error.what(), 2);
  } catch (const std::exception& error) {
    return fault(error.what(), 1);
  }
  return exit_code;
}
