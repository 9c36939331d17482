#include "integrators/flows.hpp"
#include "integrators/methods.hpp"

namespace driftless {
namespace {

/// Isoenergetic velocity Verlet [Soleymani, Ripoll, Gompper, Fedosov, J. Chem. Phys. 152, 064112
/// (2020), eqs. 27-31], with all forces, one draw of noise per force evaluation; F dt and q dt
/// below are impulses, the noise included:
///   v_h = v + F dt/2m,     u_h = u + q dt/2 - m (v_h^2 - v^2)/2
///   r' = r + v_h dt;       F', q' from (r', v_h, u_h), V_i' = 1/2 sum_j psi(r_ij')
///   v' = v_h + F' dt/2m,   u' = u_h + q' dt/2 - m (v'^2 - v_h^2)/2 - (V_i' - V_i)
/// F' and q' serve the first half of the next step too. Every particle pays its own kinetic and
/// potential energy, so total energy is kept to rounding and momentum is conserved; but the bill of
/// a particle depends on the observer's velocity.
class IsoenergeticVerlet : public Integrator {
 public:
  void step(System& system, double dt) override {
    if (impulse_.momentum.size() != system.size() || evaluated_for_ != dt) {
      evaluate(system, dt, first_evaluation);
    }
    half_kick(system, dt);
    const auto potential = system.potential_shares();
    system.move(dt);
    evaluate(system, dt, every_evaluation);
    half_kick(system, dt);
    if (!system.fluid().has_repulsion()) return;
    const auto& moved = system.potential_shares();
    system.update([&](std::size_t i, Vector&, double& u) { u -= moved[i] - potential[i]; });
  }

  std::vector<double> save() const override {
    std::vector<double> saved = {evaluated_for_};
    for (const auto& momentum : impulse_.momentum) {
      saved.insert(saved.end(), momentum.begin(), momentum.end());
    }
    saved.insert(saved.end(), impulse_.energy.begin(), impulse_.energy.end());
    return saved;
  }

  void load(const std::vector<double>& saved) override {
    if (saved.empty()) return;  // saved before the first step
    const std::size_t particles = (saved.size() - 1) / 4;
    evaluated_for_ = saved[0];
    impulse_.reset(particles);
    for (std::size_t i = 0; i < particles; ++i) {
      impulse_.momentum[i] = Vector(&saved[1 + 3 * i]);
      impulse_.energy[i] = saved[1 + 3 * particles + i];
    }
  }

 private:
  static constexpr unsigned every_evaluation = 0, first_evaluation = 1;  // stages of the noise

  /// Impulses F dt and heats q dt of friction, noise and conduction.
  void evaluate(System& system, double dt, unsigned stage) {
    const Fluid& fluid = system.fluid();
    system.accumulate(
        [&](const auto& pair) {
          Transfer<double> total;
          if (fluid.has_friction()) total.momentum = euler_friction(fluid, pair, dt).momentum;
          if (fluid.has_conduction()) total += euler_conduction(fluid, pair, dt);
          return total;
        },
        impulse_, stage);
    evaluated_for_ = dt;
  }

  void half_kick(System& system, double dt) const {
    const double m = system.fluid().mass();
    const auto& force = system.conservative_force();
    system.update([&](std::size_t i, Vector& v, double& u) {
      const Vector before = v;
      v += (force[i] * dt + impulse_.momentum[i]) / (2 * m);
      u += impulse_.energy[i] / 2 - m * (v - before).dot(v + before) / 2;
    });
  }

  Exchange impulse_;
  double evaluated_for_ = 0;
};

}  // namespace

const Method isoenergetic_verlet = {
    .name = "isoenergetic-verlet",
    .title = "Isoenergetic velocity Verlet (Soleymani 2020)",
    .reference =
        "Soleymani, Ripoll, Gompper, Fedosov, J. Chem. Phys. 152, 064112 (2020), "
        "eqs. 27-31",
    .conserves = "momentum; total energy to rounding, with a potential too",
    .energy_ideal = EnergyClaim::exact,
    .energy_with_potential = EnergyClaim::exact,
    .consistent = false,
    .galilean = false,
    .closures = {FrictionClosure::noise},
    .make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<IsoenergeticVerlet>();
    }};

}  // namespace driftless
