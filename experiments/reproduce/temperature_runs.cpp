#include "experiments/reproduce/temperature_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/judge/isolated_runs.hpp"
#include "model/pairs.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

constexpr double sample_period = 0.5;  ///< to the nearest whole step
constexpr std::size_t distance_bins = 64;
constexpr double distance_range = distance_bins * distance_bin;

/// Counts of the pairs' distances.
class Distances {
 public:
  explicit Distances(const System& system)
      : search_(system.box(), distance_range, system.size()), counts_(distance_bins, 0.0) {
    const auto n = static_cast<double>(system.size());
    pairs_per_volume_ = 0.5 * n * (n - 1) / system.box().volume();
  }
  void take(const State& state) {
    search_.find(state, [&](const PairSearch::Found& pair) {
      const double bin = std::sqrt(pair.squared_distance) / distance_bin;
      ++counts_[std::min(distance_bins - 1, static_cast<std::size_t>(bin))];
    });
    ++taken_;
  }
  std::size_t taken() const { return taken_; }
  json record() const {
    std::vector<double> g;
    double close = 0;
    for (std::size_t n = 0; n < counts_.size(); ++n) {
      const double inner = static_cast<double>(n) * distance_bin, outer = inner + distance_bin;
      g.push_back(counts_[n] / expected(inner, outer));
      if (outer < core + distance_bin / 2) close += counts_[n];
    }
    return {{"g", g}, {"core", close / expected(0, core)}};
  }

 private:
  double expected(double from, double to) const {
    const double shell = 4 * std::numbers::pi / 3 * (std::pow(to, 3) - std::pow(from, 3));
    return static_cast<double>(taken_) * pairs_per_volume_ * shell;
  }

  PairSearch search_;
  std::vector<double> counts_;
  double pairs_per_volume_;
  std::size_t taken_ = 0;
};

double kinetic_temperature(const System& system) {
  const double degrees = 3 * (static_cast<double>(system.size()) - 1);
  return 2 * system.kinetic_energy() / (degrees * system.fluid().boltzmann());
}

double inverse_temperature(const System& system) {
  double sum = 0;
  for (const double u : system.state().internal_energy) sum += 1 / system.fluid().temperature(u);
  return sum / static_cast<double>(system.size());
}

/// Kinetic and inverse internal temperature of a replica from `kinetic_end` on.
Eigen::MatrixXd averaged_samples(const json& replica) {
  const auto times = replica["times"].get<std::vector<double>>();
  const auto first = std::lower_bound(times.begin(), times.end(), kinetic_end) - times.begin();
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(times.size()) - first, 2);
  for (Eigen::Index n = 0; n < rows.rows(); ++n) {
    const auto sample = static_cast<std::size_t>(first + n);
    rows(n, 0) = replica["kinetic"][sample];
    rows(n, 1) = replica["inverse"][sample];
  }
  return rows;
}

}  // namespace

json run_temperatures(const TemperatureRuns& runs, const MethodChoice& method, double step,
                      unsigned replica, std::uint64_t seed) {
  const auto& prepared = judge::prepared_once(runs.scene, seed, runs.replicas);
  const auto stride = static_cast<std::uint64_t>(std::max(1L, std::lround(sample_period / step)));
  const auto count = static_cast<std::uint64_t>(std::llround(runs.duration / step));
  std::vector<double> times, kinetic, inverse;
  Distances distances(prepared.start(replica));
  const auto sample = [&](System& system, double time) {
    times.push_back(time);
    kinetic.push_back(kinetic_temperature(system));
    inverse.push_back(inverse_temperature(system));
    if (time >= kinetic_end) distances.take(system.state());
  };
  const auto failure =
      judge::run_isolated({method}, prepared, replica, Vector::Zero(), step, count, stride, sample);
  json record = {{"times", times}, {"kinetic", kinetic}, {"inverse", inverse}};
  if (distances.taken() > 0) record.update(distances.record());
  if (failure) {
    record["failure"] = fmt::format("{} at t = {:.3g}", to_string(failure->cause), failure->time);
  }
  return record;
}

TemperatureCell::TemperatureCell(std::vector<json> replicas) : replicas_(std::move(replicas)) {
  for (const auto& one : replicas_) {
    const auto& times = one["times"];
    ran_ = ran_ && !times.empty() && times.back().get<double>() >= least_duration;
  }
}

std::string TemperatureCell::failures() const {
  std::size_t count = 0;
  std::string first;
  for (const auto& one : replicas_) {
    if (!one.contains("failure")) continue;
    ++count;
    if (first.empty()) first = one["failure"];
  }
  if (count == 0) return "";
  return fmt::format("{} of {} replicas ended early, first: {}", count, replicas_.size(), first);
}

Interval TemperatureCell::ratio() const {
  std::vector<Eigen::MatrixXd> samples;
  for (const auto& one : replicas_) samples.push_back(averaged_samples(one));
  return interval_of(estimate(samples, [](const auto& means) { return means[0] * means[1]; }));
}

Interval TemperatureCell::across(const std::function<double(const json&)>& number) const {
  std::vector<Eigen::VectorXd> values;
  for (const auto& one : replicas_) values.push_back(Eigen::VectorXd::Constant(1, number(one)));
  return interval_of(estimate_mean(values));
}

Interval TemperatureCell::g(std::size_t bin) const {
  return across([bin](const json& one) { return one["g"][bin].get<double>(); });
}

Interval TemperatureCell::overlaps() const {
  return across([](const json& one) { return one["core"].get<double>(); });
}

std::vector<double> TemperatureCell::times() const {
  const auto shortest = std::min_element(
      replicas_.begin(), replicas_.end(),
      [](const json& a, const json& b) { return a["times"].size() < b["times"].size(); });
  return (*shortest)["times"];
}

double TemperatureCell::kinetic(std::size_t n) const {
  return across([n](const json& one) { return one["kinetic"][n].get<double>(); }).value;
}

double TemperatureCell::internal(std::size_t n) const {
  return 1 / across([n](const json& one) { return one["inverse"][n].get<double>(); }).value;
}

}  // namespace driftless::reproduce
