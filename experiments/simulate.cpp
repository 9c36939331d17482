#include "experiments/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/files.hpp"
#include "experiments/interrupt.hpp"
#include "experiments/monitor.hpp"
#include "experiments/prepared_scene.hpp"
#include "experiments/processors.hpp"
#include "experiments/provenance.hpp"
#include "experiments/simulation.hpp"
#include "experiments/study_parts.hpp"
#include "experiments/trajectory.hpp"

namespace driftless {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// The scene as it starts; where a checkpoint will replace the state, without the Monte Carlo run
/// that makes a start of the exact law.
PreparedScene prepare(Scene scene, std::uint64_t seed, bool replaced) {
  if (replaced) {
    scene.initial_state = InitialState::rest;
    scene.initial_velocities.clear();
  }
  return PreparedScene(scene, seed, 1);
}

double kinetic_degrees(const PreparedScene& prepared) {
  const auto islands = prepared.scene().particles / prepared.island_size();
  return prepared.kinetic_degrees() * static_cast<double>(islands);
}

/// A system with all that looks at it.
struct Laboratory {
  Laboratory(const Simulation& simulation, const PreparedScene& prepared, double time_step)
      : system(prepared.start(0)),
        trajectory(simulation.files.trajectory, time_step),
        monitor(system, time_step, kinetic_degrees(prepared)),
        fields(system, simulation.bins) {
    observations = {{"trajectory", &trajectory, simulation.every, 0},
                    {"monitor", &monitor, simulation.sample_every, 0}};
    if (!simulation.has_fields) return;
    observations.push_back({"fields", &fields, simulation.sample_every, simulation.equilibrate});
  }
  Laboratory(const Laboratory&) = delete;
  Laboratory& operator=(const Laboratory&) = delete;

  System system;
  Trajectory trajectory;
  Monitor monitor;
  Fields fields;
  std::vector<Observation> observations;
};

json identity_of(const Simulation& simulation, std::uint64_t seed) {
  return {
      {"scene", to_json(simulation.scene)}, {"method", to_json(simulation.method)}, {"seed", seed}};
}

void write_json(const fs::path& path, json content, const char* format, const json& run) {
  content["format"] = format;
  content["run"] = run;
  write_atomically(path, content.dump(1) + "\n");
}

void write_results(const SimulateArguments& arguments, const Simulation& simulation,
                   const Laboratory& laboratory, const Counters& counters, unsigned threads) {
  const auto& files = simulation.files;
  json run = identity_of(simulation, arguments.seed);
  run["time_step"] = arguments.time_step;
  run["steps"] = simulation.steps;
  if (simulation.has_fields) {
    write_json(files.fields, laboratory.fields.to_json(), "driftless-fields/1", run);
  }
  write_json(files.monitor, laboratory.monitor.to_json(), "driftless-monitor/1", run);
  const json counted = {{"pair_evaluations", counters.pair_evaluations},
                        {"random_numbers", counters.random_numbers},
                        {"solver_iterations", counters.solver_iterations}};
  write_json(files.run,
             {{"counters", counted},
              {"provenance", provenance(threads, arguments.seed, arguments.command)}},
             "driftless-run/1", run);
}

/// "time 10, kinetic energy 981.061, ...".
std::string last_values(const Monitor& monitor) {
  std::string text;
  for (const auto& column : monitor.columns()) {
    if (column.name.find("momentum") != column.name.npos) continue;
    std::string name = column.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ", name, column.values.back());
  }
  return text;
}

/// How far the energy of fluid and surroundings has moved, which is what is kept.
std::string energy_change(const Monitor& monitor) {
  constexpr double remarkable = 0.01;
  double first = 0, last = 0;
  for (const auto& column : monitor.columns()) {
    if (column.name != "total_energy" && column.name != "surroundings_energy") continue;
    first += column.values.front();
    last += column.values.back();
  }
  const double change = (last - first) / std::abs(first);
  std::string text =
      fmt::format("Energy of fluid and surroundings since the start: {:+.2g} %", 100 * change);
  if (std::abs(change) > remarkable) {
    text += "; a smaller step, or a method that keeps it, is needed for more than a glance";
  }
  return text + "\n";
}

std::string summary_of(const SimulateArguments& arguments, const Simulation& simulation,
                       const Laboratory& laboratory) {
  const auto& files = simulation.files;
  std::string text =
      fmt::format("{} by {}: {} steps of {}, to time {}\n{}\n", simulation.scene.name,
                  arguments.method, simulation.steps, describe(arguments.time_step),
                  describe(arguments.duration), last_values(laboratory.monitor));
  // The bath of an isothermal fluid keeps no books.
  if (!simulation.scene.fluid.isothermal) text += energy_change(laboratory.monitor);
  text += fmt::format("Trajectory: {} ({} frames)\n", files.trajectory.string(),
                      laboratory.trajectory.frames());
  if (simulation.has_fields) {
    text += fmt::format("Fields: {} ({} samples)\n", files.fields.string(),
                        laboratory.fields.samples());
  }
  return text + fmt::format("Monitor: {}\nCheckpoint: {}\n", files.monitor.string(),
                            files.checkpoint.string());
}

}  // namespace

std::string simulate(const SimulateArguments& arguments) {
  const Simulation simulation = read_simulation(arguments);
  const fs::path& checkpoint = simulation.files.checkpoint;
  const unsigned threads =
      arguments.threads > 0 ? arguments.threads : useful_threads(simulation.scene.particles);
  StepProgress progress(arguments.time_step, arguments.quiet);
  const InterruptNotice notice([&] { return progress.interruption(); });

  const auto prepared = prepare(simulation.scene, arguments.seed, fs::exists(checkpoint));
  Laboratory laboratory(simulation, prepared, arguments.time_step);
  LongRunPlan plan;
  plan.identity = identity_of(simulation, arguments.seed);
  plan.time_step = arguments.time_step;
  plan.last = simulation.steps;
  plan.checkpoint_every = arguments.checkpoint_every;
  plan.progress = &progress;
  check_checkpoint(plan, laboratory.observations, checkpoint);
  make_output_folder(simulation.files.folder, "");

  const auto integrator =
      prepared.driven(find_method(simulation.method.name)->make(simulation.method.options), 0);
  const auto end =
      long_run(laboratory.system, *integrator, plan, laboratory.observations, checkpoint, threads);
  write_results(arguments, simulation, laboratory, end.counters, threads);
  return summary_of(arguments, simulation, laboratory);
}

}  // namespace driftless
