#pragma once

#include "experiments/flux/periodic_fluid.hpp"

namespace driftless::flux {

/// A fluid between slabs along z that a constant heat rate drives: the hot one about a quarter of
/// the box, the cold one about three quarters, so that by symmetry half of the heat goes each way.
/// The planes z = 0 and half of the box lie midway.
struct SlabRun {
  PeriodicFluid fluid;
  double heat_flux = 1;  ///< energy per area and time that crosses each plane
  double thickness = 1;  ///< of a slab
  std::size_t bins = 28;
  double settle = 80, duration = 300;  ///< times before and of the measurement
  bool planes = false;                 ///< whether what crosses the planes is measured
};

/// Runs it and measures
///   "profile": {"z", "density", "internal", "kinetic"}: lists, the last three of estimates;
///   "lines": of the whole way between slabs, its hot and its cold half, each {"slope", "middle",
///       "density", "conductivity"}, the last the heat flux over the slope: how the paper measures
///       it. A thickness is kept clear of the slabs;
///   "balance": the largest difference of energy in and energy stored at a step, over the energy;
///   with `planes` "crossed": fluxes per area and time away from the hot slab, see crossed_keys().
/// Throws StepFailure.
nlohmann::json run_between_slabs(const SlabRun& run);

/// The fluxes of "crossed": what particles carry, net, from the hot side and from the cold side, by
/// kind of energy, internal energies counted from "reference", their mean at the start; what pairs
/// bring across; their laws' mean rates; what the method created; what is stored between the
/// planes; what is carried and what pairs bring, and the same with their laws; how many particles
/// cross in either direction.
const std::vector<std::string>& crossed_keys();

}  // namespace driftless::flux
