#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

/// What a measured deviation tends to as the time step vanishes.
namespace driftless::judge {

/// An estimate without bias at one time step, independent of those at the others.
struct LimitPoint {
  double time_step;
  double value;
  double error;  ///< standard error, not widened
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
};

struct Limit {
  double value;
  double error;  ///< standard error from those of the points
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
  double model_error = 0;  ///< what one more power of the step would change, all points being used
  std::size_t points = 0;  ///< time steps that entered
};

/// The value at time step zero of the polynomial through the finest points; the coarsest one is
/// left out and serves as the check: the polynomial of one more degree through all points has a
/// limit that differs by `model_error`. All powers of the step from the first on are allowed for:
/// no claim of a higher order enters, which, were it wrong, would pass for a fault of the limit. At
/// most the four finest points are used. The weights of the points follow from their steps alone,
/// so that the limit is as free of bias as they are, also where errors and values depend on each
/// other; its degrees of freedom are Satterthwaite's [F. E. Satterthwaite, Biometrics Bull. 2, 110
/// (1946)].
///
/// Returns nothing for fewer than three points, or if one is not finite. Throws
/// std::invalid_argument if a time step is not positive or occurs twice.
std::optional<Limit> limit_at_zero(std::vector<LimitPoint> points);

}  // namespace driftless::judge
