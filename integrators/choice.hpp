#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "integrators/integrator.hpp"

namespace driftless {

/// The value of an option that is one of a few words. Throws std::invalid_argument naming them.
inline std::string choice(const Method& method, const Options& options, std::string_view name,
                          std::initializer_list<std::string_view> allowed) {
  const auto word = option<std::string>(method, options, name);
  if (std::find(allowed.begin(), allowed.end(), word) != allowed.end()) return word;
  std::ostringstream message;
  message << name << " is \"" << word << "\", allowed is";
  for (const auto known : allowed) {
    message << (known == *allowed.begin() ? " \"" : " or \"") << known << '"';
  }
  throw std::invalid_argument(message.str());
}

/// The value of an option that is a finite number above 0 and at most `most`. Throws
/// std::invalid_argument naming the range.
inline double positive_number(const Method& method, const Options& options, std::string_view name,
                              double most = std::numeric_limits<double>::infinity()) {
  const double value = option<double>(method, options, name);
  if (value > 0 && value <= most && std::isfinite(value)) return value;
  std::ostringstream message;
  message << name << " is " << value << ", allowed is above 0";
  if (std::isfinite(most)) message << " and at most " << most;
  throw std::invalid_argument(message.str());
}

}  // namespace driftless
