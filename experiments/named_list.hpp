#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

/// Lists of JSON objects with a "name".
namespace driftless {

/// The object of a name, or null.
inline const nlohmann::json* find_named(const nlohmann::json& list, const nlohmann::json& name) {
  for (const auto& one : list) {
    if (one["name"] == name) return &one;
  }
  return nullptr;
}

/// Of everything in `order`, pointers to what has a name, the objects of that name, those with a
/// "method" after the one without and each method once: the first list's object or else the
/// second's.
template <class Order>
nlohmann::json united_by_name(const Order& order, const nlohmann::json& first,
                              const nlohmann::json& second) {
  nlohmann::json all = nlohmann::json::array();
  for (const auto* one : order) {
    std::map<std::string, nlohmann::json> by_method;
    for (const auto* list : {&second, &first}) {
      for (const auto& object : *list) {
        if (object["name"] == one->name) by_method[object.value("method", "")] = object;
      }
    }
    for (auto& [method, object] : by_method) all.push_back(std::move(object));
  }
  return all;
}

}  // namespace driftless
