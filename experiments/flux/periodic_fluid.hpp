#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/statistics.hpp"
#include "experiments/study.hpp"
#include "model/system.hpp"

namespace driftless::flux {

/// A fluid in a periodic box and the method that runs it.
struct PeriodicFluid {
  FluidParameters fluid;
  double density = 3;
  double temperature = 1;  ///< at which it starts; its friction may be quoted at another one
  Vector lengths = Vector::Constant(5);
  MethodChoice method = {"isoenergetic-verlet", {}};
  double step = 0.01;  ///< of time
  std::uint64_t seed = 1;

  Box box() const { return {lengths}; }
  std::size_t particles() const;
};

/// The fluid in equilibrium: positions of the canonical law, by hybrid Monte Carlo where there is a
/// potential; velocities and internal energies of the exact law, momentum 0.
System equilibrium_start(const PeriodicFluid& setting, std::uint64_t replica);

/// Runs a system with its method, steps numbered from 1.
class Run {
 public:
  Run(const PeriodicFluid& setting, std::uint64_t replica);

  System& system() { return system_; }
  double time() const { return static_cast<double>(steps_) * step_size_; }
  void step();
  /// So many steps as `duration` holds; `each` is called after every one.
  template <class Each>
  void advance(double duration, Each&& each) {
    for (const auto last = steps_ + steps_in(duration); steps_ < last;) {
      step();
      each();
    }
  }
  void advance(double duration) {
    advance(duration, [] {});
  }
  std::uint64_t steps_in(double duration) const;

 private:
  System system_;
  std::unique_ptr<Integrator> method_;
  double step_size_;
  std::uint64_t steps_ = 0;
};

/// {"mean", "error"} of 95 % interval mean +- 1.96 error.
nlohmann::json to_record(const Estimate& estimate);

}  // namespace driftless::flux
