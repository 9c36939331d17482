#pragma once

#include <algorithm>
#include <numeric>

#include "experiments/judge/small_system.hpp"

/// A dense system in a box of several tiles of cells along each axis, and other orders of
/// particles.
namespace driftless::judge {

inline Box wide_box() { return {Vector(12.3, 9.4, 5.7)}; }

/// 1977 particles with shuffled ids.
inline State wide_state(const FluidParameters& fluid) {
  Uniform uniform(11);
  State state;
  const auto particles = static_cast<std::uint32_t>(3 * wide_box().volume());
  for (std::uint32_t i = 0; i < particles; ++i) {
    state.position.push_back(uniform.vector(0, 1).cwiseProduct(wide_box().lengths));
    state.velocity.push_back(uniform.vector(-1.5, 1.5));
    state.internal_energy.push_back(fluid.heat_capacity * fluid.temperature * uniform(0.8, 1.2));
    state.id.push_back(i);
  }
  std::shuffle(state.id.begin(), state.id.end(), uniform.engine());
  return state;
}

inline FluidParameters wide_fluid(FrictionClosure closure) {
  auto f = small_fluid({closure, HeatForm::temperature, true}, 0.1);
  f.heat_capacity = 60;
  f.friction = 2;
  return f;
}

inline System wide_system(const FluidParameters& f, const State& state, unsigned threads = 1) {
  System system(Fluid(f), wide_box(), state, Noise(5, 1));
  system.set_threads(threads);
  return system;
}

/// The places 0..size-1 in another order.
inline std::vector<std::size_t> shuffled_places(std::size_t size, std::uint64_t seed) {
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), std::size_t{0});
  Uniform uniform(seed);
  std::shuffle(order.begin(), order.end(), uniform.engine());
  return order;
}

/// The same particles, stored otherwise: at place n the one that was at order[n].
inline State in_order(const State& state, const std::vector<std::size_t>& order) {
  State permuted;
  for (const std::size_t place : order) {
    permuted.position.push_back(state.position[place]);
    permuted.velocity.push_back(state.velocity[place]);
    permuted.internal_energy.push_back(state.internal_energy[place]);
    permuted.id.push_back(state.id[place]);
    if (!state.species.empty()) permuted.species.push_back(state.species[place]);
  }
  return permuted;
}

}  // namespace driftless::judge
