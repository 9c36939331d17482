#pragma once

#include <cstdint>
#include <vector>

#include "model/noise.hpp"
#include "model/system.hpp"

namespace driftless {

/// How two slabs of a system drive heat from one to the other.
enum class SlabDrive {
  /// Internal energies of the hot slab receive, those of the cold slab give, a heat per unit time
  /// [Soleymani et al., J. Chem. Phys. 152, 064112 (2020), sec. III.2], shared equally by the
  /// particles of a slab: each gets as much whatever its energy, so the drive tells nobody apart.
  heat_rate,
  /// The slowest particle of the hot slab and the fastest of the cold one swap velocities
  /// [F. Mueller-Plathe, J. Chem. Phys. 106, 6082 (1997)], where that brings heat to the hot slab.
  /// Slow and fast in the frame of the system's centre of mass; of equal masses.
  velocity_exchange,
  /// The same with the least internal energy of the hot slab and the largest of the cold one.
  energy_exchange,
  /// Internal energies in each slab are drawn afresh from the canonical law of the slab's
  /// temperature.
  temperatures
};

/// Positions from <= x < to along an axis.
struct Slab {
  double from = 0, to = 0;
  bool contains(double x) const { return from <= x && x < to; }
  double thickness() const { return to - from; }
};

/// Two slabs across a box and what they do.
struct HeatSlabs {
  SlabDrive drive = SlabDrive::heat_rate;
  int axis = 2;  ///< that the slabs are normal to: 0, 1 or 2
  Slab hot, cold;
  double rate = 0;  ///< of `heat_rate`: energy per unit time, above 0
  double hot_temperature = 0, cold_temperature = 0;  ///< of `temperatures`, above 0
  double period = 0;  ///< of all but `heat_rate`: time from one act to the next; 0: at every call
};

/// Drives heat through a system, between its steps, and books it: here by slab and, as what the
/// driver has received, in the system's surroundings.
class SlabHeater {
 public:
  /// Noise is that of the draws of `temperatures`. Throws std::invalid_argument naming the
  /// parameter, its value and the allowed range; so too if an isothermal fluid is to be driven by
  /// internal energies, which it does not have, species of different masses by their velocities, or
  /// a heat capacity that is not constant by `temperatures`.
  SlabHeater(const HeatSlabs& slabs, const Fluid& fluid, const Box& box, const Noise& noise);

  /// What the slabs do after the system has gone on by so long, at the positions as they are; of no
  /// duration, nothing. A heat rate that finds a slab empty waits for particles in both and then
  /// makes up for it. Throws StepFailure, and has then done nothing, if the cold slab asks for more
  /// than one of its particles has.
  void act(System& system, double duration);

  const HeatSlabs& slabs() const { return slabs_; }
  /// Energy that the particles in the hot slab, in the cold slab have received so far. They sum up
  /// to 0 but for `temperatures`.
  double given_to_hot() const { return given_to_hot_; }
  double given_to_cold() const { return given_to_cold_; }
  double given() const { return given_to_hot_ + given_to_cold_; }
  /// Heat that waits for particles.
  double owed() const { return owed_; }
  /// How often the slabs have acted.
  std::uint64_t acts() const { return acts_; }

  /// All that it keeps, for a checkpoint.
  std::vector<double> save() const;
  void load(const std::vector<double>& saved);

 private:
  void drive(System& system, double duration);
  void give_heat(System& system, double heat);
  void exchange_velocities(System& system);
  void exchange_energies(System& system);
  void draw_energies(System& system);

  HeatSlabs slabs_;
  Noise noise_;
  double given_to_hot_ = 0, given_to_cold_ = 0;
  double owed_ = 0, waited_ = 0;
  std::uint64_t acts_ = 0;
};

}  // namespace driftless
