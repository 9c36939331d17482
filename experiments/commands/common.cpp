#include <fmt/format.h>

#include <filesystem>

#include "experiments/commands/commands.hpp"
#include "integrators/modules.hpp"

namespace driftless::commands {

void add_threads(CLI::App& command, unsigned& threads) {
  command
      .add_option(
          "-t,--threads", threads,
          "threads (default: as many as this process may use processors and have something to do)")
      ->check(CLI::Range(1U, 4096U));
}

std::string program_with_methods() {
  std::string command = "driftless";
  for (const auto& module : loaded_modules()) command += " --methods " + module.string();
  return command;
}

void print_written(const std::string& summary, const std::filesystem::path& page) {
  fmt::print("{}\nPage: {}\n", summary,
             std::filesystem::absolute(page).lexically_normal().string());
}

}  // namespace driftless::commands
