#pragma once

#include "experiments/transport/modes.hpp"

namespace driftless::transport {

/// Where heat is put in and taken out along an axis: as a cosine, or at the same rate everywhere in
/// a hot slab about 0 and a cold one about the middle, each a quarter of the box wide.
enum class HeatShape { cosine, slabs };

/// Heats and cools a fluid without changing its energy and measures how it conducts in the steady
/// state.
class HeatSource {
 public:
  /// `rate`: the largest energy per particle and unit of time.
  HeatSource(HeatShape shape, int axis, double rate) : shape_(shape), axis_(axis), rate_(rate) {}

  /// What the source gives in a duration, between two steps; the sum over particles is zero to
  /// rounding. Throws StepFailure if a particle had not enough.
  void apply(System& system, double duration);
  /// Counts the temperature's wave as it is now.
  void measure(System& system);

  /// Conductivity = Q/(k^2 T) of the longest wave along the axis, Q its part of the heat per volume
  /// and time and T of the temperature, as means since the beginning or reset(); of the same
  /// meaning as that from a relaxing wave's integral.
  double conductivity(const System& system) const;
  /// Relative amplitude of the temperature wave; it must be small.
  double amplitude(const System& system) const;
  void reset();

 private:
  HeatShape shape_;
  int axis_;
  double rate_;
  double heat_ = 0, duration_ = 0;  ///< sums of the wave's part
  double temperature_ = 0, samples_ = 0;
};

}  // namespace driftless::transport
