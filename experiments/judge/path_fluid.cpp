#include "experiments/judge/path_fluid.hpp"

#include "model/initial.hpp"

namespace driftless::judge {
namespace {

constexpr std::size_t particles = 27;
constexpr double density = 1;

FluidParameters parameters(const PathFluid& chosen) {
  FluidParameters f;  // nothing that could hide a misplaced power is 1
  f.boltzmann = 0.5;
  f.mass = 2.4;
  f.temperature = 1.3;
  f.heat_capacity = 20 * f.boltzmann;
  f.friction = 4 * f.mass;
  f.friction_closure = chosen.closure;
  if (chosen.conducts) {
    f.heat_form = HeatForm::inverse_temperature;
    f.conduction = 2 * f.heat_capacity * f.temperature * f.temperature;
  }
  return f;
}

System start(const Fluid& fluid, const PathRun& run) {
  Noise noise(run.seed, run.replica);
  const Box box = make_box(fluid, Layout::fluid, particles, density, 0);
  State state = place(box, Layout::fluid, Placement::random, particles, 0, noise);
  const auto law = microcanonical_law(fluid, Layout::fluid, particles);
  const double energy = law.energy_at(fluid.parameters().temperature);
  if (run.start == PathStart::exact) {
    draw_microcanonical(fluid, Layout::fluid, energy, noise, state);
  } else {
    draw_off_equilibrium(fluid, Layout::fluid, energy, noise, state);
  }
  noise.set_refinement(run.cells);
  return {fluid, box, std::move(state), noise};
}

}  // namespace

Fluid PathFluid::fluid() const { return Fluid(parameters(*this)); }

std::string PathFluid::name() const {
  return "closure " + std::string(to_string(closure)) +
         (conducts ? ", with conduction" : ", without conduction");
}

std::vector<PathFluid> path_fluids(const Candidate& candidate) {
  std::vector<PathFluid> all;
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    for (const bool conducts : {false, true}) {
      const PathFluid fluid{closure, conducts};
      if (!refusal(candidate.method(), fluid.fluid())) all.push_back(fluid);
    }
  }
  return all;
}

std::vector<State> run_on_path(const PathFluid& fluid, const Candidate& candidate,
                               const PathRun& run) {
  System system = start(fluid.fluid(), run);
  const auto integrator = candidate.make();
  std::vector<State> states;
  for (std::uint64_t step = 1; step <= run.steps; ++step) {
    system.set_step(step);
    integrator->step(system, run.step);
    if (step % run.interval == 0) states.push_back(system.state());
  }
  return states;
}

bool draws_uniforms(const Candidate& candidate, const PathFluid& chosen) {
  auto cold = parameters(chosen);
  const PathRun one{.step = 1e-6};
  // Without fluctuations no normals are drawn: whatever is, is a uniform variate.
  System warm = start(Fluid(cold), one);
  cold.boltzmann = 0;
  System system(Fluid(cold), warm.box(), warm.state(), Noise(one.seed, one.replica));
  system.set_step(1);
  candidate.make()->step(system, one.step);
  return system.counters().random_numbers > 0;
}

double kinetic_energy_of(const Fluid& fluid, const State& state) {
  double sum = 0;
  for (const auto& velocity : state.velocity) sum += velocity.squaredNorm();
  const double unit = fluid.boltzmann() * fluid.parameters().temperature;
  return 0.5 * fluid.mass() * sum / unit / static_cast<double>(state.size());
}

double energy_variance_of(const Fluid& fluid, const State& state) {
  const auto count = static_cast<double>(state.size());
  double mean = 0, squares = 0;
  for (const double u : state.internal_energy) mean += u / count;
  for (const double u : state.internal_energy) squares += (u - mean) * (u - mean);
  const auto& f = fluid.parameters();
  return squares / count / (f.heat_capacity * f.boltzmann * f.temperature * f.temperature);
}

}  // namespace driftless::judge
