#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/method_names.hpp"
#include "tests/small_system.hpp"

// What every method of the registry conserves and which symmetries it has: as it claims, and where
// it claims not to, visibly so. A new method needs no line here.
namespace driftless::testing {
namespace {

constexpr double boltzmann = 0.5;  // phi/k = 24
constexpr double time_step = 0.01;
constexpr std::uint64_t steps = 20;

/// Differences of at most this are rounding after 20 steps; what is broken is broken by a thousand
/// times more.
constexpr double rounding = 1e-11;
constexpr double visible = 1e-8;

/// The state after the usual number of steps.
State path(const Method& method, const FluidParameters& fluid, const State& start) {
  return run(method, fluid, start, time_step, steps);
}

/// One check of a method with some terms: a complaint, empty if there is none.
using Check = std::string (*)(const Method&, const Terms&);

/// The first complaint over all closures that a method claims, heat forms, and potentials.
std::string first_complaint(const Method& method, Check check) {
  for (const auto closure : method.closures) {
    for (const auto heat : all_heat_forms()) {
      for (const bool potential : {false, true}) {
        const Terms terms{closure, heat, potential};
        const auto complaint = check(method, terms);
        if (!complaint.empty()) return terms.name() + ": " + complaint;
      }
    }
  }
  return {};
}

/// A claim holds if the difference is rounding; if it is not made, the difference must be visible.
std::string against_claim(bool claimed, double difference) {
  if (claimed ? difference < rounding : difference > visible) return {};
  return "claimed " + std::string(claimed ? "yes" : "no") + ", the difference is " +
         std::to_string(difference * 1e9) + "e-9";
}

// ---- Conservation. -----------------------------------------------------------------------------

std::string check_momentum(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  State start = small_state(f);
  for (auto& velocity : start.velocity) velocity += Vector(0.3, -0.2, 0.5);
  const State end = path(method, f, start);
  Vector change = Vector::Zero();
  for (std::size_t i = 0; i < start.size(); ++i) {
    change += f.mass * (end.velocity[i] - start.velocity[i]);
  }
  return against_claim(true, change.norm());
}

std::string check_energy(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  System system(Fluid(f), small_box(), small_state(f), Noise(7, 0));
  const double before = system.total_energy();
  const auto integrator = method.make({});
  run(*integrator, system, time_step, 1, steps + 1);
  const auto claim = terms.potential ? method.energy_with_potential : method.energy_ideal;
  return against_claim(claim == EnergyClaim::exact, std::abs(system.total_energy() / before - 1));
}

// ---- Repetition. -------------------------------------------------------------------------------

std::string check_repetition(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  const State start = small_state(f);
  const State end = path(method, f, start);
  if (!same_bits(end, path(method, f, start))) return "a second run differs";
  const State other = run(method, f, start, time_step, steps, 8);
  if (distance(small_box(), end, other).velocity < 1e-3) return "another seed changes nothing";
  return {};
}

std::string check_restart(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  System first(Fluid(f), small_box(), small_state(f), Noise(7, 0));
  const auto before = method.make({});
  run(*before, first, time_step, 1, steps / 2 + 1);
  System second(Fluid(f), small_box(), first.state(), Noise(7, 0));
  const auto after = method.make({});
  after->load(before->save());
  run(*after, second, time_step, steps / 2 + 1, steps + 1);
  if (!same_bits(second.state(), path(method, f, small_state(f)))) return "a restart differs";
  if (after->save() != [&] {
        run(*before, first, time_step, steps / 2 + 1, steps + 1);
        return before->save();
      }()) {
    return "what is saved after a restart differs";
  }
  return {};
}

/// A method that keeps something between steps and starts without it takes another path.
std::string check_that_saved_state_matters(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  System first(Fluid(f), small_box(), small_state(f), Noise(7, 0));
  const auto before = method.make({});
  run(*before, first, time_step, 1, steps / 2 + 1);
  if (before->save().empty()) return {};
  System second(Fluid(f), small_box(), first.state(), Noise(7, 0));
  const auto forgetful = method.make({});
  run(*forgetful, second, time_step, steps / 2 + 1, steps + 1);
  return same_bits(second.state(), path(method, f, small_state(f))) ? "what is saved has no effect"
                                                                    : "";
}

// ---- Symmetries. -------------------------------------------------------------------------------

double boost_difference(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  const Vector boost(1.7, -0.9, 2.3);
  State moving = small_state(f);
  for (auto& velocity : moving.velocity) velocity += boost;
  State end = path(method, f, moving);
  for (std::size_t i = 0; i < end.size(); ++i) {
    end.velocity[i] -= boost;
    end.position[i] -= boost * (time_step * static_cast<double>(steps));
  }
  return distance(small_box(), end, path(method, f, small_state(f))).largest();
}

std::string check_boost(const Method& method, const Terms& terms) {
  return against_claim(method.galilean, boost_difference(method, terms));
}

State in_order(const State& state, const std::vector<std::size_t>& order) {
  State permuted;
  for (const std::size_t place : order) {
    permuted.position.push_back(state.position[place]);
    permuted.velocity.push_back(state.velocity[place]);
    permuted.internal_energy.push_back(state.internal_energy[place]);
    permuted.id.push_back(state.id[place]);
  }
  return permuted;
}

std::vector<std::size_t> some_order(std::size_t size) {
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), std::size_t{0});
  Uniform uniform(3);
  std::shuffle(order.begin(), order.end(), uniform.engine());
  return order;
}

std::string check_storage(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  const auto order = some_order(small_state(f).size());
  const State stored_otherwise = path(method, f, in_order(small_state(f), order));
  const State expected = in_order(path(method, f, small_state(f)), order);
  if (stored_otherwise.id != expected.id) return "ids have changed places";
  return against_claim(true, distance(small_box(), stored_otherwise, expected).largest());
}

/// Other ids are another order of pairs. Without fluctuations, where ids name no noise, that is all
/// they are.
std::string check_order(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, 0);
  State renamed = small_state(f);
  const auto order = some_order(renamed.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    renamed.id[i] = static_cast<std::uint32_t>(order[i]);
  }
  const State end = path(method, f, renamed), expected = path(method, f, small_state(f));
  return against_claim(method.order_independent, distance(small_box(), end, expected).largest());
}

Vector quarter_turn(const Vector& r) { return {-r[1], r[0], r[2]}; }

State turned(const Box& box, State state) {
  for (auto& position : state.position) position = box.wrap(quarter_turn(position));
  for (auto& velocity : state.velocity) velocity = quarter_turn(velocity);
  return state;
}

std::string check_rotation(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  const State end = path(method, f, turned(small_box(), small_state(f)));
  const State expected = turned(small_box(), path(method, f, small_state(f)));
  return against_claim(true, distance(small_box(), end, expected).largest());
}

std::string check_translation(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  const Vector shift(0.77, 1.31, -0.4);
  State moved = small_state(f);
  for (auto& position : moved.position) position += shift;
  State end = path(method, f, moved);
  for (auto& position : end.position) position -= shift;
  return against_claim(true, distance(small_box(), end, path(method, f, small_state(f))).largest());
}

// ---- Steps of no length, few particles. --------------------------------------------------------

std::string check_zero_step(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  const State start = small_state(f);
  return same_bits(run(method, f, start, 0, 3), start) ? "" : "a step of 0 changes the state";
}

State first_particles(const State& state, std::size_t count) {
  State few = state;
  few.position.resize(count);
  few.velocity.resize(count);
  few.internal_energy.resize(count);
  few.id.resize(count);
  return few;
}

std::string check_one_particle(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  const State start = first_particles(small_state(f), 1);
  const State end = path(method, f, start);
  State expected = start;
  expected.position[0] += start.velocity[0] * (time_step * static_cast<double>(steps));
  return against_claim(true, distance(small_box(), end, expected).largest());
}

std::string check_two_particles(const Method& method, const Terms& terms) {
  const auto f = small_fluid(terms, boltzmann);
  State start = first_particles(small_state(f), 2);
  start.position = {Vector(1, 1, 1), Vector(1.3, 1.2, 1)};
  for (auto& velocity : start.velocity) velocity *= 0.1;  // they are to meet for long
  System system(Fluid(f), small_box(), start, Noise(7, 0));
  const double energy = system.total_energy();
  const auto integrator = method.make({});
  run(*integrator, system, time_step, 1, 10 * steps + 1);
  const State& end = system.state();
  if (std::abs(system.total_energy() / energy - 1) > 0.02) return "energy is far off";
  const Vector change = end.velocity[0] + end.velocity[1] - start.velocity[0] - start.velocity[1];
  if (change.norm() > rounding) return "momentum changes";
  return distance(small_box(), end, start).velocity > 0.01 ? "" : "the two do not interact";
}

// ---- The suites. -------------------------------------------------------------------------------

struct Suite {
  const char* name;
  Check check;
};

const Suite suites[] = {
    {"momentum", check_momentum},
    {"energy", check_energy},
    {"repetition", check_repetition},
    {"restart", check_restart},
    {"what is saved", check_that_saved_state_matters},
    {"Galilean boost", check_boost},
    {"order of storage", check_storage},
    {"order of pairs", check_order},
    {"quarter turn", check_rotation},
    {"translation", check_translation},
    {"step of 0", check_zero_step},
    {"one particle", check_one_particle},
    {"two particles", check_two_particles},
};

class Invariants : public ::testing::TestWithParam<const Method*> {};

TEST_P(Invariants, AreAsClaimed) {
  for (const auto& suite : suites) {
    EXPECT_EQ(first_complaint(*GetParam(), suite.check), "") << suite.name;
  }
}

TEST_P(Invariants, OfFrozenParticlesArePlacesAndClaimedEnergy) {
  const Method& method = *GetParam();
  for (const auto closure : method.closures) {
    const auto f = small_fluid({closure, HeatForm::temperature}, boltzmann);
    const State start = small_state(f);
    System system(Fluid(f), small_box(), start, Noise(7, 0), true);
    const double energy = system.total_energy();
    const auto integrator = method.make({});
    run(*integrator, system, time_step, 1, 10 * steps + 1);
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
    double effect = 0;
    for (const bool potential : {false, true}) {
      const auto f =
          small_fluid({method.closures.back(), HeatForm::temperature, potential}, boltzmann);
      System system(Fluid(f), small_box(), small_state(f), Noise(7, 0));
      const Vector momentum = system.momentum();
      const double energy = system.total_energy();
      const auto integrator =
          method.make({{std::string(option.name), !std::get<bool>(option.fallback)}});
      run(*integrator, system, time_step, 1, steps + 1);
      EXPECT_LT((system.momentum() - momentum).norm(), rounding);
      const double change = std::abs(system.total_energy() / energy - 1);
      if (!potential) {
        EXPECT_EQ(against_claim(method.energy_ideal == EnergyClaim::exact, change), "");
      }
      const State usual = path(method, f, small_state(f));
      effect = std::max(effect, distance(small_box(), system.state(), usual).largest());
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

bool seen(const Method& method, Check check) { return !first_complaint(method, check).empty(); }

TEST(InvariantFaults, FalseClaimsAreSeen) {
  for (const Method* method : methods()) {
    SCOPED_TRACE(std::string(method->name));
    Method liar = *method;
    liar.galilean = !method->galilean;
    EXPECT_TRUE(seen(liar, check_boost));
    liar = *method;
    liar.order_independent = !method->order_independent;
    EXPECT_TRUE(seen(liar, check_order));
    const auto other = [](EnergyClaim claim) {
      return claim == EnergyClaim::exact ? EnergyClaim::drifts : EnergyClaim::exact;
    };
    liar = *method;
    liar.energy_ideal = other(method->energy_ideal);
    EXPECT_TRUE(seen(liar, check_energy));
    liar = *method;
    liar.energy_with_potential = other(method->energy_with_potential);
    EXPECT_TRUE(seen(liar, check_energy));
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
  EXPECT_TRUE(seen(faulty<PushesOneParticle>(), check_momentum));
  EXPECT_TRUE(seen(faulty<FavoursAnAxis>(), check_momentum));
  EXPECT_TRUE(seen(faulty<FavoursAPlace>(), check_rotation));
  EXPECT_TRUE(seen(faulty<FavoursAPlace>(), check_translation));
  EXPECT_TRUE(seen(faulty<FavoursTheFirstInStorage>(), check_storage));
  EXPECT_TRUE(seen(faulty<FavoursTheFirstInStorage>(), check_energy));
  EXPECT_TRUE(seen(faulty<FavoursTheFirstInStorage>(), check_one_particle));
  EXPECT_TRUE(seen(faulty<DependsOnTheCallsBefore>(), check_restart));
  EXPECT_TRUE(seen(faulty<DependsOnTheRunsBefore>(), check_repetition));
  EXPECT_TRUE(seen(faulty<NeverStandsStill>(), check_zero_step));
  EXPECT_TRUE(seen(faulty<ForgetsTheNoise>(), check_repetition));
  EXPECT_TRUE(seen(faulty<ForgetsTheNoise>(), check_two_particles));
}

}  // namespace
}  // namespace driftless::testing
