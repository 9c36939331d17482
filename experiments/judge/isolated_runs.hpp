#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "experiments/judge/examination.hpp"
#include "experiments/prepared_scene.hpp"
#include "experiments/replica.hpp"

/// Runs of small isolated fluids, from starts that every method shares.
namespace driftless::judge {

/// 150 particles of density 3, a box of fewer than four ranges a side, so that pairs are swept in
/// the order of ids wherever the particles are. As the preset `soft-fluid`, its repulsion only if
/// `with_potential`, but for conduction, which grows with the heat capacity so that internal
/// energies relax within about one unit of time.
Scene small_fluid_scene(double phi_over_k, FrictionClosure closure, bool with_potential);

/// The scene with starts drawn from the exact law for so many replicas. Prepared once and kept;
/// may be called from any thread.
const PreparedScene& prepared_once(const Scene& scene, std::uint64_t seed, unsigned replicas);

/// A replica's run of `steps` steps from its start in a frame of the given velocity. `sample` is
/// called every `stride` steps with the time. A failure, or an energy that has doubled, ends it and
/// is returned.
std::optional<Failure> run_isolated(const Candidate& candidate, const PreparedScene& scene,
                                    unsigned replica, const Vector& frame_velocity,
                                    double time_step, std::uint64_t steps, std::uint64_t stride,
                                    const std::function<void(System&, double time)>& sample);

/// How many runs failed, and the first failure: {"runs", "failed"} and, if one did, {"cause",
/// "time"} of the first and "negative", how many by a negative internal energy.
nlohmann::json failures_record(unsigned runs, const std::vector<Failure>& failures);

}  // namespace driftless::judge
