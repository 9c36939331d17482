#pragma once

#include <Eigen/Core>
#include <functional>

#include "integrators/reference.hpp"

namespace driftless {

/// dy/dt as a function of y, written to the second argument; what it throws ends the solution.
using OdeRates = std::function<void(const Eigen::Map<const Eigen::VectorXd>& y,
                                    Eigen::Map<Eigen::VectorXd>& rates)>;

/// y after `duration` above 0, by one of the solvers of SUNDIALS, which never looks beyond the end.
/// Throws what the rates throw, and std::runtime_error naming the solver's reason if it fails.
Eigen::VectorXd solve_ode(const OdeRates& rates, const Eigen::VectorXd& start, double duration,
                          ReferenceSolver solver, const ReferenceTolerance& tolerance);

}  // namespace driftless
