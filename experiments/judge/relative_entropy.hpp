#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// S[P](t) of an ensemble from the bins in which its copies lie, relative to the law that keeps
/// them: the relative entropy D = sum P ln(P/mu) = S_equilibrium - S[P] in units of k (for an
/// isothermal system the free energy above its minimum, in units of k T).
namespace driftless::judge {

/// Where the same copies lie at successive times; every time has as many copies.
struct BinnedCopies {
  std::vector<double> times;
  std::vector<std::vector<std::uint16_t>> bins;  ///< [time][copy]
};

/// The rise of D from one time to a later one that stands most clearly out of the noise: a fall of
/// the entropy. Depths are negative where D falls all the way.
struct EntropyFall {
  std::size_t from = 0, to = 0;  ///< places in the times
  double depth = 0;
  double error = 0;  ///< standard error, from the changes of the same copies
};

struct EntropyCourse {
  std::vector<double> relative, error;  ///< D at every time and its standard error
  EntropyFall fall;
};

/// sum P ln(P/mu) of independent draws counted in bins, `log_mass` = ln mu of the bins, with the
/// entropy of the counts by the estimator of Grassberger (arXiv:physics/0307138, 2003): what is
/// left of the bias, about (occupied bins - 1)/(2 draws) without it, is far below the noise.
double relative_entropy(const std::vector<double>& counts, const std::vector<double>& log_mass);

/// D over time with errors from the scatter of ln(P/mu) among the copies. Close to equilibrium,
/// where the noise is that of the bins' counts, errors come out too wide, by 2^(1/2) at most.
EntropyCourse entropy_course(const BinnedCopies& copies, const std::vector<double>& log_mass);

}  // namespace driftless::judge
