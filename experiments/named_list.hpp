#pragma once

#include <nlohmann/json.hpp>

/// Lists of JSON objects with a "name".
namespace driftless {

/// The object of a name, or null.
inline const nlohmann::json* find_named(const nlohmann::json& list, const nlohmann::json& name) {
  for (const auto& one : list) {
    if (one["name"] == name) return &one;
  }
  return nullptr;
}

/// Of everything in `order`, pointers to what has a name, the first list's object or else the
/// second's; what neither has is left out.
template <class Order>
nlohmann::json united_by_name(const Order& order, const nlohmann::json& first,
                              const nlohmann::json& second) {
  nlohmann::json all = nlohmann::json::array();
  for (const auto* one : order) {
    const auto* found = find_named(first, one->name);
    if (!found) found = find_named(second, one->name);
    if (found) all.push_back(*found);
  }
  return all;
}

}  // namespace driftless
