#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>

#include "experiments/judge/balance_runs.hpp"
#include "experiments/judge/relative_entropy.hpp"
#include "experiments/judge/two_body/bins.hpp"
#include "experiments/judge/two_body/ensemble.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;
using two_body::Bench;
using two_body::Ensemble;
using two_body::PairView;
using two_body::Start;

constexpr std::size_t copies_at_once = 1000;
constexpr double most_failed = 0.2;  // of the copies; beyond it the survivors say nothing

// All times are in relaxation times of the relative velocity.
constexpr double entropy_until = 8, entropy_period = 0.2;
constexpr double settle = 6, reversal_period = 0.4;
constexpr int reversal_samples = 101;
const std::vector<int> lags = {1, 3};  // in periods
constexpr int transition_lag = 2, transition_spacing = 12;

std::uint64_t steps_in(double time, double step) {
  return static_cast<std::uint64_t>(std::llround(time / step));
}

/// Runs ensembles of copies one by one, `visit(ensemble, integrator)` each, and keeps count of the
/// copies that fail. A null record if all is well, else that of the failure.
class Ensembles {
 public:
  Ensembles(const Candidate& candidate, const Bench& bench, double time_step)
      : candidate_(candidate), bench_(bench), time_step_(time_step) {}

  template <class Visit>
  json run(Start start, std::size_t copies, std::uint64_t seed, Visit&& visit) {
    for (std::size_t replica = 0; replica * copies_at_once < copies; ++replica) {
      two_body::Pairs pairs;
      pairs.count = copies_at_once;
      pairs.start = start;
      pairs.seed = seed;
      pairs.replica = replica;
      Ensemble ensemble(bench_, pairs);
      const auto integrator = candidate_.make();
      json broken;
      try {
        visit(ensemble, *integrator);
      } catch (const StepFailure& failure) {
        broken = {{"cause", to_string(failure.cause())}};
      }
      run_ += ensemble.size();
      failed_ += ensemble.failed();
      if (const auto& first = ensemble.first_failure(); first && first_.is_null()) {
        first_ = {{"cause", to_string(first->cause)},
                  {"step", first->step},
                  {"time", static_cast<double>(first->step) * time_step_}};
      }
      if (broken.is_null() && failed_share() <= most_failed) continue;
      return {{"failed", failed_share()}, {"failure", first_.is_null() ? broken : first_}};
    }
    return nullptr;
  }
  double failed_share() const { return static_cast<double>(failed_) / static_cast<double>(run_); }
  void advance(Ensemble& ensemble, Integrator& integrator, double time) const {
    for (auto n = steps_in(time, time_step_); n > 0; --n) ensemble.step(integrator, time_step_);
  }
  /// {"failed": share, "failure": the first one}, the latter only if there is one.
  json failures() const {
    json record = {{"failed", failed_share()}};
    if (!first_.is_null()) record["failure"] = first_;
    return record;
  }

 private:
  const Candidate& candidate_;
  const Bench& bench_;
  double time_step_;
  std::size_t run_ = 0, failed_ = 0;
  json first_;
};

/// Moments of the shares of a pair's present energy: K = kinetic, v its signed root, d = u_i - u_j.
enum PairMoment { K, K2, d2, d4, v, v3, vd2, d, d3, dK, pair_moments };

Eigen::RowVectorXd moments_of(const PairView& pair) {
  const double e = pair.energy(), share = pair.kinetic / e, gap = (pair.u_i - pair.u_j) / e;
  const double speed = std::copysign(std::sqrt(share), pair.velocity);
  Eigen::RowVectorXd row(static_cast<int>(pair_moments));
  row << share, share * share, gap * gap, std::pow(gap, 4), speed, speed * share, speed * gap * gap,
      gap, gap * gap * gap, gap * share;
  return row;
}

/// v changes its sign under the reversal of momenta, d under the exchange of i and j. Pairs of
/// unlike symmetry, the last three, see only a method that breaks it.
const std::vector<MomentPair>& moment_pairs() {
  static const std::vector<MomentPair> pairs = {
      {"K, K^2", K, K2},       {"K, d^2", K, d2},     {"K, d^4", K, d4}, {"K^2, d^2", K2, d2},
      {"K^2, d^4", K2, d4},    {"d^2, d^4", d2, d4},  {"v, v^3", v, v3}, {"v, v d^2", v, vd2},
      {"v^3, v d^2", v3, vd2}, {"d, d^3", d, d3},     {"d, d K", d, dK}, {"d^3, d K", d3, dK},
      {"v, K", v, K, -1},      {"v, d^2", v, d2, -1}, {"d, K", d, K}};
  return pairs;
}

/// Centres and scales the moments as the exact law has them, odd ones about 0.
class Standard {
 public:
  explicit Standard(const Bench& bench) {
    two_body::Pairs pairs;
    pairs.count = 10 * copies_at_once;
    const Ensemble exact(bench, pairs);
    Eigen::MatrixXd rows(exact.size(), static_cast<int>(pair_moments));
    for (std::size_t n = 0; n < exact.size(); ++n) rows.row(n) = moments_of(exact.view(n));
    mean_ = rows.colwise().mean();
    mean_.tail(pair_moments - v).setZero();
    scale_ = (rows.rowwise() - mean_).colwise().norm() / std::sqrt(double(rows.rows()));
  }
  Eigen::RowVectorXd operator()(const PairView& pair) const {
    return (moments_of(pair) - mean_).array() / scale_.array();
  }

 private:
  Eigen::RowVectorXd mean_, scale_;
};

/// 16 bins of |v| and |u_i - u_j|, equally likely in the exact law.
class Quarters {
 public:
  explicit Quarters(double shape) {
    const boost::math::beta_distribution<> kinetic(0.5, 2 * shape), share(shape, shape);
    for (const double part : {0.25, 0.5, 0.75}) {
      kinetic_.push_back(quantile(kinetic, part));
      share_.push_back(quantile(share, 0.5 + part / 2) - 0.5);
    }
  }
  static constexpr int count = 16;
  int bin(const PairView& pair) const {
    const double share = pair.u_i / (pair.u_i + pair.u_j);
    return 4 * place(kinetic_, pair.kinetic / pair.energy()) + place(share_, std::abs(share - 0.5));
  }

 private:
  static int place(const std::vector<double>& edges, double value) {
    return static_cast<int>(std::lower_bound(edges.begin(), edges.end(), value) - edges.begin());
  }
  std::vector<double> kinetic_, share_;
};

/// What one copy showed at every sample.
struct CopySeries {
  Eigen::MatrixXd moments{reversal_samples, static_cast<int>(pair_moments)};
  std::vector<int> bins;

  void count_transitions(Eigen::MatrixXd& counts) const {
    for (int n = 0; n + transition_lag < reversal_samples; n += transition_spacing) {
      ++counts(bins[n], bins[n + transition_lag]);
    }
  }
};

json as_json(const Eigen::MatrixXd& counts) {
  json rows = json::array();
  for (Eigen::Index a = 0; a < counts.rows(); ++a) {
    rows.push_back(std::vector<double>(counts.row(a).begin(), counts.row(a).end()));
  }
  return rows;
}

}  // namespace

std::vector<std::string> pair_reversal_columns() {
  std::vector<std::string> names;
  for (const int lag : lags) {
    for (const auto& pair : moment_pairs()) {
      names.push_back(pair.name + (lag == 1 ? " after 0.4" : " after 1.2"));
    }
  }
  return names;
}

json run_entropy_course(const Candidate& candidate, const Bench& bench, double time_step,
                        std::size_t copies, std::uint64_t seed) {
  const two_body::PairBins bins(bench);
  const double period = std::max(entropy_period, time_step);
  BinnedCopies binned;
  for (double time = 0; time < entropy_until + period / 2; time += period) {
    binned.times.push_back(time);
  }
  binned.bins.resize(binned.times.size());
  Ensembles ensembles(candidate, bench, time_step);
  const json broken = ensembles.run(Start::cloud, copies, seed, [&](auto& ensemble, auto& method) {
    std::vector<std::vector<std::uint16_t>> courses;
    for (std::size_t n = 0; n < binned.times.size(); ++n) {
      if (n > 0) ensembles.advance(ensemble, method, period);
      auto& now = courses.emplace_back(ensemble.size());
      for (std::size_t copy = 0; copy < ensemble.size(); ++copy) {
        if (ensemble.alive(copy)) now[copy] = bins.bin(ensemble.view(copy));
      }
    }
    for (std::size_t copy = 0; copy < ensemble.size(); ++copy) {
      if (!ensemble.alive(copy)) continue;
      for (std::size_t n = 0; n < courses.size(); ++n) {
        binned.bins[n].push_back(courses[n][copy]);
      }
    }
  });
  if (!broken.is_null()) return broken;
  const auto course = entropy_course(binned, bins.log_mass());
  json record = ensembles.failures();
  record.update({{"copies", binned.bins[0].size()},
                 {"times", binned.times},
                 {"relative", course.relative},
                 {"error", course.error},
                 {"fall",
                  {{"from", course.fall.from},
                   {"to", course.fall.to},
                   {"depth", course.fall.depth},
                   {"error", course.fall.error}}}});
  return record;
}

json run_pair_reversal(const Candidate& candidate, const Bench& bench, double time_step,
                       std::size_t copies, std::uint64_t seed) {
  const Standard standard(bench);
  const Quarters quarters(bench.law().shape);
  Scatter scatter;
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(Quarters::count, Quarters::count);
  Ensembles ensembles(candidate, bench, time_step);
  const json broken = ensembles.run(Start::exact, copies, seed, [&](auto& ensemble, auto& method) {
    ensembles.advance(ensemble, method, settle);
    std::vector<CopySeries> series(ensemble.size());
    for (int n = 0; n < reversal_samples; ++n) {
      if (n > 0) ensembles.advance(ensemble, method, reversal_period);
      for (std::size_t copy = 0; copy < ensemble.size(); ++copy) {
        if (!ensemble.alive(copy)) continue;
        const auto view = ensemble.view(copy);
        series[copy].moments.row(n) = standard(view);
        series[copy].bins.push_back(quarters.bin(view));
      }
    }
    for (std::size_t copy = 0; copy < ensemble.size(); ++copy) {
      if (!ensemble.alive(copy)) continue;
      scatter.add(reversal_differences(series[copy].moments, moment_pairs(), lags));
      series[copy].count_transitions(counts);
    }
  });
  if (!broken.is_null()) return broken;
  json record = ensembles.failures();
  record["reversal"] = scatter.record();
  record["transitions"] = as_json(counts);
  return record;
}

}  // namespace driftless::judge
