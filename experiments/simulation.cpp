#include "experiments/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/json_text.hpp"
#include "experiments/judge/judge.hpp"
#include "experiments/nearest.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/text_file.hpp"

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
      place.refuse("is " + describe(json(text)) + ", neither a preset nor a file" +
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
  const MethodChoice choice = judge::read_method_option(text);
  if (const auto reason = refusal(*find_method(choice.name), Fluid(scene.fluid), choice.options)) {
    argument("--method")
        .refuse("is " + describe(json(text)) + ", which cannot run this scene: " + *reason);
  }
  return choice;
}

/// Turns simulated times into whole steps.
class StepCounter {
 public:
  explicit StepCounter(double time_step) : time_step_(time_step) {
    ValueRule::positive().check(json(time_step), argument("--time-step"));
  }

  std::uint64_t operator()(double time, const std::string& name, const ValueRule& rule) const {
    const Location place = argument(name);
    rule.check(json(time), place);
    const double steps = std::round(time / time_step_);
    if (steps > most_steps) {
      place.refuse(fmt::format("is {}, which takes {:.3g} steps; allowed is at most 1e12 of them",
                               describe(time), steps));
    }
    if (std::abs(steps * time_step_ - time) > 1e-9 * time) {
      place.refuse(fmt::format(
          "is {}, no whole number of time steps of {}; allowed is for example {}", describe(time),
          describe(time_step_), describe(std::max(1.0, steps) * time_step_)));
    }
    return static_cast<std::uint64_t>(steps);
  }
  /// `usual` where no time is given.
  std::uint64_t operator()(const std::optional<double>& time, const std::string& name,
                           std::uint64_t usual) const {
    if (!time) return std::max<std::uint64_t>(1, usual);
    return (*this)(*time, name, ValueRule::positive());
  }

 private:
  double time_step_;
};

void read_times(const SimulateArguments& arguments, Simulation& simulation) {
  const StepCounter count(arguments.time_step);
  simulation.steps = count(arguments.duration, "--duration", ValueRule::positive());
  const auto frames = std::clamp<std::uint64_t>(
      usual_particles_written / simulation.scene.particles, 2, usual_frames);
  simulation.every = count(arguments.every, "--every", simulation.steps / frames);
  simulation.sample_every =
      count(arguments.sample_every, "--sample-every", simulation.steps / usual_samples);
  simulation.equilibrate = count(arguments.equilibrate, "--equilibrate", ValueRule::not_negative());
  if (simulation.equilibrate < simulation.steps) return;
  argument("--equilibrate")
      .refuse(fmt::format("is {}; allowed is a number >= 0 and < {}, the duration",
                          describe(arguments.equilibrate), describe(arguments.duration)));
}

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

/// Fields have no meaning for pairs, whose velocities have one direction and are opposite.
bool read_has_fields(const SimulateArguments& arguments, const Scene& scene) {
  if (scene.layout != Layout::pairs) return true;
  if (!arguments.fields.empty()) {
    argument("--fields")
        .refuse("is " + describe(json(arguments.fields)) +
                ", but the scene is one of isolated pairs, which have no fields; "
                "allowed is to leave it out");
  }
  return false;
}

fs::path usual_folder(const SimulateArguments& arguments, const Scene& scene) {
  std::string name = scene.name + "-" + arguments.method;
  for (const char separator : {'/', ' ', ':'})
    std::replace(name.begin(), name.end(), separator, '-');
  return fs::path("driftless-results") / name;
}

/// Names the files one after the other, each of them once.
class FileNames {
 public:
  explicit FileNames(fs::path folder) : folder_(std::move(folder)) {}

  fs::path choose(const std::string& given, const char* name, const char* usual) {
    const fs::path path = given.empty() ? folder_ / usual : fs::path(given);
    const std::string shown = "is " + describe(json(path.string()));
    std::error_code error;
    if (!given.empty() && path.has_parent_path() && !fs::is_directory(path.parent_path(), error)) {
      argument(name).refuse(shown + ", in a folder that does not exist; allowed is a file in one " +
                            "that does");
    }
    if (fs::is_directory(path, error)) {
      argument(name).refuse(shown + ", a folder; allowed is a file");
    }
    if (std::find(taken_.begin(), taken_.end(), path.lexically_normal()) != taken_.end()) {
      argument(name).refuse(shown + ", which another output is written to; allowed is a file of " +
                            "its own");
    }
    taken_.push_back(path.lexically_normal());
    return path;
  }

 private:
  fs::path folder_;
  std::vector<fs::path> taken_;
};

SimulationFiles read_files(const SimulateArguments& arguments, const Scene& scene) {
  SimulationFiles files;
  files.folder =
      arguments.directory.empty() ? usual_folder(arguments, scene) : fs::path(arguments.directory);
  FileNames names(files.folder);
  files.run = names.choose("", "--output", "run.json");
  files.trajectory = names.choose(arguments.trajectory, "--trajectory", "trajectory.xyz");
  files.fields = names.choose(arguments.fields, "--fields", "fields.json");
  files.monitor = names.choose(arguments.monitor, "--monitor", "monitor.json");
  files.checkpoint = names.choose(arguments.checkpoint, "--checkpoint", "checkpoint.cbor");
  return files;
}

}  // namespace

Simulation read_simulation(const SimulateArguments& arguments) {
  Simulation simulation;
  simulation.scene = read_simulated_scene(arguments.scene);
  simulation.method = read_simulated_method(arguments.method, simulation.scene);
  // Beyond 2^53 other readers of JSON round whole numbers.
  ValueRule::integer(0, (std::uint64_t{1} << 53U) - 1)
      .check(json(arguments.seed), argument("--seed"));
  ValueRule::not_negative().check(json(arguments.checkpoint_every), argument("--checkpoint-every"));
  read_times(arguments, simulation);
  simulation.bins = read_bins(arguments.bins);
  simulation.has_fields = read_has_fields(arguments, simulation.scene);
  simulation.files = read_files(arguments, simulation.scene);
  return simulation;
}

}  // namespace driftless
