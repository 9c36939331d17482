#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "integrators/integrator.hpp"

/// Small dense systems on which every term of the model acts, and what is done with them.
namespace driftless::judge {

/// Uniform variates of [0, 1) that are the same with every standard library.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double operator()(double from, double to) { return from + (to - from) * (*this)(); }
  Vector vector(double from, double to) {
    const double x = (*this)(from, to), y = (*this)(from, to), z = (*this)(from, to);
    return {x, y, z};
  }
  /// One of 0..count-1.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
};

/// A choice of terms, with a name for messages.
struct Terms {
  FrictionClosure closure = FrictionClosure::noise;
  HeatForm heat = HeatForm::none;
  bool potential = false;
  bool isothermal = false;

  std::string name() const {
    return "closure " + std::string(to_string(closure)) + ", heat " + std::string(to_string(heat)) +
           (potential ? ", with a potential" : ", without a potential") +
           (isothermal ? ", isothermal" : "");
  }
};

inline const std::vector<HeatForm>& all_heat_forms() {
  static const std::vector<HeatForm> all = {HeatForm::none, HeatForm::inverse_temperature,
                                            HeatForm::temperature};
  return all;
}

/// A fluid whose terms all matter within half a unit of time; ranges differ, none is above 1.
inline FluidParameters small_fluid(const Terms& terms, double boltzmann) {
  FluidParameters f;
  f.boltzmann = boltzmann;
  f.mass = 1.25;
  f.temperature = 1.1;
  f.heat_capacity = 12;
  f.repulsion = terms.potential ? 15 : 0;
  f.repulsion_range = 0.9;
  f.friction = 4;
  f.friction_closure = terms.closure;
  f.conduction = terms.heat == HeatForm::none ? 0 : 6;
  f.heat_form = terms.heat;
  f.heat_range = 0.95;
  f.isothermal = terms.isothermal;
  return f;
}

inline Box small_box() { return {Vector::Constant(3)}; }

/// 27 particles on a shaken lattice in small_box(), with velocities of order 1, no momentum, and
/// internal energies between half and one and a half times the mean; isothermal, without these.
inline State small_state(const FluidParameters& fluid, std::uint64_t seed = 1) {
  Uniform uniform(seed);
  const Box box = small_box();
  State state;
  Vector mean = Vector::Zero();
  for (std::uint32_t i = 0; i < 27; ++i) {
    const Vector site(i % 3, i / 3 % 3, i / 9);
    state.position.push_back(box.wrap(site + uniform.vector(-0.25, 0.25)));
    state.velocity.push_back(uniform.vector(-1.5, 1.5));
    state.internal_energy.push_back(fluid.heat_capacity * fluid.temperature * uniform(0.5, 1.5));
    if (fluid.isothermal) state.internal_energy.back() = 0;
    state.id.push_back(i);
    mean += state.velocity.back() / 27;
  }
  for (auto& velocity : state.velocity) velocity -= mean;
  return state;
}

/// Steps `from` to `to` (exclusive) of a run, as a run numbers them: from 1.
inline void run(Integrator& integrator, System& system, double step_size, std::uint64_t from,
                std::uint64_t to) {
  for (std::uint64_t step = from; step < to; ++step) {
    system.set_step(step);
    integrator.step(system, step_size);
  }
}

/// `steps` steps of a method from a state.
inline State run(const Method& method, const FluidParameters& fluid, const State& start,
                 double step_size, std::uint64_t steps, std::uint64_t seed = 7,
                 const Options& options = {}) {
  System system(Fluid(fluid), small_box(), start, Noise(seed, 0));
  const auto integrator = method.make(options);
  run(*integrator, system, step_size, 1, steps + 1);
  return system.state();
}

/// Largest differences between two states of the same particles in the same storage, positions by
/// the shortest image.
struct Distance {
  double position = 0, velocity = 0, internal_energy = 0;
  double largest() const { return std::max({position, velocity, internal_energy}); }
};

inline Distance distance(const Box& box, const State& a, const State& b) {
  Distance d;
  for (std::size_t i = 0; i < a.size(); ++i) {
    d.position = std::max(d.position,
                          box.minimum_image(a.position[i] - b.position[i]).cwiseAbs().maxCoeff());
    d.velocity = std::max(d.velocity, (a.velocity[i] - b.velocity[i]).cwiseAbs().maxCoeff());
    d.internal_energy =
        std::max(d.internal_energy, std::abs(a.internal_energy[i] - b.internal_energy[i]));
  }
  return d;
}

inline bool same_bits(const State& a, const State& b) {
  return a.position == b.position && a.velocity == b.velocity &&
         a.internal_energy == b.internal_energy && a.id == b.id;
}

}  // namespace driftless::judge
