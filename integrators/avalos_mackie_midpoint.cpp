#include "integrators/end_point_iteration.hpp"
#include "integrators/methods.hpp"

namespace driftless {
namespace {

/// The implicit algorithm of Bonet Avalos and Mackie (1999, eqs. 2.4-2.6) with the midpoint
/// velocity in the whole work of a pair, dissipative work included (a derived variant), primes at t
/// + dt:
///   r' = r + v dt
///   p' = p + sum_j {F^C dt + f e},  f = -zeta v dt + Gamma' dt^{1/2} W
///   u' = u + sum_j {-1/2 f (v + v')/2 + q}
/// Kinetic plus internal energy is conserved to rounding in any N-body step without a potential;
/// momentum always.
class AvalosMackieMidpoint : public Integrator {
 public:
  explicit AvalosMackieMidpoint(double tolerance) : tolerance_(tolerance) {}

  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    iteration_.step(
        system, dt, tolerance_,
        [&](const auto& start, const auto& end) {
          return end_point_momentum(fluid, start, end, dt);
        },
        [&](const auto& start, const auto& end, const auto& momentum) {
          auto total = end_point_conduction(fluid, start, end, dt);
          const auto f = momentum - fluid.repulsive_force(start) * dt;
          return total += midpoint_work(f, start, end);
        });
  }

 private:
  double tolerance_;
  EndPointIteration iteration_;
};

}  // namespace

const Method avalos_mackie_midpoint = {
    .name = "avalos-mackie-midpoint",
    .title = "Implicit, midpoint work (after Avalos-Mackie 1999)",
    .reference =
        "after Bonet Avalos, Mackie, J. Chem. Phys. 111, 5267 (1999), eqs. 2.4-2.6, with "
        "the midpoint velocity in all work",
    .conserves = "momentum; energy to rounding without a potential",
    .energy_ideal = EnergyClaim::exact,
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = {{"tolerance", 1e-12, "largest change of u', as a share of the mean energy"}},
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<AvalosMackieMidpoint>(
          option<double>(avalos_mackie_midpoint, options, "tolerance"));
    }};

}  // namespace driftless
