#pragma once

#include "experiments/judge/examination.hpp"

/// The orders at which a method's runs of a given duration converge, from steps and their halves on
/// the same Wiener path: in the mean (weak order) and path by path (strong order).
namespace driftless::judge {

std::vector<Part> path_order_parts(const Candidate& candidate, const Conditions& conditions);

/// Adds findings and charts.
void conclude_path_orders(const Candidate& candidate, const Conditions& conditions,
                          const Records& records, Conclusion& conclusion);

}  // namespace driftless::judge
