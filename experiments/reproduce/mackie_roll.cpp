#include "experiments/reproduce/mackie_roll.hpp"

#include <cmath>
#include <numbers>

#include "experiments/checkpoint.hpp"
#include "experiments/fields.hpp"
#include "experiments/scene_keys.hpp"
#include "model/initial.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

constexpr double sample_every = 1;
constexpr std::size_t bins = 24;

/// The place of the hot wall; the cold one's is the next.
std::size_t hot_face(const RollRun& run) { return run.hot_wall == HotWall::floor ? 4 : 0; }

/// The scene mackie-1999-roll, less deep, whose reservoirs are on the left and on the right, or
/// these walls and the other two exchanged.
Box roll_box(const RollRun& run) {
  Scene scene = find_preset("mackie-1999-roll")->scene;
  const double side = roll_side();
  if (run.hot_wall == HotWall::floor) {
    std::swap(scene.walls[0], scene.walls[4]);
    std::swap(scene.walls[1], scene.walls[5]);
  }
  return {Vector(side, static_cast<double>(run.particles) / (side * side), side), scene.walls,
          Vector(0, 0, -run.gravity)};
}

class RollSeries : public Observer {
 public:
  RollSeries(double time_step, std::size_t hot_face) : time_step_(time_step), hot_face_(hot_face) {}

  void sample(System& system, std::uint64_t step) override {
    const auto& received = system.motion().surroundings;
    values_.insert(values_.end(),
                   {static_cast<double>(step) * time_step_, roll_flow(system),
                    system.kinetic_energy(), system.internal_energy(), system.potential_energy(),
                    received[hot_face_].energy, received[hot_face_ + 1].energy});
  }
  json save() override { return {{"values", to_bytes(values_)}}; }
  void load(const json& saved) override { values_ = from_bytes<double>(saved.at("values")); }
  json to_json() const {
    static const std::vector<std::string> names = {"time",      "roll", "kinetic", "internal",
                                                   "potential", "hot",  "cold"};
    json columns = json::object();
    for (std::size_t n = 0; n < values_.size(); ++n) {
      columns[names[n % names.size()]].push_back(values_[n]);
    }
    return columns;
  }

 private:
  double time_step_;
  std::size_t hot_face_;
  std::vector<double> values_;
};

}  // namespace

double roll_side() { return std::cbrt(static_cast<double>(roll_particles)); }

double roll_flow(const System& system) {
  const State& state = system.state();
  const double x_wave = std::numbers::pi / system.box().lengths[0];
  const double z_wave = std::numbers::pi / system.box().lengths[2];
  double sum = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double x = state.position[i][0] * x_wave, z = state.position[i][2] * z_wave;
    sum += system.mass(i) * (state.velocity[i][0] * std::sin(x) * std::cos(z) -
                             state.velocity[i][2] * std::cos(x) * std::sin(z));
  }
  // The velocity of the roll has a mean square of (psi_0 pi/L)^2/2 in a square section.
  return 2 * sum / (x_wave * system.box().volume());
}

json run_roll(const RollRun& run, std::uint64_t seed, const Workplace& workplace) {
  const auto fluid = mackie_parameters(mackie_gas);
  const Box box = roll_box(run);
  const Noise noise(seed, 0);
  System system(Fluid(fluid), box, mackie_in_law(fluid, box, run.particles, run.start, 0, noise),
                noise);
  RollSeries series(run.time_step, hot_face(run));
  Fields fields(system, {bins, 1, bins});
  const auto steps = [&](double time) {
    return static_cast<std::uint64_t>(std::llround(time / run.time_step));
  };
  run_box(system, run.method, run.time_step, run.duration,
          {{"series", &series, steps(sample_every), 0},
           {"fields", &fields, steps(sample_every), steps(run.settle)}},
          workplace,
          {{"seed", seed},
           {"method", to_string(run.method)},
           {"particles", run.particles},
           {"gravity", run.gravity},
           {"start", run.start},
           {"hot_face", hot_face(run)}});
  return {{"series", series.to_json()}, {"fields", fields.to_json()}};
}

json run_step_check(const MethodChoice& method, double time_step, std::uint64_t seed) {
  constexpr std::size_t particles = 1000;
  constexpr double settle = 10, duration = 60;
  const auto fluid = mackie_parameters(mackie_gas);
  const Box box{Vector::Constant(10)};
  const Noise noise(seed, 0);
  System system(Fluid(fluid), box, mackie_in_law(fluid, box, particles, 1, 0, noise), noise);
  BoxSeries series(time_step);
  const auto every = static_cast<std::uint64_t>(std::llround(0.2 / time_step));
  const auto from = static_cast<std::uint64_t>(std::llround(settle / time_step));
  try {
    run_box(system, method, time_step, duration, {{"series", &series, every, from}}, {});
  } catch (const LongRunFailure& failure) {
    return {{"failure", failure.what()}};
  }
  const auto all = series.to_json();
  return {{"kinetic", all["kinetic"]}, {"inverse", all["inverse"]}, {"particles", particles}};
}

}  // namespace driftless::reproduce
