#include "experiments/judge/two_body/measure.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace driftless::two_body {
namespace {

/// One ensemble from its start to its end, a row of sums per pair.
class Trajectory {
 public:
  Trajectory(const Bench& bench, Integrator& integrator, const Schedule& run, unsigned stages)
      : law_(bench.law().shape),
        integrator_(integrator),
        run_(run),
        ensemble_(bench, run.pairs),
        stages_(stages) {
    remember(start_);
    for (int n = 0; n < steps(run_.settle); ++n) ensemble_.step(integrator_, run_.dt);
    remember(settled_);
    observe();
  }

  /// Appends the averages of the surviving pairs.
  void append(std::vector<double>& averages, std::vector<double>& controls) const {
    for (std::size_t pair = 0; pair < ensemble_.size(); ++pair) {
      if (!ensemble_.alive(pair)) continue;
      for (const double sum : sums_[pair]) averages.push_back(sum / samples_);
      controls.insert(controls.end(), controls_[pair].begin(), controls_[pair].end());
    }
  }
  template <class Visit>
  void for_survivors(Visit&& visit) const {
    for (std::size_t pair = 0; pair < ensemble_.size(); ++pair) {
      if (ensemble_.alive(pair)) visit(pair);
    }
  }
  /// ln e(end)/e(settled)
  double energy_gain(std::size_t pair) const {
    return std::log(ensemble_.whole_energy(pair) / settled_[pair].energy);
  }
  double energy_change(std::size_t pair) const {
    return ensemble_.whole_energy(pair) / start_[pair].energy - 1;
  }
  double momentum_change(std::size_t pair) const {
    return (ensemble_.momentum(pair) - start_[pair].momentum).norm();
  }
  std::size_t failed() const { return ensemble_.failed(); }

 private:
  struct Kept {
    double energy;
    Vector momentum;
  };
  void remember(std::vector<Kept>& kept) const {
    for (std::size_t pair = 0; pair < ensemble_.size(); ++pair) {
      kept.push_back({ensemble_.whole_energy(pair), ensemble_.momentum(pair)});
    }
  }
  int steps(double time) const { return static_cast<int>(std::lround(time / run_.dt)); }

  void observe() {
    sums_.assign(ensemble_.size(), {});
    controls_.assign(ensemble_.size(),
                     std::vector<double>(stages_ * ShareLaw::controls_per_stage, 0.0));
    samples_ = steps(run_.measure);
    for (int n = 0; n < steps(run_.measure); ++n) {
      ensemble_.look_ahead();
      for_survivors([&](std::size_t pair) { add(pair); });
      ensemble_.step(integrator_, run_.dt);
    }
  }

  void add(std::size_t pair) {
    const PairView view = ensemble_.view(pair);
    const auto deviations = law_.deviations(view);
    for (int m = 0; m < moments; ++m) sums_[pair][m] += deviations[m];
    double* sum = controls_[pair].data();
    for (unsigned stage = 0; stage < stages_; ++stage) {
      for (const double g : law_.controls(view, ensemble_.normals(pair, stage))) *sum++ += g;
    }
  }

  ShareLaw law_;
  Integrator& integrator_;
  Schedule run_;
  Ensemble ensemble_;
  unsigned stages_;
  double samples_ = 0;
  std::vector<Kept> start_, settled_;
  std::vector<std::array<double, moments>> sums_;
  std::vector<std::vector<double>> controls_;
};

/// Rows of equal width as a matrix.
Eigen::MatrixXd as_matrix(const std::vector<double>& values, std::size_t width) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(values.data(), static_cast<Eigen::Index>(values.size() / width),
                                static_cast<Eigen::Index>(width));
}

}  // namespace

std::vector<Measured> regressed_means(const Eigen::MatrixXd& y, const Eigen::MatrixXd& x) {
  Eigen::MatrixXd design(x.rows(), x.cols() + 1);
  design << Eigen::VectorXd::Ones(x.rows()), x;
  const double scale = std::sqrt(static_cast<double>(x.rows()));
  for (int c = 1; c < design.cols(); ++c) design.col(c) *= scale / design.col(c).norm();
  const Eigen::MatrixXd normal = design.transpose() * design;
  const auto solver = normal.ldlt();
  const Eigen::MatrixXd coefficients = solver.solve(design.transpose() * y);
  const double leverage = solver.solve(Eigen::VectorXd::Unit(normal.cols(), 0))(0);
  const double freedom = static_cast<double>(design.rows() - design.cols());
  std::vector<Measured> means;
  for (int c = 0; c < y.cols(); ++c) {
    const double residual = (y.col(c) - design * coefficients.col(c)).squaredNorm();
    means.push_back({coefficients(0, c), std::sqrt(residual / freedom * leverage)});
  }
  return means;
}

Measured mean_of(const std::vector<double>& values) {
  const Eigen::Map<const Eigen::ArrayXd> x(values.data(), static_cast<Eigen::Index>(values.size()));
  const auto count = static_cast<double>(values.size());
  return {x.mean(), std::sqrt((x - x.mean()).square().sum() / (count - 1) / count)};
}

unsigned stages_of(const Bench& bench, const Factory& make) {
  Pairs few;
  few.count = 10;
  Ensemble ensemble(bench, few);
  const auto integrator = make();
  const double harmless = 1e-6;  // so small a step that none fails and has to be done again
  // The first step may draw more than the others.
  ensemble.step(*integrator, harmless);
  const auto before = ensemble.system().counters().random_numbers;
  ensemble.step(*integrator, harmless);
  const auto drawn = ensemble.system().counters().random_numbers - before;
  const unsigned kinds =
      (bench.fluid.has_friction() ? 1U : 0U) + (bench.fluid.has_conduction() ? 1U : 0U);
  return static_cast<unsigned>(drawn / (few.count * kinds));
}

Outcome measure(const Bench& bench, const Factory& make, const Schedule& run) {
  std::vector<double> averages, controls, gains, changes;
  Outcome outcome;
  double failed = 0;
  const unsigned stages = stages_of(bench, make);
  for (std::size_t n = 0; n < run.ensembles; ++n) {
    Schedule one = run;
    one.pairs.replica = n;
    const auto integrator = make();
    const Trajectory trajectory(bench, *integrator, one, stages);
    trajectory.append(averages, controls);
    failed += static_cast<double>(trajectory.failed());
    trajectory.for_survivors([&](std::size_t pair) {
      gains.push_back(trajectory.energy_gain(pair));
      changes.push_back(std::abs(trajectory.energy_change(pair)));
      outcome.momentum_change = std::max(outcome.momentum_change, trajectory.momentum_change(pair));
    });
  }
  outcome.deviations = regressed_means(as_matrix(averages, moments),
                                       as_matrix(controls, stages * ShareLaw::controls_per_stage));
  const Measured gain = mean_of(gains);
  const double unit = run.measure * bench.thermal_energy() / bench.energy;
  outcome.energy_rate = {gain.mean / unit, gain.error / unit};
  std::sort(changes.begin(), changes.end());
  outcome.energy_change = changes[changes.size() / 2];
  outcome.largest_energy_change = changes.back();
  outcome.momentum_change /= std::sqrt(bench.fluid.mass() * bench.thermal_energy());
  outcome.failed_fraction = failed / static_cast<double>(run.ensembles * run.pairs.count);
  return outcome;
}

}  // namespace driftless::two_body
