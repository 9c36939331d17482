#include "experiments/flux/periodic_fluid.hpp"

#include <cmath>
#include <stdexcept>

#include "model/configurations.hpp"
#include "model/initial.hpp"

namespace driftless::flux {
namespace {

constexpr int settling_paths = 60;

}  // namespace

std::size_t PeriodicFluid::particles() const {
  return static_cast<std::size_t>(std::llround(density * box().volume()));
}

System equilibrium_start(const PeriodicFluid& setting, std::uint64_t replica) {
  const Noise noise(setting.seed, replica);
  const Fluid fluid(setting.fluid);
  const bool potential = fluid.has_repulsion();
  State state =
      place(setting.box(), Layout::fluid, potential ? Placement::lattice : Placement::random,
            setting.particles(), 0, noise);
  if (potential) {
    auto at_start = setting.fluid;
    at_start.temperature = setting.temperature;
    at_start.thermal_repulsion *= setting.temperature / setting.fluid.temperature;
    ConfigurationChain chain(Fluid(at_start), setting.box(), state, noise);
    for (int path = 0; path < settling_paths; ++path) chain.relax();
    for (int path = 0; path < settling_paths; ++path) chain.advance_canonical();
    state = chain.system().state();
  }
  const auto law = microcanonical_law(fluid, Layout::fluid, state.size());
  draw_microcanonical(fluid, Layout::fluid, law.energy_at(setting.temperature), noise, state);
  return {fluid, setting.box(), std::move(state), noise};
}

Run::Run(const PeriodicFluid& setting, std::uint64_t replica)
    : system_(equilibrium_start(setting, replica)), step_size_(setting.step) {
  const Method* method = find_method(setting.method.name);
  if (method == nullptr) throw std::invalid_argument("there is no method " + setting.method.name);
  method_ = method->make(setting.method.options);
}

void Run::step() {
  system_.set_step(++steps_);
  method_->step(system_, step_size_);
}

std::uint64_t Run::steps_in(double duration) const {
  return static_cast<std::uint64_t>(std::llround(duration / step_size_));
}

nlohmann::json to_record(const Estimate& estimate) {
  return {{"mean", estimate.mean}, {"error", estimate.error}};
}

}  // namespace driftless::flux
