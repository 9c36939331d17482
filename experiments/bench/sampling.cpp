#include "experiments/bench/sampling.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "model/state.hpp"

namespace driftless {
namespace {

constexpr unsigned least_samples = 3;

/// A contestant with how it is sampled.
struct Turn {
  const Contestant& contestant;
  std::uint64_t steps = 0;
  unsigned samples = 0;
  std::vector<double> measured = {};
  std::string failure = {};

  /// Nanoseconds per particle and step.
  double time(std::uint64_t count) const {
    const auto start = std::chrono::steady_clock::now();
    for (std::uint64_t n = 0; n < count; ++n) contestant.step();
    const std::chrono::duration<double, std::nano> elapsed =
        std::chrono::steady_clock::now() - start;
    return elapsed.count() / static_cast<double>(count * contestant.particles);
  }

  void prepare(const Sampling& sampling) {
    time(1);  // caches and the first evaluation are not what a long run pays
    const double seconds = 1e-9 * time(2) * static_cast<double>(contestant.particles);
    steps =
        std::max(sampling.least_steps, static_cast<std::uint64_t>(sampling.seconds / seconds) + 1);
    const double affordable = sampling.most / (static_cast<double>(steps) * seconds);
    samples = affordable < sampling.samples
                  ? std::clamp(static_cast<unsigned>(affordable),
                               std::min(least_samples, sampling.samples), sampling.samples)
                  : sampling.samples;
  }

  /// Whether fewer samples than rounds, spread evenly over them, include this round.
  bool takes_part(unsigned round, unsigned rounds) const {
    return failure.empty() && round * samples / rounds != (round + 1) * samples / rounds;
  }

  template <class Work>
  void attempt(Work&& work) {
    try {
      work();
    } catch (const StepFailure& fault) {
      failure = fault.what();
    }
  }
};

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Spread spread(std::vector<double> samples) {
  if (samples.empty()) throw std::invalid_argument("no samples");
  std::sort(samples.begin(), samples.end());
  return {quantile(samples, 0.5), quantile(samples, 0.25), quantile(samples, 0.75), samples.size()};
}

std::vector<Measured> time_in_turns(const std::vector<Contestant>& contestants,
                                    const Sampling& sampling) {
  std::vector<Turn> turns;
  for (const auto& contestant : contestants) {
    auto& turn = turns.emplace_back(Turn{contestant});
    turn.attempt([&] { turn.prepare(sampling); });
  }
  for (unsigned round = 0; round < sampling.samples; ++round) {
    for (auto& turn : turns) {
      if (!turn.takes_part(round, sampling.samples)) continue;
      turn.attempt([&] { turn.measured.push_back(turn.time(turn.steps)); });
    }
  }
  std::vector<Measured> all;
  for (auto& turn : turns) {
    all.push_back({turn.failure.empty() ? spread(turn.measured) : Spread{}, turn.failure});
  }
  return all;
}

}  // namespace driftless
