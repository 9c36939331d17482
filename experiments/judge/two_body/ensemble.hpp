#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "experiments/judge/two_body/bench.hpp"
#include "integrators/integrator.hpp"
#include "model/system.hpp"

/// Ensembles of isolated, frozen pairs: copies of the smallest system whose exact law is known.
namespace driftless::two_body {

/// How the copies start: in the exact law; all in one state far away from it, nearly without
/// kinetic energy and with most of the internal energy in one particle; or in a smooth cloud far
/// from it, with several times its kinetic energy and the relative velocity in one direction, the
/// internal energies apart: normal laws of half the exact law's widths, 3 widths away in the
/// velocity and 2 in the energies' shares.
enum class Start { exact, far, cloud };

struct Pairs {
  std::size_t count = 50;
  Start start = Start::exact;
  double frame_velocity = 0;  ///< of every pair's centre of mass, along its axis
  std::uint64_t seed = 1;
  std::uint64_t replica = 0;
};

/// Why and in which step the first copy failed, steps counted from 1.
struct FirstFailure {
  FailureCause cause;
  std::uint64_t step;
};

/// Many copies of a bench, stepped together. A copy whose step fails is given up and the step is
/// done again from where it began; noise follows the ids, so that no other copy notices.
class Ensemble {
 public:
  Ensemble(const Bench& bench, const Pairs& pairs);

  /// One step of every copy. Throws StepFailure if no copy is to blame alone.
  void step(Integrator& integrator, double dt);

  std::size_t size() const { return alive_.size(); }
  bool alive(std::size_t pair) const { return alive_[pair]; }
  std::size_t failed() const { return failed_; }
  const std::optional<FirstFailure>& first_failure() const { return first_failure_; }
  const System& system() const { return system_; }

  PairView view(std::size_t pair) const;
  /// Kinetic energy of both particles, centre of mass included, plus internal energies.
  double whole_energy(std::size_t pair) const;
  Vector momentum(std::size_t pair) const;
  /// The noise of the step that was done last or, after look_ahead(), of the next one.
  Noise::PairNormals normals(std::size_t pair, unsigned stage) const;
  void look_ahead() { noise_.set_step(step_ + 1); }

 private:
  void give_up(const std::vector<std::size_t>& pairs, FailureCause cause);
  void give_up_runaways(Integrator& integrator);
  std::vector<std::size_t> culprits(Integrator& integrator, double dt, std::size_t first,
                                    std::size_t last);
  void roll_back(Integrator& integrator, std::size_t first, std::size_t last);

  Bench bench_;
  Noise noise_;
  System system_;
  std::uint64_t step_ = 0;
  std::vector<bool> alive_;
  std::size_t failed_ = 0;
  std::optional<FirstFailure> first_failure_;
  Motion before_;
  std::vector<double> kept_;  ///< by the integrator, before the step
};

}  // namespace driftless::two_body
