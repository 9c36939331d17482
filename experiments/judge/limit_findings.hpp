#pragma once

#include <vector>

#include "experiments/judge/conclusion.hpp"
#include "experiments/judge/limit_cells.hpp"

/// What the runs of a method say of the limit, observable by observable.
namespace driftless::judge {

/// One observable in one scene.
struct LimitCase {
  const LimitScene& scene;
  const LimitObservable& observable;
  const std::vector<LimitCell>& cells;

  std::string subject() const { return observable.words + ", " + scene.name; }
};

/// The finest time steps at which the method can be run: those of the limit. None where nothing was
/// measured.
std::vector<LimitPoint> points_of(const LimitCase& asked);

/// The verdict on one observable in one scene; `claimed` is left to the caller.
Finding limit_finding(const LimitCase& asked, Depth depth);

/// Whether the steps at which a method can be run are enough for a limit.
bool can_be_run(const std::vector<LimitCell>& cells);

/// The finding about a scene in which they are not.
Finding unseen_finding(const LimitScene& scene, const std::vector<LimitCell>& cells);

}  // namespace driftless::judge
