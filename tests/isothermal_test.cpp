#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <memory>

#include "experiments/statistics.hpp"
#include "integrators/reference.hpp"
#include "integrators/shardlow.hpp"
#include "model/initial.hpp"
#include "tests/method_names.hpp"
#include "tests/small_system.hpp"

// Isothermal DPD: the laws of the fluid, the state without internal energies, and every method that
// runs it against exact laws and against the model with internal energies, of which it is the limit
// of infinite heat capacity.
namespace driftless::testing {
namespace {

constexpr double boltzmann = 0.5, temperature = 1.1;

FluidParameters isothermal_fluid(bool potential = false, double k = boltzmann) {
  return small_fluid({FrictionClosure::noise, HeatForm::none, potential, true}, k);
}

std::vector<const Method*> isothermal_methods() {
  std::vector<const Method*> all;
  for (const Method* method : methods()) {
    if (method->isothermal) all.push_back(method);
  }
  return all;
}

// ---- The model. --------------------------------------------------------------------------------

TEST(IsothermalFluid, HasTheBathsLawsForEitherClosure) {
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    auto f = isothermal_fluid();
    f.friction_closure = closure;
    f.heat_capacity = 7;  // of no meaning
    const Fluid fluid(f);
    EXPECT_TRUE(fluid.isothermal());
    EXPECT_DOUBLE_EQ(fluid.temperature(fluid.bath_energy()), temperature);
    const double u = fluid.bath_energy();
    const Pair<double> pair{0.3, 0.49, 0, -0.7, u, u, 0.2, 0};
    const auto law = fluid.friction(pair);
    EXPECT_DOUBLE_EQ(law.friction, 4 * 0.49);
    EXPECT_DOUBLE_EQ(law.noise_squared, 2 * boltzmann * temperature * 4 * 0.49);
    EXPECT_EQ(law.induced, 0);
    EXPECT_EQ(fluid.friction_noise_slopes(pair).by_u_i, 0);
  }
}

TEST(IsothermalFluid, RefusesToConduct) {
  auto f = isothermal_fluid();
  f.heat_form = HeatForm::temperature;
  EXPECT_NO_THROW(Fluid{f});
  f.conduction = 2;
  try {
    Fluid fluid(f);
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "conduction is 2, allowed is 0 in an isothermal fluid, whose particles have no "
                 "heat to exchange");
  }
}

bool has_no_energies(const State& state) {
  return std::all_of(state.internal_energy.begin(), state.internal_energy.end(),
                     [](double u) { return u == 0; });
}

TEST(IsothermalSystem, GivesWhatItsEnergiesWouldGetToTheBath) {
  const auto f = isothermal_fluid(true);
  State start = small_state(f);
  start.internal_energy.assign(start.size(), 3);
  System system(Fluid(f), small_box(), start, Noise(1, 0));
  EXPECT_TRUE(has_no_energies(system.state()));
  EXPECT_EQ(system.total_energy(), system.kinetic_energy() + system.potential_energy());
  const auto gives = [&](const auto& pair) {
    EXPECT_EQ(pair.u_i, system.fluid().bath_energy());
    return Transfer{0.01 * pair.v, pair.v, -2 * pair.v};
  };
  Exchange exchange;
  system.accumulate([&](const Pair<double>& pair) { return gives(pair); }, exchange);
  for (const double energy : exchange.energy) EXPECT_EQ(energy, 0);
  EXPECT_GT(exchange.momentum[0].norm(), 0);
  exchange.energy.assign(system.size(), 5);
  EXPECT_NO_THROW(system.apply(exchange));
  EXPECT_TRUE(has_no_energies(system.state()));
  for (const auto energies : {SweepEnergies::fresh, SweepEnergies::frozen}) {
    system.sweep([&](const Pair<double>& pair) { return gives(pair); }, {.energies = energies});
    EXPECT_TRUE(has_no_energies(system.state()));
  }
  system.update([](std::size_t, Vector&, double& u) { u = -1; });
  EXPECT_TRUE(has_no_energies(system.state()));
  Motion motion = system.motion();
  motion.internal_energy.assign(system.size(), 2);
  system.set_motion(motion);
  EXPECT_TRUE(has_no_energies(system.state()));
  system.set_state(start);
  EXPECT_TRUE(has_no_energies(system.state()));
}

TEST(IsothermalSystem, FailsForWhatIsNotANumberAlone) {
  const auto f = isothermal_fluid();
  System system(Fluid(f), small_box(), small_state(f), Noise(1, 0));
  try {
    system.update([](std::size_t i, Vector& v, double&) {
      if (i == 3) v[1] = std::nan("");
    });
    ADD_FAILURE();
  } catch (const StepFailure& failure) {
    EXPECT_EQ(failure.cause(), FailureCause::non_finite);
    EXPECT_EQ(failure.ids(), std::vector<std::uint32_t>{3});
  }
}

/// K/kT of an island with the momentum removed is Gamma(degrees/2): its mean and variance. 6.1
/// standard errors leave one false alarm in 10^9.
TEST(CanonicalStart, IsMaxwellsLawWithoutMomentum) {
  const Fluid fluid(isothermal_fluid());
  for (const auto layout : {Layout::fluid, Layout::pairs}) {
    const std::size_t particles = 8;
    const double degrees = layout == Layout::pairs ? 4 : 21;
    const int draws = 20000;
    double sum = 0, squares = 0;
    for (int draw = 0; draw < draws; ++draw) {
      const Noise noise(5, static_cast<std::uint64_t>(draw));
      State state =
          place(Box{Vector::Constant(20)}, Layout::fluid, Placement::random, particles, 0, noise);
      draw_canonical(fluid, layout, temperature, noise, state);
      EXPECT_TRUE(has_no_energies(state));
      const std::size_t size = layout == Layout::pairs ? 2 : particles;
      double kinetic = 0;
      for (std::size_t first = 0; first < particles; first += size) {
        Vector momentum = Vector::Zero();
        for (std::size_t i = first; i < first + size; ++i) {
          momentum += state.velocity[i];
          kinetic += 0.5 * fluid.mass() * state.velocity[i].squaredNorm();
        }
        ASSERT_LT(momentum.norm(), 1e-13);
      }
      const double gamma = kinetic / (boltzmann * temperature);
      sum += gamma / draws;
      squares += gamma * gamma / draws;
    }
    const double shape = degrees / 2;
    EXPECT_NEAR(sum, shape, 6.1 * std::sqrt(shape / draws));
    // Var of the sample variance of a Gamma variate: mu_4 - sigma^4 = 2 shape^2 + 6 shape.
    EXPECT_NEAR(squares - sum * sum, shape,
                6.2 * std::sqrt((2 * shape * shape + 6 * shape) / draws));
  }
}

// ---- Refusals. ---------------------------------------------------------------------------------

TEST(IsothermalRefusals, AreOfMethodsThatDoNotClaimIt) {
  const Fluid fluid(isothermal_fluid());
  for (const Method* method : methods()) {
    const auto reason = refusal(*method, fluid);
    EXPECT_EQ(reason.has_value(), !method->isothermal) << method->name;
    EXPECT_TRUE(method->isothermal || !method->isothermal_pair_law_exact) << method->name;
    if (!reason) continue;
    EXPECT_EQ(*reason, std::string(method->name) +
                           " is built for particles with internal energies, this scene is "
                           "isothermal and has none");
  }
  for (const auto* name : {"marsh-coveney", "shardlow-s1", "shardlow-s2", "groot-warren"}) {
    EXPECT_FALSE(refusal(*find_method(name), fluid).has_value()) << name;
  }
  EXPECT_TRUE(refusal(*find_method("isoenergetic-verlet"), fluid).has_value());
  EXPECT_TRUE(refusal(*find_method("metropolized-splitting"), fluid).has_value());
}

// ---- Pairs at a fixed distance, where v is normal of variance k T/mu. --------------------------

struct Moments {
  double second = 0, fourth = 0;  ///< of v (mu/kT)^{1/2}
  double samples = 0;             ///< independent ones, nearly
};

/// Frozen pairs from Maxwell's law, looked at every few steps; x = zeta dt/mu.
Moments moments_of(Integrator& integrator, double x, std::uint64_t seed = 3) {
  constexpr std::size_t pairs = 2000;
  constexpr int looks = 200, steps_between = 6, settling = 60;
  const Fluid fluid(isothermal_fluid());
  const double distance = 0.3, zeta = 4 * 0.49;
  const double dt = x * fluid.reduced_mass() / zeta;
  const Noise noise(seed, 0);
  const Box box = make_box(fluid, Layout::pairs, 2 * pairs, 1, distance);
  State state = place(box, Layout::pairs, Placement::lattice, 2 * pairs, distance, noise);
  draw_canonical(fluid, Layout::pairs, temperature, noise, state);
  System system(fluid, box, std::move(state), noise, true);
  run(integrator, system, dt, 1, settling + 1);
  Moments moments;
  std::uint64_t step = settling + 1;
  for (int look = 0; look < looks; ++look, step += steps_between) {
    run(integrator, system, dt, step, step + steps_between);
    for (std::size_t i = 0; i < 2 * pairs; i += 2) {
      const auto& velocity = system.state().velocity;
      const double v = velocity[i][0] - velocity[i + 1][0];
      const double square = v * v * fluid.reduced_mass() / (boltzmann * temperature);
      moments.second += square;
      moments.fourth += square * square;
    }
  }
  moments.samples = static_cast<double>(pairs) * looks;
  moments.second /= moments.samples;
  moments.fourth /= moments.samples;
  return moments;
}

Moments moments_of(const Method& method, double x, const Options& options = {}) {
  return moments_of(*method.make(options), x);
}

/// Whether v is normal of that variance, in units of k T/mu: the mean of v^2 has the relative error
/// (2/n)^{1/2}, that of v^4 (96/9n)^{1/2}. Looks are six steps apart, of which the slowest to
/// forget (a jump with p = 1 - 1/e) leaves a correlation of 0.003. Beyond 6.5 errors a false alarm
/// has a chance below 10^-9.
bool is_normal(const Moments& found, double variance) {
  const double second = 6.5 * std::sqrt(2 / found.samples) * variance;
  const double fourth = 6.5 * std::sqrt(96 / found.samples) * variance * variance;
  return std::abs(found.second - variance) < second &&
         std::abs(found.fourth - 3 * variance * variance) < fourth;
}

/// The stationary variance, in units of k T/mu, of velocity Verlet with an end point predicted with
/// lambda (predicted_verlet.hpp). With f the kept impulse over mu,
///   f' = -x v - lambda x f + (2x)^{1/2} W,  v' = v + (f + f')/2,
/// whose equations for <v^2>, <v f> and <f^2> have this solution: 1 for every x at lambda = 1/2,
/// where v + f/2 makes the Euler step and v is (1 - x/2) of it plus half of the fresh noise.
double predicted_verlet_variance(double lambda, double x) { return 1 / (1 + (lambda - 0.5) * x); }

/// 1/(1 - x/2): v' = (1 - x) v + (2x)^{1/2} W.
double euler_variance(double x) { return 1 / (1 - x / 2); }

TEST(IsothermalPairs, HaveMaxwellsLawAtAnyStepWhereClaimed) {
  for (const Method* method : isothermal_methods()) {
    if (!method->isothermal_pair_law_exact) continue;
    SCOPED_TRACE(std::string(method->name));
    std::vector<Options> choices = {{}};
    for (const auto& option : method->options) {
      if (option.name == "update") {
        choices = {{{"update", std::string("half-implicit")}},
                   {{"update", std::string("exponential")}}};
      }
      if (option.name == "scheme") choices.push_back({{"scheme", std::string("II")}});
      if (option.name == "resampling") choices.push_back({{"resampling", std::string("maxwell")}});
    }
    for (const auto& options : choices) {
      EXPECT_TRUE(is_normal(moments_of(*method, 1, options), 1));
    }
  }
}

TEST(IsothermalPairs, OfOtherMethodsHaveTheDerivedVariance) {
  const double x = 0.6;
  for (const auto* name : {"averaged-drift", "espanol", "marsh-coveney"}) {
    EXPECT_TRUE(is_normal(moments_of(*find_method(name), x), euler_variance(x))) << name;
  }
  for (const double lambda : {0.5, 0.65}) {
    const auto found = moments_of(*find_method("groot-warren"), x, {{"lambda", lambda}});
    EXPECT_TRUE(is_normal(found, predicted_verlet_variance(lambda, x))) << lambda;
  }
  EXPECT_TRUE(is_normal(moments_of(*find_method("velocity-verlet"), x), 1));
  EXPECT_FALSE(is_normal(moments_of(*find_method("groot-warren"), x), 1));  // lambda = 0.65
}

/// Every method that runs isothermal fluids is in one of the two tests above.
TEST(IsothermalPairs, OfEveryMethodAreJudged) {
  const std::vector<std::string_view> derived = {"averaged-drift", "espanol", "marsh-coveney",
                                                 "groot-warren", "velocity-verlet"};
  for (const Method* method : isothermal_methods()) {
    const bool listed = std::find(derived.begin(), derived.end(), method->name) != derived.end();
    EXPECT_NE(listed, method->isothermal_pair_law_exact) << method->name;
  }
}

/// shardlow-s1 whose noise is off by a factor.
class FaultyNoise : public Integrator {
 public:
  explicit FaultyNoise(double factor) : factor_(factor) {}
  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    system.sweep([&](const auto& pair) {
      auto seen = pair;
      seen.noise *= factor_;
      return shardlow_friction(fluid, seen, dt, {});
    });
    velocity_verlet(system, dt);
  }

 private:
  double factor_;
};

TEST(IsothermalPairs, ShowNoiseThatIsTwoPercentTooStrong) {
  FaultyNoise sound(1), strong(1.02), weak(0.98);
  EXPECT_TRUE(is_normal(moments_of(sound, 1), 1));
  EXPECT_FALSE(is_normal(moments_of(strong, 1), 1));
  EXPECT_FALSE(is_normal(moments_of(weak, 1), 1));
  // And the law of an Euler step is not mistaken for the exact one.
  EXPECT_FALSE(is_normal(moments_of(*find_method("marsh-coveney"), 0.6), 1));
}

// ---- Limits of the model with internal energies. -----------------------------------------------

class Isothermal : public ::testing::TestWithParam<const Method*> {};

/// The largest difference of positions and velocities.
double motion_apart(const State& a, const State& b) {
  const auto d = distance(small_box(), a, b);
  return std::max(d.position, d.velocity);
}

/// Particles of a heat capacity so large that nothing changes their temperature are a bath: with
/// the same noise the paths are the same, whatever the closure.
TEST_P(Isothermal, IsTheLimitOfInfiniteHeatCapacity) {
  const Method& method = *GetParam();
  for (const auto closure : method.closures) {
    for (const bool potential : {false, true}) {
      auto f = small_fluid({closure, HeatForm::none, potential}, boltzmann);
      f.heat_capacity = 1e10;
      State start = small_state(f);
      start.internal_energy.assign(start.size(), f.heat_capacity * f.temperature);
      const State expected = run(method, f, start, 0.01, 20);
      const auto bath = isothermal_fluid(potential);
      const State end = run(method, bath, start, 0.01, 20);
      EXPECT_TRUE(has_no_energies(end));
      EXPECT_LT(motion_apart(end, expected), 1e-8);
      // Of a small heat capacity they are not.
      f.heat_capacity = 12;
      start.internal_energy.assign(start.size(), f.heat_capacity * f.temperature);
      EXPECT_GT(motion_apart(run(method, f, start, 0.01, 60), run(method, bath, start, 0.01, 60)),
                1e-4);
    }
  }
}

/// Without fluctuations it is that of a friction which does not ask for temperatures.
TEST_P(Isothermal, ConvergesToTheDeterministicLimit) {
  const Method& method = *GetParam();
  const auto with_energies = small_fluid({FrictionClosure::friction}, 0);
  const double duration = 0.5;
  const State exact = reference_solution(Fluid(with_energies), small_box(),
                                         small_state(with_energies), false, duration);
  const auto f = isothermal_fluid(false, 0);
  State start = small_state(with_energies);
  start.internal_energy.assign(start.size(), 0);
  double errors[2];
  for (const int n : {0, 1}) {
    const int steps = 200 << n;
    errors[n] = motion_apart(
        run(method, f, start, duration / steps, static_cast<std::uint64_t>(steps)), exact);
  }
  if (!method.consistent) {
    EXPECT_GT(errors[1], 1e-3);
    return;
  }
  EXPECT_LT(errors[1], 1e-2);
  EXPECT_GT(std::log2(errors[0] / errors[1]), method.noise_free_order - 0.2);
}

INSTANTIATE_TEST_SUITE_P(Methods, Isothermal, ::testing::ValuesIn(isothermal_methods()), test_name);

// ---- The soft fluid. ---------------------------------------------------------------------------

/// Kinetic temperature over that of the bath, of a = 25, density 3, friction 4.5.
Estimate kinetic_temperature(const std::string& name, const Options& options, double dt) {
  FluidParameters f;
  f.repulsion = 25;
  f.friction = 4.5;
  f.isothermal = true;
  const Fluid fluid(f);
  const std::size_t particles = 192;
  const Noise noise(11, 0);
  const Box box = make_box(fluid, Layout::fluid, particles, 3, 0);
  State state = place(box, Layout::fluid, Placement::lattice, particles, 0, noise);
  draw_canonical(fluid, Layout::fluid, 1, noise, state);
  System system(fluid, box, std::move(state), noise);
  const auto integrator = find_method(name)->make(options);
  constexpr std::uint64_t settling = 400, looks = 2000, steps_between = 2;
  run(*integrator, system, dt, 1, settling + 1);
  Eigen::MatrixXd samples(looks, 1);
  for (std::uint64_t look = 0; look < looks; ++look) {
    const std::uint64_t step = settling + 1 + look * steps_between;
    run(*integrator, system, dt, step, step + steps_between);
    samples(static_cast<Eigen::Index>(look), 0) =
        2 * system.kinetic_energy() / (3 * (particles - 1));
  }
  return estimate({samples}, [](const Eigen::VectorXd& m) { return m[0]; });
}

/// The heating for which Groot and Warren (1997) brought lambda in: at the step 0.04 and lambda =
/// 1/2 it is 2.5(3) % in runs thirty times as long. The explicit Euler move is far off. Seven
/// errors, as these are estimated themselves.
TEST(IsothermalSoftFluid, IsSlightlyTooHotWithGrootAndWarrensScheme) {
  const auto found = kinetic_temperature("groot-warren", {{"lambda", 0.5}}, 0.04);
  EXPECT_LT(found.error, 0.008);
  EXPECT_NEAR(found.mean, 1.025, 7 * found.error);
  const auto euler = kinetic_temperature("averaged-drift", {}, 0.04);
  EXPECT_GT(euler.mean, 1.5);
}

}  // namespace
}  // namespace driftless::testing
