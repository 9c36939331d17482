#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "experiments/pooled_errors.hpp"

namespace driftless {

/// With what probability the bounds of all cells of a scene hold at once, for each observable.
inline constexpr double bounds_level = 0.95;

/// Adds to every measured observable of a result that has an exact value its deviation from it:
/// {value, lower, upper, below_noise}, |mean - exact| over the observable's scale with the cell's
/// own 95 % interval; for distances their root, for drifts the size. Cells that an answer can
/// choose from - no replica failed, the observable is resolved - get two more numbers:
/// - `bound`: with a probability of 95 % no cell of the scene at all deviates by more than its
///   bound. So whichever of them is chosen, by whatever rule and after any look at the numbers, is
///   as right as its bound says. By Bonferroni, one-sided: of m cells each may fail with 5 %/m (and
///   never more than the interval's 2.5 %); the errors of different cells may depend on each other.
///   The largest of several observables' deviations is below the largest of their bounds as well.
/// - `resolution`: the bound if the deviation were measured as 0, the least that could be shown.
///
/// Intervals and bounds are Student's, with the degrees of freedom of the errors. Errors of
/// relative observables are pooled over the scene's competing cells (see `pool_errors`), but for
/// cells whose replicas disagree beyond chance: these have a spread of their own, and few degrees
/// of freedom.
void add_deviations(nlohmann::json& result);

/// The deviation of one measured observable with this standard error (not widened), without the two
/// numbers that take the other cells. `entry` needs mean and exact, and may have exact_error.
nlohmann::json deviation(std::string_view observable, const nlohmann::json& entry,
                         const PooledError& error);

/// Whether a deviation is a share of the exact value, so that a tolerance in percent means
/// something; those of drifts and of distances of distributions are numbers of their own.
bool is_relative(std::string_view observable);

}  // namespace driftless
