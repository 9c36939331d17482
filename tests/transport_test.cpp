// Transport coefficients: modes, decays, diffusion, networks, against what can be solved.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "experiments/judge/small_system.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/transport/equilibrium.hpp"
#include "experiments/transport/gradient.hpp"
#include "experiments/transport/network.hpp"
#include "experiments/transport/starts.hpp"
#include "experiments/transport/theory.hpp"
#include "experiments/transport/waves.hpp"
#include "model/initial.hpp"

namespace driftless::transport {
namespace {

using std::numbers::pi;

/// How far chance takes an estimate from the truth once in 10^8 (Student's law).
double bound(const Estimate& estimate) {
  const double freedom = estimate.degrees_of_freedom;
  return student_quantile(freedom, 5e-9) * estimate.error / student_factor(freedom);
}

// ---- Decays

Decay curve(double interval, std::size_t points, const std::function<double(double)>& value) {
  Decay decay{interval, {}};
  for (std::size_t n = 0; n < points; ++n) {
    decay.values.push_back(value(interval * static_cast<double>(n)));
  }
  return decay;
}

TEST(Decay, AnExponentialHasOneRate) {
  const auto decay = curve(0.05, 100, [](double t) { return 7 * std::exp(-1.3 * t); });
  const auto fit = fit_exponential(decay);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->rate, 1.3, 1e-10);
  EXPECT_NEAR(fit->amplitude, 7, 1e-9);
  EXPECT_NEAR(integral_rate(decay), 1.3, 1e-6);
}

TEST(Decay, TheIntegralHoldsFormsThatAreNoExponentials) {
  // int 0.3 exp(-4 t) + 0.7 exp(-t) = 0.775
  const auto decay =
      curve(0.02, 400, [](double t) { return 0.3 * std::exp(-4 * t) + 0.7 * std::exp(-t); });
  EXPECT_NEAR(integral_rate(decay, 0.02), 1 / 0.775, 2e-3);
  // The fit of the middle sees neither end.
  EXPECT_LT(fit_exponential(decay, 0.5, 0.1)->rate, 0.9 / 0.775);
}

TEST(Decay, WhatDoesNotDecayIsNoRate) {
  EXPECT_THROW(integral_rate(curve(0.1, 50, [](double) { return 1.0; })), std::domain_error);
  EXPECT_THROW(integral_rate(curve(0.1, 50, [](double t) { return std::exp(t); })),
               std::domain_error);
  EXPECT_FALSE(fit_exponential({0.1, {1, 0.5, 0.05}}));
}

TEST(Decay, AnOscillationIsFoundFromARoughGuess) {
  const double omega = 2, gamma = 0.4;
  const auto decay = curve(0.1, 80, [&](double t) {
    return std::exp(-gamma * t) * (std::cos(omega * t) - 0.2 * std::sin(omega * t));
  });
  for (const double guess : {1.5, 2.0, 2.6}) {
    const auto fit = fit_oscillation(decay, guess);
    ASSERT_TRUE(fit) << guess;
    EXPECT_NEAR(fit->rate, gamma, 1e-6);
    EXPECT_NEAR(std::abs(fit->frequency), omega, 1e-6);
    EXPECT_NEAR(fit->undamped_frequency(), std::hypot(omega, gamma), 1e-6);
  }
}

/// exp(-rate t) with noise of its own at every time, as `replicas` curves.
std::vector<std::vector<double>> noisy_curves(std::size_t replicas, double rate,
                                              std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0, 0.02);
  std::vector<std::vector<double>> all(replicas);
  for (auto& one : all) {
    for (int n = 0; n < 60; ++n) one.push_back(std::exp(-rate * 0.1 * n) + normal(engine));
  }
  return all;
}

double rate_of(const std::vector<double>& mean) { return integral_rate({0.1, mean}); }

TEST(Jackknife, ItsIntervalsCoverTheTruth) {
  int covered = 0;
  constexpr int trials = 400;
  for (int trial = 0; trial < trials; ++trial) {
    const auto found = jackknife(noisy_curves(8, 1, 100 + trial), rate_of);
    covered += std::abs(found.mean - 1) < interval_quantile * found.error;
  }
  // 380 +- 4.4 expected; 6 standard deviations make 1e-9.
  EXPECT_GT(covered, 380 - 27);
  EXPECT_LT(covered, 400);
}

TEST(Jackknife, OneReplicaHasNoError) {
  EXPECT_TRUE(std::isinf(jackknife(noisy_curves(1, 1, 1), rate_of).error));
  EXPECT_THROW(jackknife({}, rate_of), std::invalid_argument);
  EXPECT_TRUE(std::isinf(jackknife({{1, 1, 1, 1}, {1, 1, 1, 1}}, rate_of).error));
}

// ---- Langevin's equation, whose every number is known

/// Exact samples of dv = -rate v dt + noise with <v^2> = 1, dr = v dt.
struct Langevin {
  double rate, interval;
  std::mt19937_64 engine{17};
  std::normal_distribution<double> normal{};

  double kept() const { return std::exp(-rate * interval); }
  double next(double v) { return kept() * v + std::sqrt(1 - kept() * kept()) * normal(engine); }
};

TEST(Correlation, OfALangevinSeriesIsItsExponential) {
  Langevin langevin{0.5, 0.1};
  std::vector<std::vector<double>> replicas;
  for (int replica = 0; replica < 20; ++replica) {
    std::vector<Complex> series;
    Complex a(langevin.normal(langevin.engine), langevin.normal(langevin.engine));
    for (int n = 0; n < 20000; ++n) {
      series.push_back(a);
      a = {langevin.next(a.real()), langevin.next(a.imag())};
    }
    replicas.push_back(autocorrelation(series, 100));
  }
  const auto rate = jackknife(replicas, [](const auto& mean) {
    return integral_rate({0.1, mean});
  });
  // 20 runs of 1000 correlation times, two components: 1-2 % expected.
  EXPECT_LT(rate.error, 0.02);
  EXPECT_NEAR(rate.mean, 0.5, bound(rate));
  // A planted fault: every second sample taken for the next is half the rate.
  const auto wrong = jackknife(replicas, [](const auto& mean) {
    return integral_rate({0.2, mean});
  });
  EXPECT_GT(std::abs(wrong.mean - 0.5), bound(wrong));
}

TEST(Correlation, WantsMoreSamplesThanLags) {
  EXPECT_THROW(autocorrelation({1, 2}, 3), std::invalid_argument);
}

TEST(Correlation, WhatGoesAlongIsTakenOut) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  std::vector<Complex> density, energy;
  for (int n = 0; n < 50; ++n) {
    density.emplace_back(normal(engine), normal(engine));
    energy.push_back(3.0 * density.back());
  }
  for (const auto& rest : orthogonal_part(energy, density)) EXPECT_LT(std::abs(rest), 1e-12);
}

// ---- Streaming: particles that never meet

FluidParameters free_fluid() {
  FluidParameters f;
  f.boltzmann = 0.5;
  f.mass = 2;
  f.temperature = 1.5;
  f.heat_capacity = 50;
  return f;
}

/// Free flight, with the velocities taken `factor` times.
class Flight : public Integrator {
 public:
  explicit Flight(double factor = 1) : factor_(factor) {}
  void step(System& system, double dt) override { system.move(factor_ * dt); }

 private:
  double factor_;
};

Estimate streaming_rate(double factor) {
  const auto f = free_fluid();
  const auto box = fluid_box(16, 16, 1);
  const double k = 2 * pi / 16, thermal = std::sqrt(f.boltzmann * f.temperature / f.mass);
  std::vector<std::vector<double>> replicas;
  double interval = 0;
  for (unsigned replica = 0; replica < 20; ++replica) {
    System system = ideal_start(f, box, Noise(3, replica));
    Flight flight(factor);
    std::uint64_t done = 0;
    const Waves waves{{0, 1, 2}, 1, 0.3, 0, 0};
    const WaveSchedule schedule{0.1 / (k * thermal), 1, 60, 1};
    const auto record = relax(waves, schedule, flight, system, done);
    interval = record.interval;
    replicas.push_back(record.transverse);
  }
  return jackknife(replicas, [&](const auto& mean) {
    return integral_rate({interval, mean}, 0.02);
  });
}

TEST(Waves, OfAnIdealGasMixBallistically) {
  // exp(-(k v_T t)^2/2), whose integral is sqrt(pi/2)/(k v_T).
  const auto f = free_fluid();
  const double thermal = std::sqrt(f.boltzmann * f.temperature / f.mass);
  const double expected = 2 * pi / 16 * thermal * std::sqrt(2 / pi);
  const auto right = streaming_rate(1), wrong = streaming_rate(1.2);
  EXPECT_LT(right.error, 0.03 * expected);
  EXPECT_NEAR(right.mean, expected, bound(right));
  EXPECT_GT(std::abs(wrong.mean - expected), bound(wrong));
}

TEST(Waves, KeepEnergyAndMomentum) {
  System system = ideal_start(free_fluid(), fluid_box(6, 5, 2), Noise(1, 0));
  const double energy = system.total_energy();
  impose({{0, 1}, 2, 0.4, 0.3, 0.2}, 0.7, system);
  EXPECT_NEAR(system.total_energy(), energy, 1e-12 * energy);
  EXPECT_LT(system.momentum().norm(), 1e-10);
}

TEST(Diffusion, FollowsParticlesThroughTheBox) {
  State state;
  state.id = {0, 1};
  state.position = {Vector(1, 1, 1), Vector(3, 3, 3)};
  state.velocity = {Vector(2, 0, 0), Vector(0, 0, -1)};
  state.internal_energy = {1, 1};
  System system(Fluid(free_fluid()), Box{Vector(4, 4, 4)}, state, Noise(1, 0));
  Diffusion diffusion(11);
  for (int n = 0; n < 11; ++n) {
    diffusion.take(system);
    system.move(0.5);
  }
  // Both fly: 2.5 (4 t^2 + t^2)/2 up to t = 5, more than the box.
  EXPECT_NEAR(diffusion.squared_displacement().back(), 2.5 * 25, 1e-9);
  EXPECT_NEAR(diffusion.velocity_autocorrelation().back(), 2.5 / 3, 1e-12);
}

TEST(Diffusion, OfLangevinIsItsConstant) {
  const double rate = 2;
  // 6 D t - 6 D/rate (1 - exp(-rate t)) with D = 1/rate.
  const auto moved =
      curve(0.1, 100, [&](double t) { return 6 / rate * (t - (1 - std::exp(-rate * t)) / rate); });
  EXPECT_NEAR(diffusion_from_displacement(moved), 1 / rate, 1e-4);
  const auto turned = curve(0.02, 200, [&](double t) { return std::exp(-rate * t); });
  EXPECT_NEAR(diffusion_from_velocity(turned), 1 / rate, 1e-4);
}

// ---- Conduction in a frozen lattice

FluidParameters solid() {
  FluidParameters f;
  f.boltzmann = 1e-7;
  f.heat_capacity = 2;
  f.temperature = 1.5;
  f.conduction = 3;
  f.heat_form = HeatForm::inverse_temperature;
  f.heat_range = 1.7;
  return f;
}

Box lattice_box() { return {Vector::Constant(8)}; }

State lattice_state(const FluidParameters& f) {
  State state = place(lattice_box(), Layout::fluid, Placement::lattice, 512, 0, Noise(1, 0));
  state.internal_energy.assign(512, (f.heat_capacity + f.boltzmann) * f.temperature);
  return state;
}

/// sum_j L_0 w(r) (1 - cos k x)/(phi T^2) over the neighbours of a site of the unit lattice.
double lattice_rate(const FluidParameters& f) {
  double sum = 0;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        const double r = std::sqrt(x * x + y * y + z * z);
        if (r == 0 || r >= f.heat_range) continue;
        sum += std::pow(1 - r / f.heat_range, 2) * (1 - std::cos(2 * pi / 8 * x));
      }
    }
  }
  return f.conduction * sum / (f.heat_capacity * f.temperature * f.temperature);
}

Estimate lattice_relaxation(double conduction_factor) {
  auto f = solid();
  f.conduction *= conduction_factor;
  const double rate = lattice_rate(solid());
  std::vector<std::vector<double>> replicas;
  double interval = 0;
  for (unsigned replica = 0; replica < 4; ++replica) {
    System system(Fluid(f), lattice_box(), lattice_state(f), Noise(5, replica), true);
    const auto method = find_method("averaged-drift")->make({});
    std::uint64_t done = 0;
    const auto record =
        relax({{0, 1, 2}, 1, 0, 0, 0.02}, {0.004 / rate, 25, 40, 1}, *method, system, done);
    interval = record.interval;
    replicas.push_back(record.temperature);
  }
  return jackknife(replicas, [&](const auto& mean) { return integral_rate({interval, mean}); });
}

TEST(Waves, OfTemperatureInALatticeRelaxAsTheSumOverPairsSays) {
  const double expected = lattice_rate(solid());
  const auto right = lattice_relaxation(1), wrong = lattice_relaxation(1.1);
  EXPECT_LT(right.error, 0.001 * expected);
  // Euler's step makes the rate 0.2 % larger; the amplitude's square is below 0.1 %. the noise of
  // heat is a thousandth of the wave.
  EXPECT_NEAR(right.mean, 1.002 * expected, 0.005 * expected);
  EXPECT_GT(wrong.mean - expected, 5 * wrong.error);
}

TEST(Gradient, InALatticeConductsAsTheSumOverPairsSays) {
  const auto f = solid();
  const double expected = lattice_rate(f) * f.heat_capacity / std::pow(2 * pi / 8, 2);
  for (const auto shape : {HeatShape::cosine, HeatShape::slabs}) {
    System system(Fluid(f), lattice_box(), lattice_state(f), Noise(7, 0), true);
    const auto method = find_method("averaged-drift")->make({});
    const double rate = lattice_rate(f);
    HeatSource source(shape, 0, 0.02 * f.heat_capacity * f.temperature * rate);
    const double energy = system.total_energy(), step = 0.02 / rate;
    std::vector<double> found;
    for (std::uint64_t n = 1; n <= 6000; ++n) {
      system.set_step(n);
      method->step(system, step);
      source.apply(system, step);
      source.measure(system);
      if (n % 500 != 0) continue;
      if (n > 1000) found.push_back(source.conductivity(system));
      source.reset();
    }
    double mean = 0, square = 0;
    for (const double one : found) mean += one / 10;
    for (const double one : found) square += (one - mean) * (one - mean) / 90;
    // Ten windows of ten relaxation times: Student's law of nine degrees of freedom. A cosine is an
    // eigenmode; slabs of 2 % amplitude change the wave by less than 2e-3.
    EXPECT_LT(std::sqrt(square), 0.002 * expected);
    EXPECT_NEAR(mean, expected, student_quantile(9, 5e-9) * std::sqrt(square) + 0.002 * expected);
    EXPECT_NEAR(system.total_energy(), energy, 1e-9 * energy);
  }
}

TEST(Network, OfALatticeIsItsSumOverPairs) {
  std::vector<Vector> sites;
  for (int n = 0; n < 512; ++n) sites.emplace_back(n % 8 + 0.5, n / 8 % 8 + 0.5, n / 64 + 0.5);
  double sum = 0;  // sum_j w x^2 of a site
  const double range = 1.7;
  for (int n = 0; n < 125; ++n) {
    const Vector d(n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2);
    if (d.norm() > 0 && d.norm() < range) sum += std::pow(1 - d.norm() / range, 2) * d[0] * d[0];
  }
  const double uniform = 4 * pi / 3 * std::pow(range, 5) * 24 / (3 * 4 * 5 * 6 * 7);
  const Box box{Vector::Constant(8)};
  EXPECT_NEAR(network_conductivity(sites, box, range, 2, 1), sum / uniform, 1e-6);
  double shear = 0;  // sum_j w r^2 e_x^2 e_y^2
  for (int n = 0; n < 125; ++n) {
    const Vector d(n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2);
    const double r = d.norm();
    if (r > 0 && r < range) shear += std::pow((1 - r / range) * d[0] * d[1] / r, 2);
  }
  EXPECT_NEAR(network_viscosity(sites, box, range, 2, 1), 5 * shear / uniform, 1e-6);
}

TEST(Network, IsWorseTheFewerInteract) {
  const auto few = random_network(1000, 8, 2, 1), many = random_network(600, 60, 2, 1);
  EXPECT_GT(few.conductivity, 0.25);
  EXPECT_LT(few.conductivity, 0.5);
  EXPECT_LT(few.viscosity, few.conductivity);
  EXPECT_GT(many.conductivity, 0.8);
  EXPECT_LT(many.conductivity, 1.05);
  EXPECT_GT(many.viscosity, few.viscosity);
}

// ---- Theory

TEST(Theory, LongWavesHaveThePublishedCoefficients) {
  const auto f = find_preset("mackie-1999")->scene.fluid;
  const double r5 = std::pow(1.24, 5);
  EXPECT_NEAR(dissipative_viscosity(f, 1), 2 * pi * r5 / 1575, 1e-6);
  EXPECT_NEAR(dissipative_conductivity(f, 1), 2 * pi * 850 * r5 / (315 * 1.21), 1e-3);
  EXPECT_NEAR(collision_rate(f, 1), 2 * pi * std::pow(1.24, 3) / 45, 1e-12);
  const double kinetic = 0.55 / (2 * collision_rate(f, 1));
  EXPECT_NEAR(mean_field_viscosity(f, 1, 1e-3), dissipative_viscosity(f, 1) + kinetic, 1e-4);
  EXPECT_LT(mean_field_viscosity(f, 1, 1), 0.6 * kinetic);
  const double carried = 50 * 0.55 / (collision_rate(f, 1) + heat_rate(f, 1));
  EXPECT_NEAR(mean_field_conductivity(f, 1, 1e-3), dissipative_conductivity(f, 1) + carried, 1e-2);
}

/// A fluid of 54 neighbours, close to the mean field.
FluidParameters dense_fluid() {
  auto f = find_preset("mackie-1999")->scene.fluid;
  f.temperature = 1;
  f.friction_range = f.heat_range = 2.35;
  f.conduction = 10;
  return f;
}

struct Coefficients {
  Estimate viscosity, conductivity;
};

Coefficients measured(Integrator& integrator) {
  const auto f = dense_fluid();
  const auto box = fluid_box(8, 6, 1);
  std::vector<std::vector<double>> transverse, heat;
  double interval = 0;
  for (unsigned replica = 0; replica < 14; ++replica) {
    System system = ideal_start(f, box, Noise(11, replica));
    std::uint64_t done = 0;
    const auto record = relax({{0}, 1, 0.5, 0, 0.14}, {0.1, 2, 50, 2}, integrator, system, done);
    transverse.push_back(record.transverse), heat.push_back(record.temperature);
    interval = record.interval;
  }
  const double k = 2 * pi / 8;
  const auto eta = [&](const auto& mean) { return viscosity({interval, mean}, k, f, 1); };
  const auto lambda = [&](const auto& mean) { return conductivity({interval, mean}, k, f, 1); };
  return {jackknife(transverse, eta), jackknife(heat, lambda)};
}

/// A sound method whose time runs at a part of the speed: every average at equilibrium is as
/// it should be.
class Slow : public Integrator {
 public:
  explicit Slow(double speed) : speed_(speed) {}
  void step(System& system, double dt) override { inner_->step(system, speed_ * dt); }

 private:
  double speed_;
  std::unique_ptr<Integrator> inner_ = find_method("metropolized-splitting")->make({});
};

TEST(Waves, OfADenseFluidFollowTheMeanFieldUnlessTimeRunsSlow) {
  const auto f = dense_fluid();
  const double k = 2 * pi / 8;
  const double eta = mean_field_viscosity(f, 1, k), lambda = mean_field_conductivity(f, 1, k);
  Slow right(1), wrong(0.6);
  const auto found = measured(right), slow = measured(wrong);
  EXPECT_LT(found.viscosity.error, 0.12 * eta);
  EXPECT_LT(found.conductivity.error, 0.05 * lambda);
  // The mean field is good to some per cent with 54 neighbours.
  EXPECT_NEAR(found.viscosity.mean, eta, 0.05 * eta + bound(found.viscosity));
  EXPECT_NEAR(found.conductivity.mean, lambda, 0.03 * lambda + bound(found.conductivity));
  EXPECT_GT(lambda - slow.conductivity.mean, 0.03 * lambda + bound(slow.conductivity));
}

// The mean of many replicas in equilibrium and the decay of an imposed wave are one thing
// (Onsager).
TEST(Equilibrium, AutocorrelationsDecayAsImposedWavesDo) {
  auto f = find_preset("mackie-1999")->scene.fluid;
  f.conduction = 100;
  const auto box = fluid_box(7, 5, 1);
  const auto method = find_method("metropolized-splitting");
  std::vector<std::vector<double>> transverse, heat, wave, warm;
  double interval = 0;
  for (unsigned replica = 0; replica < 16; ++replica) {
    System system = ideal_start(f, box, Noise(13, replica));
    const auto integrator = method->make({});
    std::uint64_t done = 0;
    EquilibriumSchedule still;
    still.step = 0.05, still.steps = 3000, still.particle_stride = 12, still.axes = {0};
    still.wave_stride = 6, still.wave_lags = 50;
    const auto quiet = run_equilibrium(still, *integrator, system, done);
    transverse.push_back(quiet.transverse), heat.push_back(quiet.heat);
    const auto record = relax({{0}, 1, 0.3, 0, 0.15}, {0.05, 6, 49, 8}, *integrator, system, done);
    wave.push_back(record.transverse), warm.push_back(record.temperature);
    interval = record.interval;
  }
  const auto rate = [&](const auto& mean) { return integral_rate({interval, mean}, 0.2); };
  for (const auto& [one, other] : {std::pair{jackknife(transverse, rate), jackknife(wave, rate)},
                                   std::pair{jackknife(heat, rate), jackknife(warm, rate)}}) {
    EXPECT_LT(one.error, 0.08 * other.mean);
    EXPECT_LT(other.error, 0.08 * one.mean);
    EXPECT_NEAR(one.mean, other.mean, std::hypot(bound(one), bound(other)));
    // Twice the rate, as of squared amplitudes, would show.
    EXPECT_GT(std::abs(one.mean - 2 * other.mean), std::hypot(bound(one), bound(other)));
  }
}

}  // namespace
}  // namespace driftless::transport
