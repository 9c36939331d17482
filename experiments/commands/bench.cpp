#include <fmt/format.h>

#include <memory>

#include "experiments/bench/bench.hpp"
#include "experiments/commands/commands.hpp"

namespace driftless::commands {

void add_bench(CLI::App& app) {
  const auto bench = std::make_shared<BenchArguments>();
  auto* command = app.add_subcommand("bench", "time the kernels, the scenes and the methods");
  command->add_flag("--quick", bench->quick, "fewer samples, no large system");
  command->add_option("--json", bench->json, "write the tables to this file too");
  command->add_flag("--scaling", bench->scaling,
                    "sizes to 10 million particles (--quick: 300000), threads, terms, limits");
  command->add_option("--page", bench->page,
                      "write a page with charts to this HTML file; implies --scaling");
  command->add_option("-t,--threads", bench->threads, "list of numbers of threads, as 1,4")
      ->delimiter(',')
      ->check(CLI::Range(1U, 4096U));
  command->add_option("--particles", bench->particles, "list of sizes, as 3000,24000")
      ->delimiter(',')
      ->check(CLI::Range(least_bench_particles, std::size_t{100'000'000}));
  command->callback([bench] { run_bench(*bench); });
}

}  // namespace driftless::commands
