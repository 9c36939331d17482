#pragma once

#include "integrators/integrator.hpp"
#include "integrators/kept_impulse.hpp"

namespace driftless {

/// Velocity Verlet with all forces and heats in it, the forces of the step's end evaluated at
/// predicted velocities and internal energies; F dt and q dt are impulses, the noise included:
///   v_h = v + F dt/2m,          u_h = u + q dt/2,           r' = r + v_h dt
///   v~  = v + lambda F dt/m,    u~  = u + lambda q dt,      F', q' from (r', v~, u~)
///   v'  = v_h + F' dt/2m,       u'  = u_h + q' dt/2
/// F' and q' serve the first half of the next step too. Work and heat are those of an Euler step,
///   q = 1/2 [(zeta + induced) v^2 - Gamma^2/(2 mu)] - 1/2 v Gamma dt^{-1/2} W + conduction
class PredictedVerlet : public Integrator {
 public:
  explicit PredictedVerlet(double lambda) : lambda_(lambda) {}

  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    const auto exchange = [&](const auto& pair) { return euler_exchange(fluid, pair, dt); };
    impulse_.start(system, dt, exchange);
    impulse_.apply(system, 0.5);
    system.move(dt);
    half_way_ = system.motion();
    impulse_.apply(system, lambda_ - 0.5);
    impulse_.renew(system, dt, exchange);
    system.set_motion(half_way_);
    impulse_.apply(system, 0.5);
  }

  std::vector<double> save() const override { return impulse_.save(); }
  void load(const std::vector<double>& saved) override { impulse_.load(saved); }
  bool may_reorder_storage() const override { return true; }
  void follow_storage(const Places& places) override { impulse_.follow_storage(places); }

 private:
  double lambda_;
  KeptImpulse impulse_;
  Motion half_way_;
};

}  // namespace driftless
