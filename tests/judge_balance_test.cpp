#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "experiments/judge/balance.hpp"
#include "experiments/judge/balance_runs.hpp"
#include "experiments/judge/examinations.hpp"
#include "experiments/judge/relative_entropy.hpp"
#include "experiments/judge/reversal.hpp"
#include "experiments/judge/two_body/bins.hpp"
#include "experiments/judge/two_body/ensemble.hpp"
#include "integrators/flows.hpp"

namespace driftless::judge {
namespace {

/// A normal variate leaves +- 6.1 standard errors in 1 of 10^9 cases.
constexpr double z_bound = 6.1;

std::vector<double> counted(const std::vector<double>& law, int draws, std::mt19937_64& random) {
  std::discrete_distribution<int> bins(law.begin(), law.end());
  std::vector<double> counts(law.size(), 0.0);
  for (int n = 0; n < draws; ++n) ++counts[static_cast<std::size_t>(bins(random))];
  return counts;
}

TEST(RelativeEntropy, HasNoBiasWhereBinsHoldFewDraws) {
  constexpr int bins = 500, draws = 1500, repeats = 400;
  const std::vector<double> law(bins, 1.0 / bins), log_mass(bins, -std::log(bins));
  std::mt19937_64 random(1);
  double sum = 0, plain = 0;
  for (int n = 0; n < repeats; ++n) {
    const auto counts = counted(law, draws, random);
    sum += relative_entropy(counts, log_mass);
    for (const double count : counts) {
      if (count > 0) plain += count / draws * std::log(count / draws * bins);
    }
  }
  // of one estimate: chi^2 with bins - 1 degrees of freedom over 2 draws, and a little more
  const double error = 1.5 * std::sqrt(bins / 2.0) / draws / std::sqrt(repeats);
  EXPECT_NEAR(sum / repeats, 0, z_bound * error);
  EXPECT_GT(plain / repeats, 20 * z_bound * error) << "the bias would not be seen";
}

TEST(RelativeEntropy, IsThatOfTheLaw) {
  const std::vector<double> law = {0.5, 0.3, 0.15, 0.05};
  const std::vector<double> mass = {0.1, 0.2, 0.3, 0.4};
  double exact = 0, square = 0;
  std::vector<double> log_mass;
  for (std::size_t b = 0; b < law.size(); ++b) {
    const double ratio = std::log(law[b] / mass[b]);
    exact += law[b] * ratio;
    square += law[b] * ratio * ratio;
    log_mass.push_back(std::log(mass[b]));
  }
  constexpr int draws = 100000;
  std::mt19937_64 random(2);
  const double error = std::sqrt((square - exact * exact) / draws);
  EXPECT_NEAR(relative_entropy(counted(law, draws, random), log_mass), exact, z_bound * error);
}

/// Copies of a chain on a ring of bins that starts on one of them: with `chance` a copy goes on to
/// the next bin; at the times from `return_at` on the copies of the upper half of the ring go to
/// bin 0, which no chain that keeps the uniform law does.
BinnedCopies ring(int bins, int times, int return_at) {
  constexpr int copies = 20000;
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> step(-1, 1);
  std::vector<int> place(copies, 0);
  BinnedCopies all;
  for (int t = 0; t < times; ++t) {
    all.times.push_back(t);
    all.bins.emplace_back(place.begin(), place.end());
    for (int& at : place) {
      at = (at + step(random) + bins) % bins;
      if (t >= return_at && at >= bins / 2) at = 0;
    }
  }
  return all;
}

TEST(EntropyCourse, RisesForAChainThatKeepsTheLaw) {
  const std::vector<double> log_mass(8, -std::log(8));
  const auto course = entropy_course(ring(8, 40, 100), log_mass);
  EXPECT_NEAR(course.relative.front(), std::log(8), 1e-3);
  EXPECT_LT(std::abs(course.relative.back()), z_bound * course.error.back());
  EXPECT_LT(course.fall.depth, z_bound * course.fall.error);
  EXPECT_LT(course.error.back(), 2 * std::sqrt(8.0) / 20000);
}

TEST(EntropyCourse, FindsWhenTheEntropyFalls) {
  const std::vector<double> log_mass(8, -std::log(8));
  const auto course = entropy_course(ring(8, 40, 30), log_mass);
  EXPECT_GT(course.fall.depth, 100 * course.fall.error);
  EXPECT_LE(course.fall.from, 30U);
  EXPECT_GT(course.fall.to, 30U);
}

enum class Kind { with_internal_energies, isothermal, two_species };

class PairBins : public testing::TestWithParam<Kind> {
 protected:
  static two_body::Bench bench() {
    if (GetParam() == Kind::isothermal) return two_body::make_isothermal_bench();
    if (GetParam() == Kind::two_species) return two_body::make_isothermal_bench(4);
    return two_body::make_bench(10, FrictionClosure::noise, HeatForm::inverse_temperature);
  }
};

TEST_P(PairBins, HaveTheMassesOfTheExactLaw) {
  const two_body::PairBins bins(bench());
  double total = 0;
  for (const double mass : bins.log_mass()) total += std::exp(mass);
  EXPECT_NEAR(total, 1, 1e-12);
  two_body::Pairs pairs;
  pairs.count = 50000;
  const two_body::Ensemble exact(bench(), pairs);
  std::vector<double> counts(bins.size(), 0.0);
  for (std::size_t n = 0; n < exact.size(); ++n) ++counts[bins.bin(exact.view(n))];
  const double occupied =
      std::count_if(counts.begin(), counts.end(), [](double n) { return n > 0; });
  const double error = 1.5 * std::sqrt(occupied / 2) / 50000;
  EXPECT_NEAR(relative_entropy(counts, bins.log_mass()), 0, z_bound * error);
}

std::string kind_name(const testing::TestParamInfo<Kind>& tested) {
  if (tested.param == Kind::isothermal) return "isothermal";
  return tested.param == Kind::two_species ? "two_species" : "with_internal_energies";
}

INSTANTIATE_TEST_SUITE_P(Pairs, PairBins,
                         testing::Values(Kind::with_internal_energies, Kind::isothermal,
                                         Kind::two_species),
                         kind_name);

/// Copies of a walk on three states that goes round with `clockwise`, else the other way round; as
/// a series of the indicators of the first two states and as transitions.
struct Walk {
  Scatter scatter;
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(3, 3);

  explicit Walk(double clockwise) {
    std::mt19937_64 random(4);
    std::bernoulli_distribution forwards(clockwise);
    for (int copy = 0; copy < 2000; ++copy) {
      Eigen::MatrixXd series = Eigen::MatrixXd::Zero(50, 2);
      int state = copy % 3;
      for (int t = 0; t < series.rows(); ++t) {
        if (state < 2) series(t, state) = 1;
        const int next = (state + (forwards(random) ? 1 : 2)) % 3;
        ++counts(state, next);
        state = next;
      }
      // the second pair is the first one with a minus: a direction in which nothing scatters
      scatter.add(reversal_differences(series, {{"a, b", 0, 1}, {"b, a", 1, 0}}, {1}));
    }
  }
  MeasuredVector vector() const { return measured_vector(scatter.record()); }
};

TEST(Reversal, AWalkThatLooksAlikeBothWaysPasses) {
  const Walk walk(0.5);
  EXPECT_FALSE(hotelling(walk.vector()).certainly_not_chance());
  EXPECT_EQ(hotelling(walk.vector()).freedom, 1);
  EXPECT_FALSE(two_way_test(walk.counts).certainly_not_chance());
}

TEST(Reversal, AWalkThatGoesRoundIsSeen) {
  const Walk walk(0.55);
  const auto vector = walk.vector();
  // <a(t) b(t + 1)> = 0.55/3, <b(t) a(t + 1)> = 0.45/3
  EXPECT_NEAR(vector.mean[0], 0.1 / 3, z_bound * vector.error(0));
  EXPECT_TRUE(hotelling(vector).certainly_not_chance());
  EXPECT_EQ(two_way_test(walk.counts).freedom, 3);
  EXPECT_TRUE(two_way_test(walk.counts).certainly_not_chance());
}

/// One step of all pairs by an exchange that is explicit.
template <class Kernel>
class Explicit : public Integrator {
 public:
  void step(System& system, double dt) override {
    const Fluid& fluid = system.fluid();
    system.accumulate([&](const Pair<double>& pair) { return Kernel::exchange(fluid, pair, dt); },
                      exchange_);
    system.apply(exchange_);
  }

 private:
  Exchange exchange_;
};

/// The energy of a transfer of momentum is taken from both particles alike.
Transfer<double> with_its_work(const Fluid& fluid, const Pair<double>& pair, double momentum) {
  const double after = pair.v + momentum / fluid.reduced_mass();
  const double gain = 0.5 * fluid.reduced_mass() * (after * after - pair.v * pair.v);
  return {momentum, -0.5 * gain, -0.5 * gain};
}

struct WithoutNoise {
  static Transfer<double> exchange(const Fluid& fluid, const Pair<double>& pair, double dt) {
    auto total = with_its_work(fluid, pair, -fluid.friction(pair).friction * pair.v * dt);
    const double heat = fluid.conduction(pair).rate * dt;
    total.energy_i += heat;
    total.energy_j -= heat;
    return total;
  }
};

/// Energy goes round: kinetic energy is taken where the internal energies are far apart, and they
/// are driven apart where it is large.
struct GoesRound {
  static Transfer<double> exchange(const Fluid& fluid, const Pair<double>& pair, double dt) {
    const double apart = (pair.u_i - pair.u_j) / (pair.u_i + pair.u_j);
    const double kinetic = 0.5 * fluid.reduced_mass() * pair.v * pair.v;
    auto total = euler_exchange(fluid, pair, dt);
    total += with_its_work(fluid, pair, -6 * apart * apart * fluid.reduced_mass() * pair.v * dt);
    const double heat = apart * kinetic * dt;
    total.energy_i += heat;
    total.energy_j -= heat;
    return total;
  }
};

template <class Kernel>
Candidate planted(std::string_view name) {
  if (find_method(name) == nullptr) {
    Method method;
    method.name = name;
    method.title = "planted";
    method.closures = {FrictionClosure::noise};
    method.isothermal = true;
    method.make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<Explicit<Kernel>>();
    };
    register_method(method);
  }
  return {{std::string(name), {}}};
}

/// Consistent and exact for isolated pairs at any step.
Candidate sound() {
  for (const Method* method : methods()) {
    if (method->pair_law_exact && method->consistent) return {{std::string(method->name), {}}};
  }
  throw std::logic_error("no method claims the exact law of isolated pairs");
}

/// The conclusion from the parts that one of the texts names.
Conclusion conclusion_of(const Candidate& candidate, const std::vector<std::string>& wanted) {
  const Conditions conditions;
  Records records;
  for (const auto& part : balance.parts(candidate, conditions)) {
    const bool asked = std::any_of(wanted.begin(), wanted.end(), [&](const std::string& text) {
      return part.name.find(text) != std::string::npos;
    });
    if (asked) records[part.name] = part.run();
  }
  return balance.conclude(candidate, conditions, records);
}

const Finding& finding_of(const Conclusion& conclusion, const std::string& subject) {
  for (const auto& finding : conclusion.findings) {
    if (finding.subject == subject) return finding;
  }
  throw std::logic_error("no finding of " + subject);
}

const std::string pairs_of_noise = "pairs with friction and conduction, closure noise";

TEST(Balance, EntropyOfAMethodThatIsExactForPairsOnlyRises) {
  const auto conclusion = conclusion_of(sound(), {"entropy of " + pairs_of_noise + ", step 0.8"});
  const auto& finding = finding_of(conclusion, "entropy of " + pairs_of_noise + ", step 0.8");
  EXPECT_EQ(finding.verdict, Verdict::holds) << finding.sentence;
  EXPECT_TRUE(finding.claimed.value_or(false));
}

TEST(Balance, EntropyFallsWithoutNoise) {
  const auto conclusion = conclusion_of(planted<WithoutNoise>("planted-without-noise"),
                                        {"entropy of " + pairs_of_noise + ", step 0.4"});
  const auto& finding = finding_of(conclusion, "entropy of " + pairs_of_noise + ", step 0.4");
  EXPECT_EQ(finding.verdict, Verdict::fails) << finding.sentence;
}

/// Runs isothermal pairs with a free energy that is claimed to fall at any step.
Candidate sound_isothermal() {
  for (const Method* method : methods()) {
    if (method->isothermal_pair_law_exact) return {{std::string(method->name), {}}};
  }
  throw std::logic_error("no method claims Maxwell's law of isolated pairs");
}

TEST(Balance, FreeEnergyOfAMethodThatIsExactForIsothermalPairsOnlyFalls) {
  const std::string part = "free energy of isothermal pairs, step 0.8";
  const auto conclusion = conclusion_of(sound_isothermal(), {part});
  const auto& finding = finding_of(conclusion, part);
  EXPECT_EQ(finding.verdict, Verdict::holds) << finding.sentence;
  EXPECT_TRUE(finding.claimed.value_or(false));
  EXPECT_EQ(finding.unit, "k T");
}

TEST(Balance, FreeEnergyRisesWithoutNoise) {
  const std::string part = "free energy of isothermal pairs, step 0.4";
  const auto conclusion = conclusion_of(planted<WithoutNoise>("planted-without-noise"), {part});
  const auto& finding = finding_of(conclusion, part);
  EXPECT_EQ(finding.verdict, Verdict::fails) << finding.sentence;
}

/// The exact half-implicit update of a pair of equal masses, whatever the masses are.
template <std::size_t Heaviest>
struct ReducedMassOfEqual {
  static Transfer<double> exchange(const Fluid& fluid, const Pair<double>& pair, double dt) {
    const double mu = fluid.mass(std::min(Heaviest, fluid.species() - 1)) / 2;
    const auto law = fluid.friction(pair);
    const double x = law.friction * dt / (2 * mu);
    const double kick = std::sqrt(law.noise_squared * dt) * pair.noise / mu;
    return {mu * (kick - 2 * x * pair.v) / (1 + x), 0, 0};
  }
};

const std::string two_species_part = "free energy of isothermal pairs of two species, step 0.8";

nlohmann::json two_species_record(const Candidate& candidate) {
  for (const auto& part : balance.parts(candidate, Conditions{})) {
    if (part.name == two_species_part) return part.run();
  }
  throw std::logic_error("no part " + two_species_part);
}

TEST(Balance, FreeEnergyOfTwoSpeciesFallsToMaxwellsLaw) {
  const auto candidate = sound_isothermal();
  const auto record = two_species_record(candidate);
  const auto conclusion = balance.conclude(candidate, {}, {{two_species_part, record}});
  const auto& finding = finding_of(conclusion, two_species_part);
  EXPECT_EQ(finding.verdict, Verdict::holds) << finding.sentence;
  EXPECT_TRUE(finding.claimed.value_or(false));
  const double end = record["relative"].back(), error = record["error"].back();
  EXPECT_LT(std::abs(end), z_bound * error);
}

/// Where pairs end whose velocities change c times as much as they should, at the step x: with
///   v' = (1 - c + c a) v + c (1 - a^2)^{1/2} (kT/mu_wrong)^{1/2} W,  a = (1 - y/2)/(1 + y/2),
/// c = mu_wrong/mu and y = x/c the variance of v is s kT/mu, and F[P] (s - 1 - ln s)/2 too high.
double end_with_wrong_mass(double c, double x) {
  const double a = (1 - 0.5 * x / c) / (1 + 0.5 * x / c), keeps = 1 - c + c * a;
  const double s = c * (1 - a * a) / (1 - keeps * keeps);
  return 0.5 * (s - 1 - std::log(s));
}

// The reduced mass is 4/5 of the first particle's mass; the bins hide some per cent of the excess.
TEST(Balance, FreeEnergyOfTwoSpeciesShowsTheReducedMassOfOne) {
  const auto ends_at = [](const Candidate& candidate, double c) {
    const auto record = two_species_record(candidate);
    const double end = record["relative"].back(), error = record["error"].back();
    const double expected = end_with_wrong_mass(c, 0.8);
    EXPECT_GT(end, 10 * error);
    EXPECT_NEAR(end, expected, 0.1 * expected + z_bound * error);
  };
  ends_at(planted<ReducedMassOfEqual<0>>("planted-first-mass"), 0.5 / 0.8);
  ends_at(planted<ReducedMassOfEqual<1>>("planted-second-mass"), 2 / 0.8);
}

TEST(Balance, FrictionAloneOfAMethodThatIsExactForPairsLooksAlikeBothWays) {
  const std::string pairs = "pairs with friction alone, closure noise";
  const auto conclusion = conclusion_of(sound(), {"reversal of " + pairs});
  for (const char* step : {", step 0.4", " at vanishing steps"}) {
    const auto& finding = finding_of(conclusion, "detailed balance of " + pairs + step);
    EXPECT_EQ(finding.verdict, Verdict::holds) << finding.sentence;
  }
}

TEST(Balance, EnergyThatGoesRoundIsSeenAtAnyStep) {
  const auto conclusion =
      conclusion_of(planted<GoesRound>("planted-goes-round"), {"reversal of " + pairs_of_noise});
  const auto& finding =
      finding_of(conclusion, "detailed balance of " + pairs_of_noise + " at vanishing steps");
  EXPECT_EQ(finding.verdict, Verdict::fails) << finding.sentence;
  EXPECT_TRUE(finding.contradicts_claim());
}

/// What is found at vanishing steps of the fluid if its first moment differs by so much at the
/// three steps and the others by nothing, all known to 0.0001.
Finding finding_from(const std::array<double, 3>& differences) {
  const auto fluid = fluid_cases(sound()).front().name;
  std::vector<double> mean(fluid_reversal_columns().size(), 0.0);
  std::vector<std::vector<double>> covariance;
  for (std::size_t n = 0; n < mean.size(); ++n) {
    covariance.emplace_back(n + 1, 0.0).back() = 1e-8;
  }
  Records records;
  for (std::size_t n = 0; n < differences.size(); ++n) {
    mean[0] = differences[n];
    records[reversal_part(fluid, fluid_steps()[n])] = {
        {"failed", 0.0},
        {"reversal", {{"rows", 100000}, {"mean", mean}, {"covariance", covariance}}}};
  }
  return finding_of(balance.conclude(sound(), {}, records),
                    "detailed balance of " + fluid + " at vanishing steps");
}

// The first as averaged-drift had it, whose parabola ends at 0.0057.
TEST(Balance, AParabolaThatTurnsRoundIsNoProof) {
  EXPECT_EQ(finding_from({-0.0313, -0.0226, -0.0109}).verdict, Verdict::holds);
  EXPECT_EQ(finding_from({-0.028, -0.018, -0.013}).verdict, Verdict::fails);
}

TEST(Balance, AMethodWithoutClosuresIsAskedNothing) {
  Method method;
  method.name = "planted-no-closure";
  method.make = [](const Options&) -> std::unique_ptr<Integrator> { return nullptr; };
  register_method(method);
  const Candidate candidate{{"planted-no-closure", {}}};
  EXPECT_TRUE(balance.parts(candidate, {}).empty());
  const auto conclusion = balance.conclude(candidate, {}, {});
  ASSERT_EQ(conclusion.findings.size(), 1U);
  EXPECT_EQ(conclusion.findings[0].verdict, Verdict::not_applicable);
}

}  // namespace
}  // namespace driftless::judge
