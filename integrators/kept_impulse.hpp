#pragma once

#include <vector>

#include "integrators/flows.hpp"

namespace driftless {

/// Impulses F dt and heats q dt of all pairs, the noise included, that an integrator keeps from one
/// step to the next: one evaluation, with one draw of the noise, serves the second half of a step
/// and the first half of the next. A fresh draw for each half would halve the noise.
class KeptImpulse {
 public:
  /// Makes sure that there is an impulse at dt: at the start of a run none has been left behind.
  template <class Kernel>
  void start(System& system, double dt, Kernel&& kernel) {
    const bool left = exchange_.momentum.size() == system.size() && evaluated_for_ == dt;
    if (!left) evaluate(system, dt, kernel, first_evaluation);
  }
  /// Evaluates anew from the state as it stands: kernel(pair) -> Transfer.
  template <class Kernel>
  void renew(System& system, double dt, Kernel&& kernel) {
    evaluate(system, dt, kernel, every_evaluation);
  }

  const Vector& momentum(std::size_t i) const { return exchange_.momentum[i]; }
  double energy(std::size_t i) const { return exchange_.energy[i]; }
  /// Adds the given share of the impulse to velocities and internal energies. Throws StepFailure.
  void apply(System& system, double share) const { system.apply(exchange_, share); }
  const Exchange& exchange() const { return exchange_; }

  void follow_storage(const Places& places) {
    follow(places, exchange_.momentum);
    follow(places, exchange_.energy);
  }
  std::vector<double> save() const {
    std::vector<double> saved = {evaluated_for_};
    for (const auto& momentum : exchange_.momentum) {
      saved.insert(saved.end(), momentum.begin(), momentum.end());
    }
    saved.insert(saved.end(), exchange_.energy.begin(), exchange_.energy.end());
    for (const auto& received : exchange_.surroundings) {
      saved.insert(saved.end(), received.momentum.begin(), received.momentum.end());
      saved.push_back(received.energy);
    }
    return saved;
  }
  void load(const std::vector<double>& saved) {
    if (saved.empty()) return;  // saved before the first step
    const std::size_t particles = (saved.size() - 1) / 4 - surrounding_places;
    evaluated_for_ = saved[0];
    exchange_.reset(particles);
    for (std::size_t i = 0; i < particles; ++i) {
      exchange_.momentum[i] = Vector(&saved[1 + 3 * i]);
      exchange_.energy[i] = saved[1 + 3 * particles + i];
    }
    const double* next = &saved[1 + 4 * particles];
    for (auto& received : exchange_.surroundings) {
      received = {Vector(next), next[3]};
      next += 4;
    }
  }

 private:
  static constexpr unsigned every_evaluation = 0, first_evaluation = 1;  // stages of the noise

  template <class Kernel>
  void evaluate(System& system, double dt, Kernel&& kernel, unsigned stage) {
    system.accumulate(kernel, exchange_, stage);
    evaluated_for_ = dt;
  }

  Exchange exchange_;
  double evaluated_for_ = 0;
};

}  // namespace driftless
