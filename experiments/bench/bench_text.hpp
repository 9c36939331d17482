#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/bench/sampling.hpp"

/// How the bench prints its rows.
namespace driftless {

/// "562.1 [560.0, 570.3]", "-" where nothing was measured.
inline std::string text(const Spread& spread) {
  if (spread.samples == 0) return "-";
  return fmt::format("{:.1f} [{:.1f}, {:.1f}]", spread.median, spread.lower, spread.upper);
}

inline std::string bytes_text(const std::optional<double>& bytes) {
  return bytes ? fmt::format("{:.0f}", *bytes) : "-";
}

/// Prints at once, so that a long bench shows how far it is.
template <class... Values>
void print_line(fmt::format_string<Values...> format, Values&&... values) {
  fmt::print(format, std::forward<Values>(values)...);
  std::fflush(stdout);
}

template <class Row>
nlohmann::json all_to_json(const std::vector<Row>& rows) {
  auto all = nlohmann::json::array();
  for (const auto& row : rows) all.push_back(to_json(row));
  return all;
}

}  // namespace driftless
