#include <fmt/format.h>

#include <memory>

#include "experiments/commands/commands.hpp"
#include "experiments/simulate.hpp"

namespace driftless::commands {

void add_simulate(CLI::App& app, std::string call) {
  auto* command =
      app.add_subcommand("simulate",
                         "run one scene under one method; the same command again goes on from its "
                         "checkpoint");
  const auto simulated = std::make_shared<SimulateArguments>();
  simulated->command = std::move(call);
  command
      ->add_option("scene", simulated->scene,
                   "a preset's name (see `driftless scenes`), or a JSON file of one scene")
      ->required();
  command->add_option("--method", simulated->method, "NAME or NAME:option=value,option=value")
      ->required();
  command->add_option("--time-step", simulated->time_step, "size of a step")->required();
  command->add_option("--duration", simulated->duration, "simulated time")->required();
  command->add_option("-o,--output", simulated->directory,
                      "folder of all files that are not named (default: the scene's and the "
                      "method's names, in driftless-results/)");
  command->add_option("--trajectory", simulated->trajectory,
                      "extended XYZ file, for OVITO and ASE (default: trajectory.xyz)");
  command->add_option(
      "--every", simulated->every,
      "simulated time between frames (default: 100 frames, fewer of a large system)");
  command->add_option("--fields", simulated->fields,
                      "averages on a grid, JSON (default: fields.json)");
  command->add_option("--bins", simulated->bins, "bins of the grid along x, y and z")
      ->delimiter(',')
      ->expected(3)
      ->default_str("8,8,8");
  command->add_option("--equilibrate", simulated->equilibrate,
                      "simulated time before the first sample of the fields (default: 0)");
  command->add_option("--monitor", simulated->monitor,
                      "energies, temperatures and momentum in time, JSON (default: monitor.json)");
  command->add_option(
      "--sample-every", simulated->sample_every,
      "simulated time between samples of fields and monitor (default: 1000 samples)");
  command->add_option("--checkpoint", simulated->checkpoint,
                      "what the run goes on from (default: checkpoint.cbor)");
  command->add_option("--checkpoint-every", simulated->checkpoint_every,
                      "seconds between checkpoints (default: 60)");
  add_threads(*command, simulated->threads);
  command->add_option("--seed", simulated->seed, "of all random numbers (default: 1)");
  command->add_flag("-q,--quiet", simulated->quiet, "no progress");
  command->callback([simulated] { fmt::print("{}", simulate(*simulated)); });
}

}  // namespace driftless::commands
