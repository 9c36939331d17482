#include "experiments/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "experiments/fields.hpp"
#include "experiments/files.hpp"
#include "experiments/interrupt.hpp"
#include "experiments/json_text.hpp"
#include "experiments/judge/judge.hpp"
#include "experiments/monitor.hpp"
#include "experiments/nearest.hpp"
#include "experiments/prepared_scene.hpp"
#include "experiments/processors.hpp"
#include "experiments/provenance.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/study_parts.hpp"
#include "experiments/text_file.hpp"
#include "experiments/trajectory.hpp"

namespace driftless {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double most_steps = 1e12;            // the noise counts steps in 40 bits
constexpr std::uint64_t usual_samples = 1000;  // of fields and monitor
constexpr std::uint64_t usual_frames = 100;    // of a trajectory, fewer where that is a large file
constexpr std::uint64_t usual_particles_written = 500'000;  // about 100 MB

Location argument(const std::string& name) { return Location("command line", name); }

Scene read_simulated_scene(const std::string& text) {
  json object = {{"preset", text}};
  Location place = argument("SCENE");
  if (find_preset(text) == nullptr) {
    std::error_code error;
    if (!fs::exists(text, error)) {
      std::vector<std::string> names;
      for (const auto& preset : presets()) names.emplace_back(preset.name);
      place.refuse(describe(json(text)) + " is neither a preset nor a file" +
                   suggestion(text, names));
    }
    object = parse_json_text(read_text_file(text), text);
    place = Location(text);
  }
  Scene scene = read_scene(object, place);
  if (scene.name.empty()) scene.name = scene.preset;
  return scene;
}

MethodChoice read_simulated_method(const std::string& text, const Scene& scene) {
  const auto candidates = judge::read_candidates({text});
  if (candidates.size() != 1) {
    argument("--method").refuse("is " + describe(json(text)) + "; allowed is one method");
  }
  const MethodChoice choice = candidates.front().choice;
  if (const auto reason = refusal(*find_method(choice.name), Fluid(scene.fluid))) {
    argument("--method").refuse(choice.name + " cannot run this scene: " + *reason);
  }
  return choice;
}

/// A simulated time in whole steps.
std::uint64_t whole_steps(double time, double time_step, const std::string& name,
                          const ValueRule& rule) {
  const Location place = argument(name);
  rule.check(json(time), place);
  const double steps = std::round(time / time_step);
  if (steps > most_steps) {
    place.refuse(fmt::format("is {}, which takes {:.3g} steps; allowed is at most 1e12 of them",
                             describe(time), steps));
  }
  if (std::abs(steps * time_step - time) > 1e-9 * time) {
    place.refuse(fmt::format(
        "is {}, no whole number of time steps of {}; allowed is for example {}", describe(time),
        describe(time_step), describe(std::max(1.0, steps) * time_step)));
  }
  return static_cast<std::uint64_t>(steps);
}

/// All times in steps.
struct Steps {
  std::uint64_t all, every, sample_every, equilibrate;

  Steps(const SimulateArguments& arguments, std::size_t particles) {
    ValueRule::positive().check(json(arguments.time_step), argument("--time-step"));
    const auto count = [&](double time, const char* name, const ValueRule& rule) {
      return whole_steps(time, arguments.time_step, name, rule);
    };
    all = count(arguments.duration, "--duration", ValueRule::positive());
    const auto frames =
        std::clamp<std::uint64_t>(usual_particles_written / particles, 2, usual_frames);
    every = arguments.every ? count(*arguments.every, "--every", ValueRule::positive())
                            : std::max<std::uint64_t>(1, all / frames);
    sample_every = arguments.sample_every
                       ? count(*arguments.sample_every, "--sample-every", ValueRule::positive())
                       : std::max<std::uint64_t>(1, all / usual_samples);
    equilibrate = count(arguments.equilibrate, "--equilibrate", ValueRule::not_negative());
    if (equilibrate < all) return;
    argument("--equilibrate")
        .refuse(fmt::format("is {}; allowed is a number >= 0 and < {}, the duration",
                            describe(arguments.equilibrate), describe(arguments.duration)));
  }
};

Fields::Bins read_bins(const std::vector<std::size_t>& bins) {
  const bool three = bins.size() == 3 && *std::min_element(bins.begin(), bins.end()) >= 1;
  double product = 1;
  for (const auto count : bins) product *= static_cast<double>(count);
  if (!three || product > static_cast<double>(Fields::most_bins)) {
    argument("--bins").refuse(
        fmt::format("is {}; allowed is X,Y,Z, whole numbers >= 1 with a product of at most {}",
                    fmt::join(bins, ","), Fields::most_bins));
  }
  return {bins[0], bins[1], bins[2]};
}

/// Where everything is written.
struct Files {
  fs::path folder, trajectory, fields, monitor, checkpoint, run;

  Files(const SimulateArguments& arguments, const Scene& scene) {
    folder = arguments.directory;
    if (folder.empty()) {
      std::string name = scene.name + "-" + arguments.method;
      for (const char separator : {'/', ' ', ':'}) {
        std::replace(name.begin(), name.end(), separator, '-');
      }
      folder = fs::path("driftless-results") / name;
    }
    trajectory = choose(arguments.trajectory, "--trajectory", "trajectory.xyz");
    fields = choose(arguments.fields, "--fields", "fields.json");
    monitor = choose(arguments.monitor, "--monitor", "monitor.json");
    checkpoint = choose(arguments.checkpoint, "--checkpoint", "checkpoint.cbor");
    run = folder / "run.json";
  }

 private:
  fs::path choose(const std::string& given, const char* name, const char* usual) {
    const fs::path path = given.empty() ? folder / usual : fs::path(given);
    std::error_code error;
    if (!given.empty() && path.has_parent_path() && !fs::is_directory(path.parent_path(), error)) {
      argument(name).refuse(
          "is " + describe(json(given)) +
          ", in a folder that does not exist; allowed is a file in one that does");
    }
    if (fs::is_directory(path, error)) {
      argument(name).refuse("is " + describe(json(path.string())) +
                            ", a folder; allowed is a file");
    }
    const auto same = std::find(taken_.begin(), taken_.end(), path.lexically_normal());
    if (same != taken_.end()) {
      argument(name).refuse("is " + describe(json(path.string())) +
                            ", which another output is written to; allowed is a file of its own");
    }
    taken_.push_back(path.lexically_normal());
    return path;
  }

  std::vector<fs::path> taken_;
};

/// The scene as it starts; where a checkpoint will replace the state, without the Monte Carlo run
/// that makes a start of the exact law.
PreparedScene prepare(Scene scene, std::uint64_t seed, bool replaced) {
  if (replaced) {
    scene.initial_state = InitialState::rest;
    scene.initial_velocities.clear();
  }
  return PreparedScene(scene, seed, 1);
}

/// Fields have no meaning for pairs, whose velocities have one direction and are opposite.
bool has_fields(const SimulateArguments& arguments, const Scene& scene) {
  if (scene.layout != Layout::pairs) return true;
  if (!arguments.fields.empty()) {
    argument("--fields")
        .refuse("is " + describe(json(arguments.fields)) +
                ", but the scene is one of isolated pairs, which have no fields; "
                "allowed is to leave it out");
  }
  return false;
}

void write_json(const fs::path& path, json content, const char* format, const json& identity) {
  content["format"] = format;
  content["run"] = identity;
  write_atomically(path, content.dump(1) + "\n");
}

std::string last_values(const Monitor& monitor) {
  std::string text;
  for (const auto& column : monitor.columns()) {
    if (column.name.rfind("momentum", 0) == 0) continue;
    std::string name = column.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ", name, column.values.back());
  }
  return text;
}

}  // namespace

std::string simulate(const SimulateArguments& arguments) {
  const Scene scene = read_simulated_scene(arguments.scene);
  const MethodChoice choice = read_simulated_method(arguments.method, scene);
  ValueRule::integer(0, (std::uint64_t{1} << 53U) - 1)
      .check(json(arguments.seed), argument("--seed"));
  ValueRule::not_negative().check(json(arguments.checkpoint_every), argument("--checkpoint-every"));
  const Steps steps(arguments, scene.particles);
  const auto bins = read_bins(arguments.bins);
  const bool with_fields = has_fields(arguments, scene);
  const Files files(arguments, scene);
  const unsigned threads = arguments.threads > 0 ? arguments.threads : usable_processors();

  StepProgress progress(arguments.time_step, arguments.quiet);
  const InterruptNotice notice([&] { return progress.interruption(); });
  const auto prepared = prepare(scene, arguments.seed, fs::exists(files.checkpoint));
  System system = prepared.start(0);
  const auto integrator = find_method(choice.name)->make(choice.options);

  const double islands =
      static_cast<double>(scene.particles) / static_cast<double>(prepared.island_size());
  Trajectory trajectory(files.trajectory, arguments.time_step);
  Fields fields(system, bins);
  Monitor monitor(system, arguments.time_step, prepared.kinetic_degrees() * islands);
  std::vector<Observation> observations = {{"trajectory", &trajectory, steps.every, 0},
                                           {"monitor", &monitor, steps.sample_every, 0}};
  if (with_fields) {
    observations.push_back({"fields", &fields, steps.sample_every, steps.equilibrate});
  }
  const json identity = {
      {"scene", to_json(scene)}, {"method", to_json(choice)}, {"seed", arguments.seed}};
  LongRunPlan plan;
  plan.identity = identity;
  plan.time_step = arguments.time_step;
  plan.last = steps.all;
  plan.checkpoint_every = arguments.checkpoint_every;
  plan.progress = &progress;

  check_checkpoint(plan, observations, files.checkpoint);
  make_output_folder(files.folder, "");
  const auto end = long_run(system, *integrator, plan, observations, files.checkpoint, threads);

  json run = identity;
  run["time_step"] = arguments.time_step;
  run["steps"] = steps.all;
  if (with_fields) write_json(files.fields, fields.to_json(), "driftless-fields/1", run);
  write_json(files.monitor, monitor.to_json(), "driftless-monitor/1", run);
  const json counters = {{"pair_evaluations", end.counters.pair_evaluations},
                         {"random_numbers", end.counters.random_numbers},
                         {"solver_iterations", end.counters.solver_iterations}};
  write_json(files.run,
             {{"counters", counters},
              {"provenance", provenance(threads, arguments.seed, arguments.command)}},
             "driftless-run/1", run);

  std::string text =
      fmt::format("{} by {}: {} steps of {}, to time {}\n", scene.name, arguments.method, steps.all,
                  describe(arguments.time_step), describe(arguments.duration));
  text += last_values(monitor) + "\n";
  text +=
      fmt::format("Trajectory: {} ({} frames)\n", files.trajectory.string(), trajectory.frames());
  if (with_fields) {
    text += fmt::format("Fields: {} ({} samples)\n", files.fields.string(), fields.samples());
  }
  text += fmt::format("Monitor: {}\nCheckpoint: {}\n", files.monitor.string(),
                      files.checkpoint.string());
  return text;
}

}  // namespace driftless
