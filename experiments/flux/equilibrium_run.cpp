#include "experiments/flux/equilibrium_run.hpp"

#include <cmath>
#include <deque>
#include <map>
#include <numbers>

namespace driftless::flux {
namespace {

using nlohmann::json;

constexpr double sample_period = 0.02;
constexpr double window = 4;       ///< of the autocorrelation
constexpr double pair_period = 1;  ///< between sums over pairs

/// zeta_0 at a temperature by the closure, lambda_0 by the heat form.
double friction_at(const FluidParameters& fluid, double temperature) {
  const bool noise = fluid.friction_closure == FrictionClosure::noise;
  return noise ? fluid.friction * fluid.temperature / temperature : fluid.friction;
}
double conduction_at(const FluidParameters& fluid, double temperature) {
  if (!fluid.has_conduction()) return 0;
  const bool inverse = fluid.heat_form == HeatForm::inverse_temperature;
  return inverse ? fluid.conduction / (temperature * temperature) : fluid.conduction;
}

/// int w(r) 4 pi r^power dr of w = (1 - r/range)^s: a beta function.
double weight_moment(double range, double exponent, double power) {
  return 4 * std::numbers::pi * std::pow(range, power + 1) * std::beta(power + 1, exponent + 1);
}

/// <v(0) v(t)> of one component, over particles and origins.
class Autocorrelation {
 public:
  explicit Autocorrelation(std::size_t lags) : sums_(lags, 0.0) {}
  void sample(const State& state) {
    auto& present = past_.emplace_front(state.size());
    for (std::size_t i = 0; i < state.size(); ++i) present[state.id[i]] = state.velocity[i];
    if (past_.size() > sums_.size()) past_.pop_back();
    if (past_.size() < sums_.size()) return;
    for (std::size_t lag = 0; lag < sums_.size(); ++lag) {
      double sum = 0;
      for (std::size_t i = 0; i < state.size(); ++i) sum += past_[lag][i].dot(past_[0][i]);
      sums_[lag] += sum / (3 * static_cast<double>(state.size()));
    }
    ++samples_;
  }
  /// Since the last call.
  std::vector<double> take() {
    std::vector<double> means(sums_.size());
    for (std::size_t lag = 0; lag < sums_.size(); ++lag) means[lag] = sums_[lag] / samples_;
    sums_.assign(sums_.size(), 0.0);
    samples_ = 0;
    return means;
  }

 private:
  std::deque<std::vector<Vector>> past_;
  std::vector<double> sums_;
  double samples_ = 0;
};

/// int C(t) exp(-rate t) dt by the trapezoidal rule.
double integral(const std::vector<double>& c, double interval, double rate) {
  double sum = 0.5 * c.front();
  for (std::size_t n = 1; n < c.size(); ++n) {
    const double share = n + 1 == c.size() ? 0.5 : 1;
    sum += share * c[n] * std::exp(-rate * interval * static_cast<double>(n));
  }
  return sum * interval;
}

/// Where C has fallen to C(0)/e, between samples as an exponential does.
double time_to_e(const std::vector<double>& c, double interval) {
  const double level = c.front() / std::numbers::e;
  for (std::size_t n = 1; n < c.size(); ++n) {
    if (c[n] > level) continue;
    const double part = std::log(c[n - 1] / level) / std::log(c[n - 1] / c[n]);
    return interval * (static_cast<double>(n - 1) + part);
  }
  return window;
}

/// Means over a run: of series in time, and of values of blocks that are long enough to count as
/// independent.
class Blocks {
 public:
  void add(const std::string& key, double value) { values_[key].push_back(value); }
  void add_independent(const std::string& key, double value) {
    add(key, value);
    independent_[key].push_back(Eigen::VectorXd::Constant(1, value));
  }
  double mean(const std::string& key) const {
    double sum = 0;
    for (const double value : values_.at(key)) sum += value;
    return sum / static_cast<double>(values_.at(key).size());
  }
  json record() const {
    json all;
    for (const auto& [key, values] : values_) {
      const Eigen::VectorXd series = Eigen::Map<const Eigen::VectorXd>(
          values.data(), static_cast<Eigen::Index>(values.size()));
      const auto apart = independent_.find(key);
      all[key] = to_record(apart == independent_.end() ? estimate_mean({series})
                                                       : estimate_mean(apart->second));
    }
    return all;
  }

 private:
  std::map<std::string, std::vector<double>> values_;
  std::map<std::string, std::vector<Eigen::VectorXd>> independent_;
};

void add_temperatures(System& system, Blocks& blocks) {
  const double degrees = 3 * (static_cast<double>(system.size()) - 1);
  blocks.add("temperature", 2 * system.kinetic_energy() / (degrees * system.fluid().boltzmann()));
  double inverse = 0;
  for (const double u : system.state().internal_energy)
    inverse += 1 / system.fluid().temperature(u);
  blocks.add("internal_temperature", static_cast<double>(system.size()) / inverse);
}

void add_pair_sums(System& system, double temperature, Blocks& blocks) {
  const PairSums sums = pair_sums(system, temperature);
  blocks.add("collision_rate", sums.collision_rate);
  blocks.add("heat_rate", sums.heat_rate);
  blocks.add("conduction", sums.conductivity);
  blocks.add("pair_viscosity", sums.viscosity);
}

/// Amplitude of v_x sin(kz) and v_y cos(kz), their mean.
double shear_amplitude(const State& state, double k) {
  double sum = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double phase = k * state.position[i][2];
    sum += state.velocity[i][0] * std::sin(phase) + state.velocity[i][1] * std::cos(phase);
  }
  return sum / static_cast<double>(state.size());
}

}  // namespace

PairSums pair_sums(System& system, double temperature) {
  const FluidParameters& f = system.fluid().parameters();
  const double zeta_0 = friction_at(f, temperature), lambda_0 = conduction_at(f, temperature);
  const auto particles = static_cast<double>(system.size());
  const double volume = system.box().volume();
  PairSums sums;
  system.for_each_pair([&](const System::Geometry& pair) {
    const double zeta = zeta_0 * pair.w_friction, lambda = lambda_0 * pair.w_heat;
    sums.collision_rate += 2 * zeta / (3 * f.mass * particles);
    sums.heat_rate += 2 * lambda / (f.heat_capacity * particles);
    sums.conductivity += lambda * pair.r * pair.r / (3 * volume);
    sums.viscosity += zeta * pair.r * pair.r / (15 * volume);
  });
  return sums;
}

PairSums without_structure(const FluidParameters& f, double density, double temperature) {
  const double zeta_0 = friction_at(f, temperature), lambda_0 = conduction_at(f, temperature);
  const double s = f.weight_exponent;
  return {density * zeta_0 * weight_moment(f.friction_range, s, 2) / (3 * f.mass),
          density * lambda_0 * weight_moment(f.heat_range, s, 2) / f.heat_capacity,
          density * density * lambda_0 * weight_moment(f.heat_range, s, 4) / 6,
          density * density * zeta_0 * weight_moment(f.friction_range, s, 4) / 30};
}

Conductivity predicted_conductivity(const FluidParameters& f, double density, double temperature,
                                    const PairSums& sums) {
  const double squared_speed = f.boltzmann * temperature / f.mass;
  return {sums.conductivity,
          density * f.heat_capacity * squared_speed / (sums.collision_rate + sums.heat_rate),
          2.5 * density * f.boltzmann * squared_speed / (3 * sums.collision_rate)};
}

json run_in_equilibrium(const PeriodicFluid& fluid, double duration, std::size_t count) {
  Run run(fluid, 2);
  System& system = run.system();
  run.advance(5);
  const auto stride = run.steps_in(sample_period), pairs = run.steps_in(pair_period);
  const double interval = fluid.step * static_cast<double>(stride);
  Autocorrelation correlation(static_cast<std::size_t>(std::llround(window / interval)) + 1);
  run.advance(window + interval, [&, n = std::uint64_t{0}]() mutable {
    if (++n % stride == 0) correlation.sample(system.state());
  });
  correlation.take();

  Blocks blocks;
  std::vector<double> mean;
  for (std::size_t n = 0; n < count; ++n) {
    run.advance(duration / static_cast<double>(count), [&, step = std::uint64_t{0}]() mutable {
      ++step;
      if (step % stride == 0) correlation.sample(system.state());
      if (step % pairs == 0) add_temperatures(system, blocks);
      if (step % pairs == 0) add_pair_sums(system, fluid.temperature, blocks);
    });
    const auto c = correlation.take();
    mean.resize(c.size(), 0.0);
    for (std::size_t lag = 0; lag < c.size(); ++lag) {
      mean[lag] += c[lag] / static_cast<double>(count);
    }
    blocks.add_independent("collision_time", integral(c, interval, 0) / c.front());
    blocks.add_independent("time_to_e", time_to_e(c, interval));
    blocks.add_independent("diffusion", integral(c, interval, 0));
    blocks.add_independent("heat_diffusion", integral(c, interval, blocks.mean("heat_rate")));
  }
  json record = blocks.record();
  for (std::size_t lag = 0; lag < mean.size(); ++lag) {
    record["vacf"]["time"].push_back(interval * static_cast<double>(lag));
    record["vacf"]["value"].push_back(mean[lag] / mean.front());
  }
  return record;
}

json run_shear_decay(const PeriodicFluid& fluid, double amplitude, std::size_t replicas,
                     double expected_viscosity) {
  const double k = 2 * std::numbers::pi / fluid.lengths[2];
  const double mass_density = fluid.density * fluid.fluid.mass;
  const double decay = mass_density / (expected_viscosity * k * k);
  const double speed =
      amplitude * std::sqrt(fluid.fluid.boltzmann * fluid.temperature / fluid.fluid.mass);
  const double first = 1;  // when the stress has followed the wave
  std::vector<double> early_all, late_all;
  for (std::size_t n = 0; n < replicas; ++n) {
    Run run(fluid, 10 + n);
    State state = run.system().state();
    for (std::size_t i = 0; i < state.size(); ++i) {
      const double phase = k * state.position[i][2];
      state.velocity[i] += speed * Vector(std::sin(phase), std::cos(phase), 0);
    }
    run.system().set_state(std::move(state));
    run.advance(first);
    early_all.push_back(shear_amplitude(run.system().state(), k));
    run.advance(decay);
    late_all.push_back(shear_amplitude(run.system().state(), k));
  }
  Eigen::MatrixXd samples(replicas, 2);
  for (std::size_t n = 0; n < replicas; ++n) samples.row(n) << early_all[n], late_all[n];
  const Estimate viscosity = estimate({samples}, [&](const Eigen::VectorXd& means) {
    return std::log(means[0] / means[1]) / decay * mass_density / (k * k);
  });
  return {{"viscosity", to_record(viscosity)}, {"wavenumber", k}};
}

}  // namespace driftless::flux
