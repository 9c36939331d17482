#include "experiments/judge/relative_entropy.hpp"

#include <algorithm>
#include <boost/math/special_functions/digamma.hpp>
#include <cmath>

namespace driftless::judge {
namespace {

/// What stands for ln n of a bin with n >= 1 draws: G(1) = -gamma - ln 2, G(2) = 2 + G(1),
/// G(2m + 1) = G(2m), G(2m + 2) = G(2m) + 2/(2m + 1), that is digamma(m + 1/2) + ln 2 for 2m.
double logarithm_of_count(double n) {
  const double half = std::floor(n / 2);
  return boost::math::digamma(half + 0.5) + std::log(2.0);
}

std::vector<double> counted(const std::vector<std::uint16_t>& bins, std::size_t size) {
  std::vector<double> counts(size, 0.0);
  for (const auto bin : bins) ++counts[bin];
  return counts;
}

/// ln(P/mu) of every bin that holds a copy.
std::vector<double> log_ratios(const std::vector<double>& counts,
                               const std::vector<double>& log_mass, double copies) {
  std::vector<double> ratios(counts.size(), 0.0);
  for (std::size_t b = 0; b < counts.size(); ++b) {
    if (counts[b] > 0) ratios[b] = std::log(counts[b] / copies) - log_mass[b];
  }
  return ratios;
}

/// Every copy's ln(P/mu) at one time.
struct Ratios {
  const std::vector<std::uint16_t>& bins;
  std::vector<double> by_bin;
  double of(std::size_t copy) const { return by_bin[bins[copy]]; }
};

/// Standard error of the mean over the copies of later - sooner; sooner may be left out.
double error_of_change(const Ratios& later, const Ratios* sooner) {
  double sum = 0, squares = 0;
  for (std::size_t copy = 0; copy < later.bins.size(); ++copy) {
    const double change = later.of(copy) - (sooner ? sooner->of(copy) : 0);
    sum += change;
    squares += change * change;
  }
  const auto count = static_cast<double>(later.bins.size());
  const double variance = std::max(0.0, squares / count - sum * sum / (count * count));
  return std::sqrt(variance / count);
}

EntropyFall clearest_fall(const std::vector<double>& relative, const std::vector<Ratios>& ratios) {
  EntropyFall clearest;
  double highest = -HUGE_VAL;
  for (std::size_t from = 0; from < relative.size(); ++from) {
    for (std::size_t to = from + 1; to < relative.size(); ++to) {
      const double depth = relative[to] - relative[from];
      const double error = error_of_change(ratios[to], &ratios[from]);
      if (!(error > 0) || depth / error <= highest) continue;
      highest = depth / error;
      clearest = {from, to, depth, error};
    }
  }
  return clearest;
}

}  // namespace

double relative_entropy(const std::vector<double>& counts, const std::vector<double>& log_mass) {
  double draws = 0, sum = 0;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    if (counts[b] == 0) continue;
    draws += counts[b];
    sum += counts[b] * (logarithm_of_count(counts[b]) - log_mass[b]);
  }
  return sum / draws - std::log(draws);
}

EntropyCourse entropy_course(const BinnedCopies& copies, const std::vector<double>& log_mass) {
  EntropyCourse course;
  std::vector<Ratios> ratios;
  for (const auto& bins : copies.bins) {
    const auto counts = counted(bins, log_mass.size());
    course.relative.push_back(relative_entropy(counts, log_mass));
    ratios.push_back({bins, log_ratios(counts, log_mass, static_cast<double>(bins.size()))});
    course.error.push_back(error_of_change(ratios.back(), nullptr));
  }
  course.fall = clearest_fall(course.relative, ratios);
  return course;
}

}  // namespace driftless::judge
