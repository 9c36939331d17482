#pragma once

#include <nlohmann/json.hpp>

#include "experiments/judge/conclusion.hpp"

/// Error against cost: what an observable's accuracy costs with a method.
namespace driftless::judge {

/// The table of a method's errors and costs, without rows: scene, observable, time step, processor
/// seconds per unit of simulated time, deviation from the exact value with its 95 % interval.
Table empty_trade_table();

/// The trade of all methods of a judgement ("driftless-judgement/1"), from those tables: a list of
///   {"scene", "observable", "points": [{"method", "time_step", "cost", "error", "lower", "upper",
///    "on_front", "dominated"}]}
/// in the order of the tables, points by rising cost. A point is on the Pareto front if no other
/// one has an upper bound as small at as small a cost: so much accuracy for so little has been
/// shown by nobody else. It is dominated if another one is surely better, its upper bound below
/// this lower one, at as small a cost. What is neither is not told apart from the front by these
/// errors.
nlohmann::json trade_front(const nlohmann::json& judgement);

}  // namespace driftless::judge
