#pragma once

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cstddef>
#include <vector>

/// Whether numbers follow a law: bounds that good numbers break less than once in 10^9 comparisons.
namespace driftless {

/// In standard errors: false-alarm rate 8e-11 a comparison.
constexpr double bound = 6.5;

/// chi^2 over `bins` bins of equal probability under the exact law; false-alarm rate 2e-10.
template <class Cumulative>
bool has_law(const std::vector<double>& x, Cumulative&& cumulative, int bins = 256) {
  std::vector<double> count(static_cast<std::size_t>(bins), 0.0);
  for (const double z : x) {
    const int bin = std::clamp(static_cast<int>(bins * cumulative(z)), 0, bins - 1);
    ++count[static_cast<std::size_t>(bin)];
  }
  const double expected = static_cast<double>(x.size()) / bins;
  double chi_squared = 0;
  for (const double c : count) chi_squared += (c - expected) * (c - expected) / expected;
  const boost::math::chi_squared law(bins - 1);
  return chi_squared < boost::math::quantile(boost::math::complement(law, 1e-10)) &&
         chi_squared > boost::math::quantile(law, 1e-10);
}

inline bool is_uniform(const std::vector<double>& x, int bins = 256) {
  return has_law(
      x, [](double z) { return z; }, bins);
}

inline bool is_normal(const std::vector<double>& x) {
  return has_law(x, [](double z) { return boost::math::cdf(boost::math::normal(), z); });
}

/// Whether pairs of numbers of (0, 1) are uniform in the unit square: chi^2 over 32 x 32 cells.
inline bool fill_square(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> cell(x.size());
  for (std::size_t n = 0; n < x.size(); ++n) {
    cell[n] = (static_cast<int>(32 * x[n]) + y[n]) / 32;
  }
  return is_uniform(cell, 32 * 32);
}

}  // namespace driftless
