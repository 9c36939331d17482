#include <iostream>

#include "experiments/commands/commands.hpp"
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

int fault(const std::exception& error, int exit_code) {
  std::cerr << "driftless: " << error.what() << '\n';
  return exit_code;
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
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const InputError& error) {
    return fault(error, 2);
  } catch (const ModuleError& error) {
    return fault(error, 2);
  } catch (const std::exception& error) {
    return fault(error, 1);
  }
  return exit_code;
}
