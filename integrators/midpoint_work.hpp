#pragma once

#include "integrators/flows.hpp"

namespace driftless {

/// Friction and conduction of all pairs at once from the state as it stands, kinetic energy put
/// back at the midpoint velocities:
///   f = -(zeta + induced) v dt + Gamma dt^{1/2} W,  v_i' = v_i + sum_j f_ij e/m
///   u_i' = u_i - sum_j (1/2) f_ij (v + v')/2 + q
/// As sum_i m (v_i'^2 - v_i^2)/2 = sum_pairs f_ij (v + v')/2, kinetic plus internal energy is kept
/// to rounding.
class MidpointWork {
 public:
  void step(System& system, double dt) {
    const Fluid& fluid = system.fluid();
    const auto momentum = [&](const auto& pair) {
      return fluid.has_friction() ? euler_friction(fluid, pair, dt).momentum : decltype(pair.v)(0);
    };
    system.accumulate([&](const auto& pair) { return Transfer{momentum(pair)}; }, exchange_);
    system.accumulate(
        exchange_,
        [&](const auto& start, const auto& end) {
          const auto f = momentum(start);
          auto total = midpoint_work(f, start, end);
          total.momentum = f;
          if (fluid.has_conduction()) total += euler_conduction(fluid, start, dt);
          return total;
        },
        exchange_);
    system.apply(exchange_);
  }

 private:
  Exchange exchange_;
};

}  // namespace driftless
