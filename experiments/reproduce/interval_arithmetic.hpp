#pragma once

#include "experiments/reproduce/experiment.hpp"

/// Intervals of what independent numbers make, to first order in their errors.
namespace driftless::reproduce {

/// Value and interval in other units.
Interval scaled(const Interval& interval, double factor);
Interval mean_of(const Interval& one, const Interval& other);
Interval product(const Interval& one, const Interval& other);
Interval ratio(const Interval& one, const Interval& other);

}  // namespace driftless::reproduce
