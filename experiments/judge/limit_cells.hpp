#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/judge/limit_fit.hpp"
#include "experiments/judge/limit_scenes.hpp"

/// What the runs of a method in a scene gave, block by block put together.
namespace driftless::judge {

/// One observable at one time step.
struct LimitValue {
  double value, error,
      degrees_of_freedom;  ///< standard error, not widened, without the reference's
};

/// All runs of one time step.
struct LimitCell {
  double time_step = 0;
  double runs = 0, failed = 0;
  nlohmann::json failure;      ///< of the first run that failed, or null
  nlohmann::json observables;  ///< lists of the blocks' entries, by name

  /// Whether its averages are those of the method: so few runs failed that leaving them out changes
  /// nothing that could be certain.
  bool is_whole() const { return failed <= 0.05 * runs; }
  /// Nothing if a block has none.
  std::optional<LimitValue> value(const std::string& observable) const;
  /// Standard error of the exact value, the same at every time step.
  double reference_error(const std::string& observable) const;
};

/// The name of the part that runs a block.
std::string part_name(const LimitScene& scene, std::size_t step, unsigned block);
/// The name of the part that times the steps.
std::string timing_name(const LimitScene& scene);

/// The cells of a scene, in the order of its time steps, from the records of its parts.
std::vector<LimitCell> limit_cells(const LimitScene& scene, const Records& records);

}  // namespace driftless::judge
