#include "experiments/judge/stability_scene.hpp"

#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <tuple>

#include "model/configurations.hpp"

namespace driftless::judge {
namespace {

using std::numbers::pi;

constexpr std::size_t particles = 125;
constexpr double collision_times = 20;

/// Positions under a repulsion, drawn once in a process: the chain takes longer than most runs.
State soft_positions(const Fluid& fluid, const Box& box, const Noise& noise) {
  // Enough for the lattice to be forgotten: a path moves a particle by half a diameter.
  constexpr int relaxation_paths = 30, canonical_paths = 40;
  ConfigurationChain chain(
      fluid, box, place(box, Layout::fluid, Placement::lattice, particles, 0, noise), noise);
  for (int path = 0; path < relaxation_paths; ++path) chain.relax();
  for (int path = 0; path < canonical_paths; ++path) chain.advance_canonical();
  return chain.system().state();
}

State positions(const StabilityPoint& point, const Fluid& fluid, const Box& box, std::uint64_t seed,
                unsigned replica) {
  const Noise noise(seed, replica);
  if (!fluid.has_repulsion()) {
    return place(box, Layout::fluid, Placement::random, particles, 0, noise);
  }
  static std::mutex mutex;
  static std::map<std::tuple<double, double, std::uint64_t, unsigned>, State> drawn;
  const std::lock_guard lock(mutex);
  auto& state = drawn[{point.density, point.repulsion, seed, replica}];
  if (state.size() == 0) state = soft_positions(fluid, box, noise);
  return state;
}

/// Scales what every particle has to the temperature of its half, and stops the whole again.
void heat_one_half(const Box& box, double ratio, State& state) {
  const double cold = 2 / (1 + ratio);
  Vector mean = Vector::Zero();
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double temperature = state.position[i][0] < box.lengths[0] / 2 ? ratio * cold : cold;
    state.velocity[i] *= std::sqrt(temperature);
    state.internal_energy[i] *= temperature;
    mean += state.velocity[i] / static_cast<double>(state.size());
  }
  for (auto& velocity : state.velocity) velocity -= mean;
}

}  // namespace

const std::vector<StabilityAxis>& stability_axes() {
  using P = StabilityPoint;
  static const std::vector<StabilityAxis> axes = {
      {"heat capacity",
       "heat capacity phi/k",
       &P::heat_capacity,
       {1, 3, 10, 60, 250, 1000},
       {1, 1.5, 2, 3, 5, 10, 20, 60, 120, 250, 500, 1000}},
      {"friction",
       "friction zeta_0",
       &P::friction,
       {0.45, 4.5, 45, 450},
       {0.45, 1, 2, 4.5, 10, 20, 45, 100, 200, 450}},
      {"conduction",
       "conduction rate L_0/(phi T^2)",
       &P::conduction,
       {0.1, 1, 10, 100},
       {0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100}},
      {"density", "number density", &P::density, {1, 3, 10}, {1, 1.5, 2, 3, 4, 5, 7, 10}},
      {"repulsion", "repulsion a", &P::repulsion, {0, 25, 100}, {0, 5, 12.5, 25, 50, 75, 100}},
      {"temperature ratio",
       "temperature ratio of the halves",
       &P::temperature_ratio,
       {1, 3, 10, 100},
       {1, 2, 3, 5, 10, 20, 50, 100}}};
  return axes;
}

FluidParameters stability_fluid(const StabilityPoint& point, FrictionClosure closure) {
  FluidParameters fluid;
  fluid.heat_capacity = point.heat_capacity;
  fluid.repulsion = point.repulsion;
  fluid.friction = point.friction;
  fluid.friction_closure = closure;
  fluid.conduction = point.conduction * point.heat_capacity;
  fluid.heat_form = HeatForm::inverse_temperature;
  return fluid;
}

double collision_time(const StabilityPoint& point) {
  return 3 / (point.density * point.friction * 2 * pi / 15);
}

StabilityStart stability_start(const StabilityPoint& point, FrictionClosure closure,
                               std::uint64_t seed, unsigned replica) {
  const Fluid fluid(stability_fluid(point, closure));
  const Box box = make_box(fluid, Layout::fluid, particles, point.density, 0);
  const auto law = microcanonical_law(fluid, Layout::fluid, particles);
  const Noise noise(seed, replica);
  State state = positions(point, fluid, box, seed, replica);
  draw_microcanonical(fluid, Layout::fluid, law.energy_at(1), noise, state);
  if (point.temperature_ratio != 1) heat_one_half(box, point.temperature_ratio, state);
  System system(fluid, box, std::move(state), noise);
  const double energy = system.kinetic_energy() + system.internal_energy();
  const double kinetic = law.kinetic_energy(energy);
  return {std::move(system), collision_times * collision_time(point), kinetic, energy - kinetic};
}

PositivityEstimates positivity_estimates(const StabilityPoint& point) {
  const double neighbours = 4 * pi / 3 * point.density;
  // Between the halves the temperature changes within a range, at 1 on average.
  const double ratio = point.temperature_ratio, gradient = 2 * (ratio - 1) / (ratio + 1);
  PositivityEstimates estimates;
  if (point.conduction == 0) return estimates;
  if (gradient > 0) estimates.conduction = 1 / (point.conduction * neighbours * gradient);
  estimates.noise = point.heat_capacity / (point.conduction * neighbours * neighbours);
  return estimates;
}

}  // namespace driftless::judge
