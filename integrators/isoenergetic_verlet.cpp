#include "integrators/kept_impulse.hpp"
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
    const Fluid& fluid = system.fluid();
    const auto exchange = [&](const auto& pair) { return impulse_of(fluid, pair, dt); };
    impulse_.start(system, dt, exchange);
    half_kick(system, dt);
    const auto potential = system.potential_shares();
    system.move(dt);
    impulse_.renew(system, dt, exchange);
    half_kick(system, dt);
    if (!fluid.has_repulsion()) return;
    const auto& moved = system.potential_shares();
    system.update([&](std::size_t i, Vector&, double& u) { u -= moved[i] - potential[i]; });
  }

  std::vector<double> save() const override { return impulse_.save(); }
  void load(const std::vector<double>& saved) override { impulse_.load(saved); }
  bool may_reorder_storage() const override { return true; }
  void follow_storage(const Places& places) override { impulse_.follow_storage(places); }

 private:
  /// Impulse F dt and heat q dt of friction, noise and conduction.
  template <class V>
  static Transfer<V> impulse_of(const Fluid& fluid, const Pair<V>& pair, double dt) {
    Transfer<V> total;
    if (fluid.has_friction()) total.momentum = euler_friction(fluid, pair, dt).momentum;
    if (fluid.has_conduction()) total += euler_conduction(fluid, pair, dt);
    return total;
  }

  void half_kick(System& system, double dt) const {
    const auto& force = system.conservative_force();
    system.update([&](std::size_t i, Vector& v, double& u) {
      const double m = system.mass(i);
      const Vector before = v;
      v += (force[i] * dt + impulse_.momentum(i)) / (2 * m);
      u += impulse_.energy(i) / 2 - m * (v - before).dot(v + before) / 2;
    });
    system.give_surroundings(impulse_.exchange(), 0.5);
    system.give_surroundings(dt / 2);
  }

  KeptImpulse impulse_;
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
