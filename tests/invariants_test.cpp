#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/judge/short_paths.hpp"
#include "tests/method_names.hpp"
#include "tests/small_system.hpp"

// What every method of the registry conserves and which symmetries it has: as it claims, and where
// it claims not to, visibly so. What is asked and measured is the bench's; a new method needs no
// line here.
namespace driftless::testing {
namespace {

using judge::boost_check;
using judge::rounding;
using judge::short_check;
using judge::short_step;
using judge::short_steps;
using judge::ShortCheck;
using judge::Verdict;
using judge::visible;

constexpr double boltzmann = 0.5;  // phi/k = 24

std::string against_claim(bool claimed, double difference) {
  if (claimed ? difference < rounding : difference > visible) return {};
  return "claimed " + std::string(claimed ? "yes" : "no") + ", the difference is " +
         std::to_string(difference * 1e9) + "e-9";
}

/// Nothing if a claim is true, with any terms, and what is not claimed is wrong with all of them.
std::string complaint(const Method& method, const ShortCheck& check, const Options& options = {}) {
  const auto record = short_record(check, {method, options});
  if (!record.empty() && !record.contains("largest")) return record.dump();
  const auto finding = short_finding(check, method, record);
  if (finding.verdict == Verdict::not_applicable) return {};
  if (check.claimed(method)) return finding.verdict == Verdict::holds ? "" : finding.sentence;
  const auto& least = record["smallest"];
  return least["difference"] > visible ? "" : "not claimed, but seen with " + least.dump();
}

std::vector<ShortCheck> all_checks() {
  auto all = judge::short_checks();
  for (const double speed : {1, 5, 10}) all.push_back(boost_check(speed));
  return all;
}

class Invariants : public ::testing::TestWithParam<const Method*> {};

TEST_P(Invariants, AreAsClaimed) {
  for (const auto& check : all_checks()) EXPECT_EQ(complaint(*GetParam(), check), "") << check.name;
}

TEST_P(Invariants, OfFrozenParticlesArePlacesAndClaimedEnergy) {
  const Method& method = *GetParam();
  for (const auto closure : method.closures) {
    const auto f = small_fluid({closure, HeatForm::temperature}, boltzmann);
    const State start = small_state(f);
    System system(Fluid(f), small_box(), start, Noise(7, 0), true);
    const double energy = system.total_energy();
    const auto integrator = method.make({});
    run(*integrator, system, short_step, 1, 10 * short_steps + 1);
    EXPECT_EQ(system.state().position, start.position);
    EXPECT_GT(distance(small_box(), system.state(), start).velocity, 0.1);
    const double change = std::abs(system.total_energy() / energy - 1);
    EXPECT_EQ(against_claim(method.energy_ideal == EnergyClaim::exact, change), "");
  }
}

TEST_P(Invariants, RefusalsNameTheClosuresThatAreClaimed) {
  const Method& method = *GetParam();
  ASSERT_FALSE(method.closures.empty());
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    const bool claimed =
        std::find(method.closures.begin(), method.closures.end(), closure) != method.closures.end();
    auto f = small_fluid({closure}, boltzmann);
    const auto reason = refusal(method, Fluid(f));
    EXPECT_EQ(reason.has_value(), !claimed);
    if (reason) {
      EXPECT_NE(reason->find(method.name), std::string::npos);
      EXPECT_NE(reason->find(to_string(closure)), std::string::npos);
    }
    f.friction = 0;  // no friction, no closure
    EXPECT_FALSE(refusal(method, Fluid(f)).has_value());
  }
}

TEST_P(Invariants, OfTheRegistryAreNamesPapersAndOptions) {
  const Method& method = *GetParam();
  EXPECT_EQ(find_method(method.name), &method);
  EXPECT_FALSE(method.title.empty());
  EXPECT_FALSE(method.reference.empty());
  EXPECT_FALSE(method.conserves.empty());
  Options defaults;
  for (const auto& option : method.options) {
    EXPECT_FALSE(option.meaning.empty());
    defaults[std::string(option.name)] = option.fallback;
  }
  EXPECT_NE(method.make(defaults), nullptr);
}

/// Options of one's own choice change nothing of what is claimed, but for the noise-induced drift,
/// and each one has an effect, if only where there is a potential.
TEST_P(Invariants, HoldWithEveryFlagSet) {
  const Method& method = *GetParam();
  for (const auto& option : method.options) {
    if (!std::holds_alternative<bool>(option.fallback)) continue;
    const Options set = {{std::string(option.name), !std::get<bool>(option.fallback)}};
    EXPECT_EQ(complaint(method, short_check("momentum"), set), "");
    EXPECT_EQ(complaint(method, short_check("total energy without a potential"), set), "");
    double effect = 0;
    for (const bool potential : {false, true}) {
      const auto f =
          small_fluid({method.closures.back(), HeatForm::temperature, potential}, boltzmann);
      const State usual = run(method, f, small_state(f), short_step, short_steps);
      const State other = run(method, f, small_state(f), short_step, short_steps, 7, set);
      effect = std::max(effect, distance(small_box(), other, usual).largest());
    }
    EXPECT_GT(effect, visible) << option.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Invariants, ::testing::ValuesIn(methods()), test_name);

TEST(Registry, RefusesANameTwiceAndTakesMethodsFromOutside) {
  Method method = *methods().front();
  EXPECT_THROW(register_method(method), std::invalid_argument);
  const auto before = methods().size();
  method.name = "from-outside";
  register_method(method);
  EXPECT_EQ(methods().size(), before + 1);
  ASSERT_NE(find_method("from-outside"), nullptr);
  EXPECT_EQ(find_method("from-outside")->title, method.title);
  EXPECT_THROW(register_method(method), std::invalid_argument);
  EXPECT_EQ(find_method("no-such-method"), nullptr);
}

// ---- Claims and methods that are wrong must be seen. -------------------------------------------

bool seen(const Method& method, const ShortCheck& check) {
  return !complaint(method, check).empty();
}

bool seen(const Method& method, std::string_view check) { return seen(method, short_check(check)); }

TEST(InvariantFaults, FalseClaimsAreSeen) {
  for (const Method* method : methods()) {
    SCOPED_TRACE(std::string(method->name));
    Method liar = *method;
    liar.galilean = !method->galilean;
    EXPECT_TRUE(seen(liar, boost_check(5)));
    liar = *method;
    liar.order_independent = !method->order_independent;
    EXPECT_TRUE(seen(liar, "order of pairs"));
    const auto other = [](EnergyClaim claim) {
      return claim == EnergyClaim::exact ? EnergyClaim::drifts : EnergyClaim::exact;
    };
    liar = *method;
    liar.energy_ideal = other(method->energy_ideal);
    EXPECT_TRUE(seen(liar, "total energy without a potential"));
    liar = *method;
    liar.energy_with_potential = other(method->energy_with_potential);
    EXPECT_TRUE(seen(liar, "total energy with a potential"));
  }
}

/// shardlow-s1 with something wrong in or after each step.
template <class Fault>
class Faulty : public Integrator {
 public:
  void step(System& system, double dt) override {
    fault_(system, dt, *sound_);
    ++count_;
  }

 private:
  std::unique_ptr<Integrator> sound_ = find_method("shardlow-s1")->make({});
  Fault fault_{};
  int count_ = 0;
};

template <class Fault>
Method faulty() {
  Method method = *find_method("shardlow-s1");
  method.make = [](const Options&) -> std::unique_ptr<Integrator> {
    return std::make_unique<Faulty<Fault>>();
  };
  return method;
}

/// Changes one velocity after the step by a rule of its own.
struct PushesOneParticle {
  void operator()(System& system, double dt, Integrator& sound) {
    sound.step(system, dt);
    system.update([](std::size_t place, Vector& v, double&) { v[0] += place == 0 ? 1e-6 : 0; });
  }
};
struct FavoursAnAxis {
  void operator()(System& system, double dt, Integrator& sound) {
    sound.step(system, dt);
    system.update([&](std::size_t, Vector& v, double&) { v[2] *= 1 - 1e-5 * dt; });
  }
};
struct FavoursAPlace {
  void operator()(System& system, double dt, Integrator& sound) {
    sound.step(system, dt);
    const auto& r = system.state().position;
    system.update([&](std::size_t i, Vector& v, double&) { v[0] += 1e-3 * dt * r[i][1]; });
  }
};
struct FavoursTheFirstInStorage {
  void operator()(System& system, double dt, Integrator& sound) {
    sound.step(system, dt);
    system.update(
        [&](std::size_t place, Vector&, double& u) { u *= 1 + (place == 0 ? 1e-3 * dt : 0); });
  }
};
struct DependsOnTheCallsBefore {
  int calls = 0;
  void operator()(System& system, double dt, Integrator& sound) {
    sound.step(system, dt);
    ++calls;
    system.update([&](std::size_t, Vector&, double& u) { u *= 1 + 1e-9 * dt * calls; });
  }
};
struct DependsOnTheRunsBefore {
  void operator()(System& system, double dt, Integrator& sound) {
    static int runs = 0;
    sound.step(system, dt);
    ++runs;
    system.update([&](std::size_t, Vector&, double& u) { u *= 1 + 1e-9 * dt * runs; });
  }
};
struct NeverStandsStill {
  void operator()(System& system, double dt, Integrator& sound) {
    sound.step(system, dt);
    system.update([](std::size_t, Vector&, double& u) { u *= 1 + 1e-15; });
  }
};
struct ForgetsTheNoise {
  void operator()(System& system, double dt, Integrator& sound) {
    system.set_step(0);
    Exchange nothing;
    nothing.reset(system.size());
    static_cast<void>(sound);
    system.apply(nothing);
    system.move(dt);
  }
};

TEST(InvariantFaults, OfMethodsAreSeen) {
  EXPECT_TRUE(seen(faulty<PushesOneParticle>(), "momentum"));
  EXPECT_TRUE(seen(faulty<FavoursAnAxis>(), "momentum"));
  EXPECT_TRUE(seen(faulty<FavoursAPlace>(), "quarter turn"));
  EXPECT_TRUE(seen(faulty<FavoursAPlace>(), "exchanged axes"));
  EXPECT_TRUE(seen(faulty<FavoursAPlace>(), "translation"));
  EXPECT_TRUE(seen(faulty<FavoursTheFirstInStorage>(), "order of storage"));
  EXPECT_TRUE(seen(faulty<FavoursTheFirstInStorage>(), "total energy without a potential"));
  EXPECT_TRUE(seen(faulty<FavoursTheFirstInStorage>(), "one particle"));
  EXPECT_TRUE(seen(faulty<DependsOnTheCallsBefore>(), "restart"));
  EXPECT_TRUE(seen(faulty<DependsOnTheCallsBefore>(), "restart on other threads"));
  EXPECT_TRUE(seen(faulty<DependsOnTheRunsBefore>(), "threads"));
  EXPECT_TRUE(seen(faulty<FavoursTheFirstInStorage>(), "order of storage in tiles"));
  EXPECT_TRUE(seen(faulty<DependsOnTheRunsBefore>(), "repetition"));
  EXPECT_TRUE(seen(faulty<NeverStandsStill>(), "step of 0"));
  EXPECT_TRUE(seen(faulty<ForgetsTheNoise>(), "another seed"));
  EXPECT_TRUE(seen(faulty<ForgetsTheNoise>(), "two particles"));
}

}  // namespace
}  // namespace driftless::testing
