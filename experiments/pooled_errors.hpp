#pragma once

#include <vector>

namespace driftless {

/// A standard error that was estimated from a cell's own runs.
struct CellError {
  double error = 0.0;               ///< above 0, not widened
  double degrees_of_freedom = 1.0;  ///< of its square as an estimate of a variance; finite
  double time_step = 0.0;           ///< cells of one step see the same noise
};

/// A standard error and the degrees of freedom of its square.
struct PooledError {
  double error = 0.0;
  double degrees_of_freedom = 1.0;
};

/// Standard errors of one observable in one scene, each drawn towards what the other cells have.
///
/// Every method at every step runs the same fluid for the same simulated time, so an observable has
/// about the same variance and the same autocorrelation in all cells, hence about the same true
/// error; what a cell's own few replicas say of it scatters by a factor of two. The logarithms of
/// the squared errors are therefore compared: an estimate with f degrees of freedom scatters by
/// trigamma(f/2) of chance alone, and what they scatter beyond that are true differences between
/// the cells, of variance h. With the others' mean known to a variance v, they count as an estimate
/// of the cell's own squared error with d degrees of freedom, trigamma(d/2) = h + v, and both are
/// averaged with the degrees of freedom as weights, which add: the moderated t of
/// [G. K. Smyth, Stat. Appl. Genet. Mol. Biol. 3, 3 (2004)].
///
/// It errs on the safe side:
/// - h is the upper end of its 75 % interval [W. Viechtbauer, Stat. Med. 26, 37 (2007)]: few cells
///   cannot show that they are alike, and are then hardly pooled.
/// - Cells of one time step see the same noise and may err together. So a cell learns from the
///   other steps only, and of each of them v counts the cells as if they were one. Two cells of a
///   step with the same number, as two names of one scheme have, are one cell.
/// With one time step alone nothing is pooled. The result is in the order of `cells`.
std::vector<PooledError> pool_errors(const std::vector<CellError>& cells);

}  // namespace driftless
