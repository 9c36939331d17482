#pragma once

#include "experiments/judge/examination.hpp"

/// The order at which the law of isolated pairs, whose exact law is known, is left by a method.
namespace driftless::judge {

std::vector<Part> stationary_parts(const Candidate& candidate, const Conditions& conditions);

/// Adds findings and a chart.
void conclude_stationary(const Candidate& candidate, const Records& records,
                         Conclusion& conclusion);

}  // namespace driftless::judge
