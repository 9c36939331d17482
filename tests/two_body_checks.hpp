#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <sstream>
#include <string>

#include "experiments/judge/two_body/measure.hpp"

/// Verdicts on a method from runs at dt, dt/2 and dt/4: one and the same code judges the methods
/// and the planted faults.
namespace driftless::two_body {

/// A normal variate leaves +- 6.1 standard errors in 1 of 10^9 cases.
constexpr double z_bound = 6.1;

/// Empty if a check holds, else what is wrong.
struct Verdict {
  std::string complaint = {};
  explicit operator bool() const { return complaint.empty(); }
};

template <class... Parts>
Verdict complain(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return {text.str()};
}

/// Outcomes at dt, dt/2 and dt/4, independent of each other.
struct Ladder {
  Schedule run;  ///< of the first rung
  std::array<Outcome, 3> rungs;
};

inline Ladder climb(const Bench& bench, const Factory& make, const Schedule& run) {
  Ladder ladder{run, {}};
  Schedule rung = run;
  for (auto& outcome : ladder.rungs) {
    outcome = measure(bench, make, rung);
    rung.dt /= 2;
    rung.pairs.seed += 1;
  }
  return ladder;
}

/// The value at dt = 0 of c_0 + c_1 dt^order + c_2 dt^(order + 1) through three rungs.
inline Measured extrapolated(const std::array<Measured, 3>& rungs, int order) {
  Eigen::Matrix3d powers;
  for (int n = 0; n < 3; ++n) {
    const double h = std::pow(0.5, n);
    powers.row(n) << 1, std::pow(h, order), std::pow(h, order + 1);
  }
  const Eigen::RowVector3d weights = powers.inverse().row(0);
  Measured limit;
  double variance = 0;
  for (int n = 0; n < 3; ++n) {
    limit.mean += weights[n] * rungs[n].mean;
    variance += std::pow(weights[n] * rungs[n].error, 2);
  }
  limit.error = std::sqrt(variance);
  return limit;
}

inline Measured limit_of(const Ladder& ladder, int moment, int order) {
  std::array<Measured, 3> deviations;
  for (int n = 0; n < 3; ++n) deviations[n] = ladder.rungs[n].deviations[moment];
  return extrapolated(deviations, order);
}

/// Every moment's deviation vanishes with dt.
inline Verdict limit_is_exact(const Ladder& ladder, int order) {
  for (int m = 0; m < moments; ++m) {
    const Measured limit = limit_of(ladder, m, order);
    if (std::abs(limit.mean) <= z_bound * limit.error) continue;
    return complain(moment_names[m], " is off by ", limit.mean, " +- ", limit.error,
                    " in the limit of vanishing steps");
  }
  return {};
}

/// A deviation that stands clearly out of the noise at dt.
inline bool resolved(const Measured& deviation) {
  return std::abs(deviation.mean) > 12 * deviation.error;
}

inline bool resolves_something(const Ladder& ladder) {
  const auto& coarse = ladder.rungs[0].deviations;
  return std::any_of(coarse.begin(), coarse.end(), resolved);
}

/// Every moment is right at every step of the ladder, and well known.
inline Verdict exact_at_every_step(const Ladder& ladder, double largest_error) {
  for (int n = 0; n < 3; ++n) {
    for (int m = 0; m < moments; ++m) {
      const Measured found = ladder.rungs[n].deviations[m];
      if (std::abs(found.mean) <= z_bound * found.error && found.error <= largest_error) continue;
      return complain(moment_names[m], " is off by ", found.mean, " +- ", found.error, " at dt/",
                      1 << n);
    }
  }
  return {};
}

/// From dt to dt/2 each resolved deviation shrinks by 2^-order, half an order being left to the
/// next term and z_bound errors to the noise.
inline Verdict shrinks_at_order(const Ladder& ladder, int order) {
  const double factor = std::pow(0.5, order - 0.5);
  for (int m = 0; m < moments; ++m) {
    const Measured coarse = ladder.rungs[0].deviations[m], fine = ladder.rungs[1].deviations[m];
    if (!resolved(coarse)) continue;
    const double error = std::hypot(fine.error, factor * coarse.error);
    if (std::abs(fine.mean) <= factor * std::abs(coarse.mean) + z_bound * error) continue;
    return complain(moment_names[m], " is off by ", coarse.mean, " at dt and ", fine.mean,
                    " at dt/2: not order ", order);
  }
  return {};
}

/// The limits are known well enough for limit_is_exact to mean something.
inline Verdict sharp(const Ladder& ladder, int order, double largest_error) {
  for (const int m : {kinetic, difference_2}) {
    const Measured limit = limit_of(ladder, m, order);
    if (limit.error <= largest_error) continue;
    return complain(moment_names[m], " is only known to ", limit.error);
  }
  return {};
}

/// At most a share of the copies failed at dt, and half of that at dt/4.
inline Verdict few_failures(const Ladder& ladder, double share) {
  const double coarse = ladder.rungs[0].failed_fraction, fine = ladder.rungs[2].failed_fraction;
  if (coarse <= share && fine <= 0.5 * share) return {};
  return complain("a share of ", coarse, " of the copies failed at dt, of ", fine, " at dt/4");
}

/// A bound on rounding: a few units in the last place a step, all in one direction.
inline double rounding(const Schedule& run, int rung) {
  const double steps = (run.settle + run.measure) / run.dt * std::pow(2, rung);
  return 4 * std::numeric_limits<double>::epsilon() * steps;
}

inline Verdict momentum_is_kept(const Ladder& ladder) {
  for (int n = 0; n < 3; ++n) {
    const double change = ladder.rungs[n].momentum_change;
    if (change > rounding(ladder.run, n)) return complain("momentum of a pair changed by ", change);
  }
  return {};
}

/// The mean energy's rate of change vanishes with dt, at first order or faster.
inline Verdict energy_rate_vanishes(const Ladder& ladder) {
  std::array<Measured, 3> rates;
  for (int n = 0; n < 3; ++n) rates[n] = ladder.rungs[n].energy_rate;
  const Measured limit = extrapolated(rates, 1);
  if (std::abs(limit.mean) <= z_bound * limit.error) return {};
  return complain("the energy of a pair changes by ", limit.mean, " +- ", limit.error,
                  " kT per unit of time in the limit of vanishing steps");
}

inline Verdict energy_is_exact(const Ladder& ladder) {
  for (int n = 0; n < 3; ++n) {
    const double change = ladder.rungs[n].largest_energy_change;
    if (change > rounding(ladder.run, n)) return complain("a pair's energy changed by ", change);
  }
  return {};
}

/// The energy moves visibly, by what vanishes with dt: an independent error a step of O(dt) walks
/// by O(dt^(1/2)) in a given time, so from dt to dt/4 it halves at least; 0.35 stands for 1/2.
inline Verdict energy_drifts(const Ladder& ladder) {
  const double coarse = ladder.rungs[0].energy_change, fine = ladder.rungs[2].energy_change;
  if (coarse < 1e-6) return complain("energy changed by no more than ", coarse);
  if (fine > std::pow(0.25, 0.35) * coarse) {
    return complain("energy changed by ", coarse, " at dt and ", fine, " at dt/4");
  }
  return energy_rate_vanishes(ladder);
}

inline Verdict energy_as_claimed(const Ladder& ladder, EnergyClaim claim) {
  return claim == EnergyClaim::exact ? energy_is_exact(ladder) : energy_drifts(ladder);
}

/// Two independent runs found one law.
inline Verdict same_law(const Outcome& one, const Outcome& other) {
  for (int m = 0; m < moments; ++m) {
    const Measured a = one.deviations[m], b = other.deviations[m];
    if (std::abs(a.mean - b.mean) <= z_bound * std::hypot(a.error, b.error)) continue;
    return complain(moment_names[m], " is off by ", a.mean, " +- ", a.error, " and ", b.mean,
                    " +- ", b.error);
  }
  return {};
}

/// With the same noise the motion relative to the centre of mass is the same in either frame; what
/// rounding adds stays far below the tolerance because friction forgets it.
inline Verdict same_in_every_frame(const Outcome& at_rest, const Outcome& moving) {
  for (int m = 0; m < moments; ++m) {
    const double a = at_rest.deviations[m].mean, b = moving.deviations[m].mean;
    if (std::abs(a - b) <= 1e-6) continue;
    return complain(moment_names[m], " is off by ", a, " at rest and ", b, " in motion");
  }
  return {};
}

}  // namespace driftless::two_body
