#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace driftless {

/// Adds to a result what its cells say: `orders`, the fitted order at which each method's
/// deviations vanish, and `answers`, which method at which step is the cheapest within a tolerance.
/// A cell passes if no replica failed, the observable is resolved, and the upper end of its
/// deviation's 95 % interval is within the tolerance.
void add_answers(nlohmann::json& result);

/// The name that stands for the worst of kinetic temperature, internal temperature and variance of
/// the internal energy.
inline constexpr const char* equilibrium_observable = "equilibrium";

/// The name of a cell's method together with its options, as people tell variants apart.
std::string method_label(const nlohmann::json& cell);

/// The upper end of a cell's deviation in an observable (or `equilibrium`), or null if the cell
/// failed, does not know it, or does not resolve it.
nlohmann::json passing_bound(const nlohmann::json& cell, const std::string& observable);

}  // namespace driftless
