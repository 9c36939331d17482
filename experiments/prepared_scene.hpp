#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/binned_law.hpp"
#include "experiments/driven_integrator.hpp"
#include "experiments/scene.hpp"
#include "experiments/statistics.hpp"

namespace driftless {

/// An exact or reference value; `error` is 0 for an exact one.
struct Reference {
  double value = 0;
  double error = 0;
};

/// Distributions under the exact law: of shares of an island's kinetic plus internal energy e, or
/// of velocities under a bath.
struct ExactDistributions {
  BinnedLaw momentum;  ///< v sqrt(m/2) / sqrt(e (1 - 1/N)), signed; v sqrt(m) / sqrt(k T (1 - 1/N))
  std::optional<BinnedLaw> internal_energy;  ///< u/e
};

/// A scene made ready to run: fluid and box, the prescribed energy, starts for every replica, and
/// what is known exactly. Every method and every step starts from the same states.
class PreparedScene {
 public:
  /// Throws std::invalid_argument if the scene cannot be set up. A fluid with repulsion costs a
  /// Monte Carlo run (seconds) that gives the energy, the starts and the reference values: of the
  /// microcanonical law, or of the canonical one if isothermal.
  PreparedScene(const Scene& scene, std::uint64_t seed, unsigned replicas);

  const Scene& scene() const { return scene_; }
  const Fluid& fluid() const { return fluid_; }
  const Box& box() const { return box_; }

  /// A system at the start of a replica. The last of several starts off equilibrium.
  System start(unsigned replica) const;
  bool starts_off_equilibrium(unsigned replica) const;
  /// A method's integrator with the heat slabs of the scene acting after its steps, if it has any.
  std::unique_ptr<Integrator> driven(std::unique_ptr<Integrator> integrator,
                                     unsigned replica) const {
    return driftless::driven(std::move(integrator), scene_, noise(replica));
  }

  /// The law of shares of kinetic plus internal energy, where the scene has an exact one: nothing
  /// without friction and conduction or without internal energies, kinetic energy left out without
  /// friction.
  const std::optional<MicrocanonicalLaw>& law() const { return law_; }
  const std::optional<ExactDistributions>& distributions() const { return distributions_; }
  /// Exact or reference value of an observable.
  std::optional<Reference> reference(std::string_view observable) const;

  /// Kinetic plus internal energy of an island at the start; the mean one where potential energy
  /// fluctuates.
  double island_energy() const { return island_energy_; }
  /// Particles of an island.
  std::size_t island_size() const { return scene_.layout == Layout::pairs ? 2 : scene_.particles; }
  /// Kinetic degrees of freedom of an island.
  double kinetic_degrees() const {
    return scene_.layout == Layout::pairs ? 1 : 3 * (static_cast<double>(scene_.particles) - 1);
  }
  /// Mean kinetic energy of all islands at the scene's temperature.
  double thermal_kinetic_energy() const;
  double energy_per_particle() const { return total_energy_ / scene_.particles; }
  /// Energy unit of drifts: k T, or 1 where k is 0.
  double energy_unit() const;
  /// Predicted relaxation times of the internal and of the kinetic energies.
  double relaxation() const { return relaxation_time(scene_); }
  double kinetic_relaxation() const { return kinetic_relaxation_time(scene_); }

 private:
  void find_law();
  /// Kinetic plus internal energy of an island at the scene's temperature.
  double ideal_energy() const;
  void draw_start(double energy, bool off, const Noise& numbers, State& state) const;
  void prepare_ideal();
  void prepare_with_repulsion();
  void prepare_isothermal();
  void sample_canonical_configurations();
  void reference_from_law();
  void reference_of_shares();
  /// The law of all particles as if friction and conduction acted.
  MicrocanonicalLaw full_law() const;
  State on_lattice(const Noise& numbers) const;
  void draw_energies(double energy, int path, System& system) const;
  void reference_from_chain(const Eigen::MatrixXd& samples);
  Noise noise(unsigned replica) const { return {seed_, replica}; }

  Scene scene_;
  Fluid fluid_;
  Box box_;
  std::uint64_t seed_;
  unsigned replicas_;
  double total_energy_ = 0;
  double island_energy_ = 0;
  std::optional<MicrocanonicalLaw> law_;
  std::optional<ExactDistributions> distributions_;
  std::vector<State> configurations_;  ///< of the replicas, with repulsion
  std::map<std::string, Reference, std::less<>> references_;
};

}  // namespace driftless
