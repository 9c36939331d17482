#include "integrators/methods.hpp"
#include "integrators/second_order_terms.hpp"

namespace driftless {
namespace {

/// Explicit algorithm with unaveraged second-order terms [Mackie, Bonet Avalos, Navas, PCCP 1, 2039
/// (1999), eqs. 2.30-2.32]. The implicit algorithm,
///   p' = p + sum_j {F^C dt - zeta v e dt + Gamma' e dt^{1/2} W_ij}
///   u' = u + sum_j {1/2 zeta v^2 dt - 1/2 (v + v')/2 Gamma' dt^{1/2} W_ij + q'}
///   q' = lambda (theta_j - theta_i) dt + Lambda' dt^{1/2} W^q_ij,   r' = r + v dt,
/// is expanded to O(dt) by inserting the changes D that the noises make to O(dt^{1/2}),
///   D v_i = (dt^{1/2}/m) sum_k Gamma_ik e_ik W_ik
///   D u_i = dt^{1/2} sum_k {-1/2 v_ik Gamma_ik W_ik + Lambda_ik W^q_ik}
///   Gamma' = Gamma (1 + D u_i dlnGamma/du_i + D u_j dlnGamma/du_j),  Lambda' likewise,
///   v' = v + (D v_i - D v_j).e in the work of Gamma W_ij
/// The sums are over all pairs of a particle, so that products W_ij W_ik of different pairs stand
/// beside W_ij^2, W_ij W^q_ij and (W^q_ij)^2. The paper has the latter, of a pair's own noises
/// (with -Gamma^2 W^2/2m in u', printed as twice that, and the sign of Lambda W^q left out);
/// `own_products` stops there. The means are the same, those of averaged-drift. With all products a
/// step keeps energy to O(dt^{3/2}), with the own ones alone to O(dt). Conserves momentum; energy
/// drifts.
class AvalosMackieExplicit : public Integrator {
 public:
  explicit AvalosMackieExplicit(bool own_products) : own_products_(own_products) {}

  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    if (own_products_) {
      system.accumulate(
          [&](const auto& pair) {
            return expanded_exchange(fluid, pair, own_changes(fluid, pair, dt), dt);
          },
          exchange_);
    } else {
      // To the motion after the changes of O(dt^{1/2}); no law is ever asked at its energies.
      system.accumulate([&](const auto& pair) { return noise_exchange(fluid, pair, dt); },
                        exchange_);
      system.accumulate(
          exchange_,
          [&](const auto& start, const auto& end) {
            return expanded_exchange(fluid, start, changes(start, end), dt);
          },
          exchange_);
    }
    system.move(dt);
    system.apply(exchange_);
  }

 private:
  bool own_products_;
  Exchange exchange_;
};

}  // namespace

const Method avalos_mackie_explicit = {
    .name = "avalos-mackie-explicit",
    .title = "Explicit, unaveraged second-order terms (Mackie 1999)",
    .reference =
        "Mackie, Bonet Avalos, Navas, PCCP 1, 2039 (1999), eqs. 2.30-2.32, with the products of "
        "different pairs' noises derived",
    .conserves = "momentum; energy to O(dt^{3/2}) a step, drifting",
    .closures = {FrictionClosure::noise, FrictionClosure::friction},
    .options = {{"own_products", false, "leave the products of different pairs' noises out"}},
    .make = [](const Options& options) -> std::unique_ptr<Integrator> {
      return std::make_unique<AvalosMackieExplicit>(
          option<bool>(avalos_mackie_explicit, options, "own_products"));
    }};

}  // namespace driftless
