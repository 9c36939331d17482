#include "integrators/flows.hpp"
#include "integrators/methods.hpp"

namespace driftless {
namespace {

/// Collide, then stream [Marsh, Coveney, J. Phys. A 31, 6561 (1998), eqs. 10-13, with
/// A_R^2 = A_D in eq. 13 and friction (m sigma^2/4)(1/theta_i + 1/theta_j), eq. 26]:
///   p' = p + sum_j {F^C dt - zeta v e dt + Gamma e dt^{1/2} W}
///   u' = u + sum_j {1/2 [zeta v^2 - Gamma^2/(2 mu)] dt - 1/2 v Gamma dt^{1/2} W + q}
///   r' = r + v' dt
/// Conserves momentum; energy in the mean only, to O(dt). In an isothermal fluid it is the scheme
/// of Marsh and Coveney's isothermal model: a pair alone then has 1/(1 - zeta dt/(2 mu)) of the
/// right variance of v (derived).
class MarshCoveney : public Integrator {
 public:
  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    system.accumulate([&](const auto& pair) { return euler_exchange(fluid, pair, dt); }, exchange_);
    system.apply(exchange_);
    system.move(dt);
  }

 private:
  Exchange exchange_;
};

}  // namespace

const Method marsh_coveney = {
    .name = "marsh-coveney",
    .title = "Collide, then stream (Marsh-Coveney 1998)",
    .reference = "Marsh, Coveney, J. Phys. A 31, 6561 (1998), eqs. 10-13, 26",
    .conserves = "momentum; energy in the mean, to first order",
    .isothermal = true,
    .closures = {FrictionClosure::noise},
    .make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<MarshCoveney>();
    }};

}  // namespace driftless
