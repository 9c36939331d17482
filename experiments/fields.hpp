#pragma once

#include <array>
#include <string>
#include <vector>

#include "experiments/long_run.hpp"

namespace driftless {

/// Averages over time on a rectangular grid that fills the box; an axis of one bin is averaged out.
///
/// Every value is a ratio of sums over all samples: particles over volume; momentum over mass; the
/// energy of the velocities about their mean in the bin at that moment, over its n - 1 degrees of
/// freedom a direction, so that neither a flow nor few particles bias the kinetic temperature (but
/// a gradient of the flow inside a bin counts as heat); particles over the sum of their inverse
/// temperatures; internal energy over particles. Without internal energies, or where k is 0, the
/// quantities that need them are left out. Where there are several species each has all of them for
/// itself too, its velocities about its own mean.
///
/// Errors come from 16 to 32 blocks of samples, as many samples each, in which correlations in time
/// average out, and from estimate() for what correlation the blocks still have. A block that is
/// under way counts for the values alone.
class Fields : public Observer {
 public:
  using Bins = std::array<std::size_t, 3>;

  /// The most bins that a grid may have.
  static constexpr std::size_t most_bins = 100'000;

  /// Bins along x, y and z, each at least 1; throws std::invalid_argument if there are too many.
  Fields(const System& system, const Bins& bins);

  void sample(System& system, std::uint64_t step) override;
  nlohmann::json settings() const override;
  nlohmann::json save() override;
  void load(const nlohmann::json& saved) override;

  /// One quantity in every bin: that of bin (i, j, k) is values[(k * y bins + j) * x bins + i].
  struct Quantity {
    std::string name;
    std::vector<double> values;  ///< NaN where there was nothing to average
    std::vector<double> errors;  ///< values +- 1.96 errors cover 95 %; infinite if unknown
  };
  /// Of all particles.
  std::vector<Quantity> quantities() const { return quantities_of(0); }
  /// Of one species, below species(), which is 0 where there is one alone.
  std::vector<Quantity> quantities(std::size_t species) const { return quantities_of(species + 1); }
  std::size_t species() const { return groups_ - 1; }
  std::uint64_t samples() const { return samples_; }

  /// {"axes": [{"axis", "from", "to", "bins"}], "bins": [x, y, z], "samples", "quantities": {name:
  /// {"values", "errors"}}}; null is written for what is not finite. Where there are several
  /// species "species" lists the quantities of each.
  nlohmann::json to_json() const;

 private:
  /// What is summed in every bin.
  enum Channel {
    particles,
    mass,
    momentum_x,
    momentum_y,
    momentum_z,
    peculiar,  ///< sum of m |v - mean v|^2
    freedom,   ///< particles less one
    inverse_temperature,
    internal_energy,
    channels
  };
  /// factor * numerator / denominator; `channels` stands for a denominator of one per sample.
  struct Ratio {
    const char* name;
    Channel numerator, denominator;
    double factor;
  };
  std::vector<Ratio> ratios() const;
  std::vector<Quantity> quantities_of(std::size_t group) const;
  Quantity quantity(const Ratio& ratio, std::size_t group) const;
  double error(const Ratio& ratio, std::size_t cell) const;

  std::size_t bins() const { return bins_[0] * bins_[1] * bins_[2]; }
  std::size_t bin_of(const Vector& position) const;
  /// What is summed of a group, 0 for all particles, n + 1 for species n, in a bin: cell group *
  /// bins() + bin.
  double& summed(std::size_t cell, Channel channel) { return sums_[cell * channels + channel]; }
  double total(std::size_t cell, Channel channel) const;
  /// Calls visit(i, cell) for every particle i and the cells that it counts in.
  template <class Visit>
  void visit_cells(const System& system, Visit&& visit) const;
  void sum_particles(const System& system);
  void sum_peculiar(const System& system);
  void add_to_block();

  Vector lengths_;
  Bins bins_;
  std::size_t groups_;
  bool isothermal_;
  double boltzmann_;
  std::uint64_t samples_ = 0;
  std::uint64_t block_length_ = 1;  ///< samples
  std::uint64_t filled_ = 0;        ///< of the last block
  std::vector<std::vector<double>> blocks_;
  std::vector<double> sums_;        ///< of the sample being taken
  std::vector<std::uint32_t> bin_;  ///< of each particle
};

}  // namespace driftless
