#pragma once

#include <vector>

namespace driftless {

/// A measured mean with its standard error (not widened) and the degrees of freedom of its square.
struct Measurement {
  double mean = 0.0;
  double error = 0.0;
  double degrees_of_freedom = 1.0;
};

/// The difference of two independent measurements, NEW less BASE.
struct Difference {
  double value = 0.0;
  double error = 0.0;               ///< standard error
  double degrees_of_freedom = 1.0;  ///< of Student's law that it is judged by
  /// The probability that chance alone makes it as large, on either side, or an upper bound of it.
  double probability = 1.0;
};

/// Two means whose errors are known with few degrees of freedom each (the problem of Behrens and
/// Fisher), judged in Student's law with the smaller of the two numbers. That is never too bold,
/// whatever the ratio of the true errors and however far out in the tail
/// [M. R. Mickey, M. B. Brown, Ann. Math. Stat. 37, 639 (1966)]. Welch's number of degrees is made
/// for the middle of the law: where it promises 1e-8, chance does it 6 times as often with 15 and
/// 15 degrees and one true error three times the other, and 18000 times as often with 3 and 15
/// degrees where the worse known error is ten times the other (integrals over the laws of both
/// errors; difference_test.cpp).
/// A difference within rounding has probability 1; one between two errors of 0 probability 0.
Difference difference(const Measurement& base, const Measurement& changed);

/// The same for two estimates of a variance (the strength of a random walk), whose errors grow with
/// the values: a number that comes out large by chance has a large error too, which keeps the
/// statistic below a normal variable. So the degrees of freedom may be Satterthwaite's, which lets
/// a strength that is all but 0, and hardly known, be compared with a large one.
Difference difference_of_variances(const Measurement& base, const Measurement& changed);

/// The smallest true difference that would have been found at a level, on either side, with a
/// probability of 95 %.
double detectable_difference(const Difference& difference, double level);

/// Holm's adjustment [S. Holm, Scand. J. Stat. 6, 65 (1979)]: rejecting every hypothesis whose
/// adjusted probability is at most a level keeps the probability of one false rejection among all
/// at most that level, however the tests depend on each other. In the order given.
std::vector<double> holm_adjusted(const std::vector<double>& probabilities);

/// Fisher's exact test, two-sided: the probability that counts of `first` out of `first_total` and
/// `second` out of `second_total`, drawn with one common chance, are as improbable as these.
double fisher_probability(unsigned first, unsigned first_total, unsigned second,
                          unsigned second_total);

}  // namespace driftless
