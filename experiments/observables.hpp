#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/distribution_distance.hpp"
#include "experiments/energy_drift.hpp"
#include "experiments/prepared_scene.hpp"

namespace driftless {

/// What an observable needs to have relaxed, if anything.
enum class Relaxation { none, kinetic_energy, internal_energy };

/// An observable as listed by `driftless observables`.
struct ObservableSpec {
  std::string_view name;
  std::string_view unit;
  std::string_view meaning;
  Relaxation relaxation;  ///< unresolved in a run too short for it
};
const std::vector<ObservableSpec>& observable_specs();
const ObservableSpec& observable_spec(std::string_view name);

/// What one replica recorded while it was measured.
struct Record {
  Eigen::MatrixXd samples;  ///< samples x primary quantities (see Sampler)
  EnergyTrace energy;       ///< total energy per particle over k T, from the start of measurement
  std::vector<Block> momentum_blocks, internal_energy_blocks, distance_blocks;
  std::vector<double> distance_snapshots;  ///< taken in each of distance_blocks
  double momentum_error = 0;               ///< largest |P(t) - P(0)| per particle over sqrt(m k T)
};

/// Records the primary quantities of a running system. Kinetic and internal energies are taken as
/// shares of their present sum, scaled to the sum at the start: an integrator's drift of energy is
/// one observable and does not show in all the others. With a potential, or with a bath, they are
/// taken as they are.
class Sampler {
 public:
  static constexpr std::size_t blocks = 8;           ///< stretches of time per replica
  static constexpr std::size_t distance_bins = 100;  ///< of the radial distribution

  Sampler(const PreparedScene& prepared, System& system, unsigned replica, std::size_t samples);

  /// Takes the next sample at a time since the start of measurement.
  void take(System& system, double time);
  Record finish() && { return std::move(record_); }

  /// Range over which the radial distribution is recorded; 0 if it is not.
  static double distance_range(const PreparedScene& prepared);

 private:
  struct Island {
    Vector velocity;           ///< of the centre of mass
    double kinetic, internal;  ///< without the centre of mass
  };
  Island island(const State& state, std::size_t first, std::size_t last) const;
  void take_island(const State& state, std::size_t first, std::size_t last,
                   Eigen::RowVectorXd& sums);
  void take_distances(const State& state);

  const PreparedScene& prepared_;
  Record record_;
  PairSearch distances_;
  double first_energy_;
  Vector first_momentum_;
  std::size_t island_size_;
  double mean_energy_;  ///< exact mean of u, or 0: powers are taken about it
  std::size_t taken_ = 0;
};

/// A measured observable of a cell.
struct Observed {
  std::string_view name;
  Estimate value;
  std::optional<Reference> exact;
  std::optional<std::pair<double, double>> interval = {};  ///< 95 %, where it is not symmetric
};

/// Everything that the records of a cell's surviving replicas give. What depends on internal
/// energies is absent from an isothermal scene, and so are drift and walk of its energy, which a
/// bath changes.
struct CellObservables {
  std::vector<Observed> observed;
  EnergyDrift drift;
  Histogram momentum, internal_energy;  ///< in units of sqrt(m k T) and k T
  Histogram radial_distribution;        ///< exact is empty with a potential
  std::string disagreeing;              ///< observable of the largest z of the replica started off
  double largest_z = 0;                 ///< equilibrium against the others; 0 without one
  double kinetic_z = 0;                 ///< the same of observables of the kinetic energy alone
  bool has_off_equilibrium = false;
};

/// `replicas` names the replica of each record.
CellObservables evaluate(const PreparedScene& prepared, const std::vector<Record>& records,
                         const std::vector<unsigned>& replicas);

}  // namespace driftless
