#include "integrators/choice.hpp"
#include "integrators/methods.hpp"
#include "integrators/predicted_verlet.hpp"

namespace driftless {

/// Modified velocity Verlet [Groot, Warren, J. Chem. Phys. 107, 4423 (1997)] with internal energies
/// predicted like velocities [Li, Tang, Lei, Caswell, Karniadakis, J. Comput. Phys. 265, 113
/// (2014)]: the scheme of predicted_verlet.hpp. Groot and Warren found `lambda` 0.65 the best at
/// the density 3, others take 1/2, where it is velocity-verlet to the last bit. Li et al. leave the
/// noise-induced friction of the closure `friction` out; here it is in. Noise-free it is of first
/// order, the velocities of the forces being off by (1 - lambda) F dt/m; lambda = 1 would make it
/// second. Conserves momentum; energy in the mean only, to O(dt). In an isothermal fluid it is the
/// scheme as published; a pair alone then has 1/(1 + (lambda - 1/2) zeta dt/mu) of the right
/// variance of v (derived).
const Method groot_warren = {
    .name = "groot-warren",
    .title = "Modified velocity Verlet (Groot-Warren 1997, Li 2014)",
    .reference =
        "Groot, Warren, J. Chem. Phys. 107, 4423 (1997); "
        "Li, Tang, Lei, Caswell, Karniadakis, J. Comput. Phys. 265, 113 (2014)",
    .conserves = "momentum; energy in the mean, to first order",
    .isothermal = true,
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = {{"lambda", 0.65, "share of the step of the prediction, above 0, at most 1"}},
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<PredictedVerlet>(positive_number(groot_warren, options, "lambda", 1));
    }};

}  // namespace driftless
