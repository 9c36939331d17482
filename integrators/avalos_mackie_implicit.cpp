#include "integrators/end_point_iteration.hpp"
#include "integrators/methods.hpp"

namespace driftless {
namespace {

/// Implicit algorithm with end-point noise amplitudes [Bonet Avalos, Mackie, J. Chem. Phys. 111,
/// 5267 (1999), eqs. 2.4-2.6], primes at t + dt, weights at t, solved by fixed-point iteration:
///   r' = r + v dt
///   p' = p + sum_j {F^C dt - zeta v e dt + Gamma' e dt^{1/2} W}
///   u' = u + sum_j {1/2 zeta v^2 dt - 1/2 (v_i - v_j').e Gamma' dt^{1/2} W + q}
/// The end-point amplitudes carry the noise-induced drift, so either closure is met without a term.
/// The random work, summed over a pair, is the work at the midpoint velocity; `symmetric_work`
/// gives each particle half of that sum. Conserves momentum; energy to O(dt^{3/2}) per step, with a
/// mean of O(dt^2): it drifts.
class AvalosMackieImplicit : public Integrator {
 public:
  AvalosMackieImplicit(bool symmetric_work, double tolerance)
      : symmetric_work_(symmetric_work), tolerance_(tolerance) {}

  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    iteration_.step(
        system, dt, tolerance_,
        [&](const auto& start, const auto& end) {
          return end_point_momentum(fluid, start, end, dt);
        },
        [&](const auto& start, const auto& end, const auto&) {
          auto total = end_point_conduction(fluid, start, end, dt);
          if (fluid.has_friction()) total += heating(fluid, start, end, dt);
          return total;
        });
  }

 private:
  template <class V>
  Transfer<V> heating(const Fluid& fluid, const Pair<V>& start, const TrialPair<V>& end,
                      double dt) const {
    using std::sqrt;
    const V kick = sqrt(fluid.friction(end).noise_squared * dt) * start.noise;
    const V dissipated = 0.5 * fluid.friction(start).friction * start.v * start.v * dt;
    if (symmetric_work_) {
      return midpoint_work(kick, start, end) += Transfer<V>{V(0), dissipated, dissipated};
    }
    const V v_i_to_new_j = start.v - end.dv_j;  // (v_i - v_j').e
    const V v_new_i_to_j = start.v + end.dv_i;  // (v_i' - v_j).e
    return {V(0), dissipated - 0.5 * kick * v_i_to_new_j, dissipated - 0.5 * kick * v_new_i_to_j};
  }

  bool symmetric_work_;
  double tolerance_;
  EndPointIteration iteration_;
};

}  // namespace

const Method avalos_mackie_implicit = {
    .name = "avalos-mackie-implicit",
    .title = "Implicit, end-point noise (Avalos-Mackie 1999)",
    .reference = "Bonet Avalos, Mackie, J. Chem. Phys. 111, 5267 (1999), eqs. 2.4-2.6",
    .conserves = "momentum; energy to O(dt^{3/2}) a step, drifting",
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = {{"symmetric_work", false, "share the random work of a pair equally"},
                {"tolerance", 1e-12, "largest change of u', as a share of the mean energy"}},
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<AvalosMackieImplicit>(
          option<bool>(avalos_mackie_implicit, options, "symmetric_work"),
          option<double>(avalos_mackie_implicit, options, "tolerance"));
    }};

}  // namespace driftless
