#include "integrators/flows.hpp"
#include "integrators/methods.hpp"

namespace driftless {
namespace {

/// Ito Euler-Maruyama with noise amplitudes that depend on the distance alone, so that nothing is
/// noise-induced [Espanol, Europhys. Lett. 40, 631 (1997)]:
///   r' = r + v dt
///   p' = p + sum_j {F^C dt - zeta v e dt + Gamma e dt^{1/2} W},  zeta = Gamma^2/(2 k Theta)
///   u' = u + sum_j {1/2 [zeta v^2 - Gamma^2/(2 mu)] dt - 1/2 v Gamma dt^{1/2} W + q}
/// all from the state at t. Conserves momentum; energy in the mean only, to O(dt).
class Espanol : public Integrator {
 public:
  void step(System& system, double dt) override { euler_maruyama_step(system, dt, exchange_); }

 private:
  Exchange exchange_;
};

}  // namespace

const Method espanol = {.name = "espanol",
                        .title = "Ito Euler-Maruyama (Espanol 1997)",
                        .reference = "Espanol, Europhys. Lett. 40, 631 (1997)",
                        .conserves = "momentum; energy in the mean, to first order",
                        .isothermal = true,
                        .closures = {FrictionClosure::noise},
                        .make = [](const Options&) -> std::unique_ptr<Integrator> {
                          return std::make_unique<Espanol>();
                        }};

}  // namespace driftless
