#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/judge/examination.hpp"
#include "model/system.hpp"

/// Runs of a small fluid by different methods, with different steps, on one Wiener path.
namespace driftless::judge {

/// 27 moving particles of an ideal fluid, about two neighbours each, phi/k = 20. Velocities relax
/// within about one unit of time, internal energies by conduction likewise.
struct PathFluid {
  FrictionClosure closure = FrictionClosure::noise;
  bool conducts = false;

  Fluid fluid() const;
  std::string name() const;  ///< "closure noise, with conduction"
};

/// The fluids that a candidate runs.
std::vector<PathFluid> path_fluids(const Candidate& candidate);

/// Where a run starts: in the exact law, or off it with half of the kinetic energy and every
/// internal energy alike.
enum class PathStart { exact, off };

/// A run in steps of so many cells of the path; seed and replica name the path and the start.
struct PathRun {
  PathStart start = PathStart::exact;
  double step = 0;
  unsigned cells = 1;
  std::uint64_t steps = 1;
  std::uint64_t interval = 1;  ///< steps from one state that is kept to the next
  std::uint64_t seed = 1, replica = 0;
};

/// The states after every `interval` steps, particles in the same order in all runs. Throws
/// StepFailure.
std::vector<State> run_on_path(const PathFluid& fluid, const Candidate& candidate,
                               const PathRun& run);

/// Whether uniform variates decide in the method's steps, which no Wiener path fixes.
bool draws_uniforms(const Candidate& candidate, const PathFluid& fluid);

/// Kinetic energy per particle in units of kT.
double kinetic_energy_of(const Fluid& fluid, const State& state);
/// Variance of the particles' internal energies in units of phi k T^2.
double energy_variance_of(const Fluid& fluid, const State& state);

}  // namespace driftless::judge
