#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace driftless {

/// A measured difference from the exact value at one time step.
struct Deviation {
  double time_step = 0.0;
  double value = 0.0;
  double error = 0.0;  ///< standard error of `value`
};

/// Slope of log |deviation| against log time step.
struct OrderFit {
  double order = 0.0;
  double error = 0.0;  ///< standard error
  std::size_t points = 0;
};

/// Fits the order at which a deviation vanishes with the time step, by least squares weighted with
/// the deviations' relative errors, over the points that stand out of the noise (|value| > 2
/// error). The error is raised by the root of chi^2 per degree of freedom where that exceeds 1,
/// that is where the points do not lie on one power law. Being chosen by their size, points barely
/// above the noise are a little too large on average, which makes the order slightly too small:
/// leave more than a factor of two where it matters.
///
/// Returns nothing with fewer than two such points of different time steps. Points that are not
/// finite are left out. Throws std::invalid_argument if a time step is not positive.
std::optional<OrderFit> fit_order(const std::vector<Deviation>& deviations);

}  // namespace driftless
