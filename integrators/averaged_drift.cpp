#include "integrators/flows.hpp"
#include "integrators/methods.hpp"

namespace driftless {
namespace {

/// Explicit algorithm with averaged second-order terms: Euler-Maruyama for the Ito equations with
/// every noise-induced drift [Avalos, Mackie, Europhys. Lett. 40, 141 (1997); Mackie, Bonet Avalos,
/// Navas, PCCP 1, 2039 (1999), text below eq. 2.36]:
///   r' = r + v dt
///   p' = p + sum_j {F^C dt - (zeta + induced) v e dt + Gamma e dt^{1/2} W}
///   u' = u + sum_j {1/2 [(zeta + induced) v^2 - Gamma^2/(2 mu)] dt - 1/2 v Gamma dt^{1/2} W + q}
/// all from the state at t. Conserves momentum; energy in the mean only, to O(dt).
class AveragedDrift : public Integrator {
 public:
  void step(System& system, double dt) override { euler_maruyama_step(system, dt, exchange_); }

 private:
  Exchange exchange_;
};

}  // namespace

const Method averaged_drift = {
    .name = "averaged-drift",
    .title = "Explicit, averaged drift (Avalos-Mackie 1997)",
    .reference =
        "Avalos, Mackie, Europhys. Lett. 40, 141 (1997); "
        "Mackie, Bonet Avalos, Navas, PCCP 1, 2039 (1999), below eq. 2.36",
    .conserves = "momentum; energy in the mean, to first order",
    .isothermal = true,
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<AveragedDrift>();
    }};

}  // namespace driftless
