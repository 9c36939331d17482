#include "model/system.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/small_system.hpp"

namespace driftless::testing {
namespace {

const Terms all_terms{FrictionClosure::friction, HeatForm::temperature, true};

/// A state whose ids are in no order.
State shuffled_state(const FluidParameters& fluid) {
  State state = small_state(fluid);
  Uniform uniform(2);
  std::shuffle(state.id.begin(), state.id.end(), uniform.engine());
  return state;
}

System small_system(const Terms& terms = all_terms, double boltzmann = 0.5, bool frozen = false) {
  const auto f = small_fluid(terms, boltzmann);
  return System(Fluid(f), small_box(), shuffled_state(f), Noise(4, 2), frozen);
}

/// Places of all pairs within the range of 1, by a double loop in the order of ids.
std::vector<std::pair<std::size_t, std::size_t>> pairs_of(const State& state) {
  std::vector<std::size_t> place(state.size());
  std::iota(place.begin(), place.end(), std::size_t{0});
  std::sort(place.begin(), place.end(), [&](auto a, auto b) { return state.id[a] < state.id[b]; });
  std::vector<std::pair<std::size_t, std::size_t>> all;
  for (std::size_t a = 0; a < place.size(); ++a) {
    for (std::size_t b = a + 1; b < place.size(); ++b) {
      const Vector apart = state.position[place[a]] - state.position[place[b]];
      if (small_box().minimum_image(apart).norm() < 1) all.emplace_back(place[a], place[b]);
    }
  }
  return all;
}

/// What a kernel should see of a pair, by hand.
Pair<double> pair_by_hand(const Fluid& fluid, const State& s, std::size_t i, std::size_t j,
                          const Noise& noise, unsigned stage, Vector& e) {
  const Vector apart = small_box().minimum_image(s.position[i] - s.position[j]);
  const double r = apart.norm();
  e = apart / r;
  const auto normals = noise.pair_normals(s.id[i], s.id[j], stage, true, true);
  return {r,
          fluid.friction_weight(r),
          fluid.heat_weight(r),
          (s.velocity[i] - s.velocity[j]).dot(e),
          s.internal_energy[i],
          s.internal_energy[j],
          normals.friction,
          normals.heat};
}

/// A kernel in which everything that a pair sees leaves its own trace, with small changes.
constexpr auto everything = [](const auto& p) {
  return Transfer{0.01 * (p.v + 2 * p.noise + p.r * p.u_i - p.w_heat * p.u_j),
                  0.01 * (p.heat_noise + p.u_i * p.w_friction + p.v * p.u_j),
                  0.02 * (p.noise - p.v * p.u_i + p.w_heat)};
};

TEST(Accumulate, SumsTheExchangesOfAllPairsFromTheStateAsItStands) {
  System system = small_system();
  const State before = system.state();
  system.set_step(9);
  Noise noise(4, 2);
  noise.set_step(9);
  Exchange expected;
  expected.reset(27);
  for (const auto& [i, j] : pairs_of(before)) {
    Vector e;
    const auto transfer = everything(pair_by_hand(system.fluid(), before, i, j, noise, 3, e));
    expected.momentum[i] += transfer.momentum * e;
    expected.momentum[j] -= transfer.momentum * e;
    expected.energy[i] += transfer.energy_i;
    expected.energy[j] += transfer.energy_j;
  }
  Exchange total;
  total.reset(3);  // what was in there is of no account
  system.accumulate(everything, total, 3);
  EXPECT_TRUE(same_bits(system.state(), before));
  ASSERT_EQ(total.energy.size(), 27U);
  for (std::size_t i = 0; i < 27; ++i) {
    EXPECT_LT((total.momentum[i] - expected.momentum[i]).norm(), 1e-12);
    EXPECT_NEAR(total.energy[i], expected.energy[i], 1e-12);
  }
  EXPECT_EQ(system.counters().pair_evaluations, pairs_of(before).size());
}

TEST(Accumulate, ShowsATrialEndOfTheStepBesideItsStart) {
  System system = small_system();
  const State start = system.state();
  Motion trial = start;
  Uniform uniform(6);
  for (std::size_t i = 0; i < 27; ++i) {
    trial.velocity[i] += uniform.vector(-1, 1);
    trial.internal_energy[i] *= uniform(0.9, 1.1);
  }
  State end = start;
  end.velocity = trial.velocity;
  end.internal_energy = trial.internal_energy;
  const Noise noise(4, 2);
  const auto pairs = pairs_of(start);
  std::size_t n = 0;
  Exchange total;
  system.accumulate(
      trial,
      [&](const Pair<double>& from, const TrialPair<double>& to) {
        const auto [i, j] = pairs.at(n++);
        Vector e;
        const auto a = pair_by_hand(system.fluid(), start, i, j, noise, 1, e);
        const auto b = pair_by_hand(system.fluid(), end, i, j, noise, 1, e);
        EXPECT_NEAR(from.v, a.v, 1e-13);
        EXPECT_NEAR(to.v, b.v, 1e-13);
        EXPECT_EQ(from.u_i, a.u_i);
        EXPECT_EQ(to.u_i, b.u_i);
        EXPECT_EQ(to.u_j, b.u_j);
        EXPECT_EQ(from.noise, a.noise);
        EXPECT_EQ(to.noise, a.noise);
        EXPECT_EQ(to.heat_noise, a.heat_noise);
        EXPECT_NEAR(to.r, a.r, 1e-13);
        EXPECT_NEAR(to.dv_i, (end.velocity[i] - start.velocity[i]).dot(e), 1e-13);
        EXPECT_NEAR(to.dv_j, (end.velocity[j] - start.velocity[j]).dot(e), 1e-13);
        return Transfer<double>{1, 2, 3};
      },
      total, 1);
  EXPECT_EQ(n, pairs.size());
  const double sum = std::accumulate(total.energy.begin(), total.energy.end(), 0.0);
  EXPECT_EQ(sum, 5.0 * static_cast<double>(pairs.size()));
  EXPECT_TRUE(same_bits(system.state(), start));
}

/// The state after a sweep over pairs in the given order, by hand.
State swept_by_hand(const Fluid& fluid, State s,
                    const std::vector<std::pair<std::size_t, std::size_t>>& pairs, unsigned stage) {
  const Noise noise(4, 2);
  for (const auto& [i, j] : pairs) {
    Vector e;
    const auto transfer = everything(pair_by_hand(fluid, s, i, j, noise, stage, e));
    s.velocity[i] += transfer.momentum / fluid.mass() * e;
    s.velocity[j] -= transfer.momentum / fluid.mass() * e;
    s.internal_energy[i] += transfer.energy_i;
    s.internal_energy[j] += transfer.energy_j;
  }
  return s;
}

TEST(Sweep, LetsEveryPairSeeTheOnesBeforeItInTheOrderOfIdsOrItsReverse) {
  auto pairs = pairs_of(small_system().state());
  System forward = small_system(), reverse = small_system();
  const State start = forward.state();
  forward.sweep(everything, {.order = SweepOrder::forward, .stage = 2});
  reverse.sweep(everything, {.order = SweepOrder::reverse, .stage = 2});
  const State ahead = swept_by_hand(forward.fluid(), start, pairs, 2);
  std::reverse(pairs.begin(), pairs.end());
  const State back = swept_by_hand(forward.fluid(), start, pairs, 2);
  EXPECT_LT(distance(small_box(), forward.state(), ahead).largest(), 1e-11);
  EXPECT_LT(distance(small_box(), reverse.state(), back).largest(), 1e-11);
  EXPECT_GT(distance(small_box(), ahead, back).internal_energy, 1e-3);
  // A sum from the state at the start is something else again.
  System sum = small_system();
  Exchange total;
  sum.accumulate(everything, total, 2);
  sum.apply(total);
  EXPECT_GT(distance(small_box(), forward.state(), sum.state()).internal_energy, 1e-3);
}

/// Runs `act` and gives its failure; fails the test if there is none.
template <class Act>
StepFailure failure_of(Act&& act) {
  try {
    act();
  } catch (const StepFailure& failure) {
    return failure;
  }
  ADD_FAILURE() << "no failure";
  return {FailureCause::not_converged, {}};
}

/// Three particles in a row, each in range of the others: pairs (0, 1), (0, 2), (1, 2).
System three_particles() {
  State state;
  for (std::uint32_t i = 0; i < 3; ++i) {
    state.position.emplace_back(0.3 * i, 1, 1);
    state.velocity.push_back(Vector::Zero());
    state.internal_energy.push_back(10);
    state.id.push_back(20 + i);
  }
  return System(Fluid(small_fluid({}, 0)), small_box(), state, Noise(0, 0));
}

TEST(Sweep, DoesNotForgiveAnEnergyBelowZeroThatALaterPairLifts) {
  System system = three_particles();
  int visit = 0;
  const auto failure = failure_of([&] {
    system.sweep(
        [&](const Pair<double>&) {
          const double energies[] = {-15, 30, 1};
          return Transfer<double>{0, energies[visit++], 0};
        },
        {.order = SweepOrder::forward});
  });
  EXPECT_EQ(visit, 3);
  EXPECT_EQ(failure.cause(), FailureCause::negative_internal_energy);
  EXPECT_EQ(failure.ids(), std::vector<std::uint32_t>{20});
  EXPECT_STREQ(failure.what(), "negative internal energy");
  EXPECT_GT(system.state().internal_energy[0], 0);
}

TEST(Sweep, TellsNumbersThatAreNotFiniteFromEnergiesBelowZero) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    System by_momentum = three_particles(), by_energy = three_particles();
    const auto momentum = failure_of([&] {
      by_momentum.sweep(
          [&](const Pair<double>&) {
            return Transfer<double>{bad, 0, 0};
          },
          {.order = SweepOrder::forward});
    });
    EXPECT_EQ(momentum.cause(), FailureCause::non_finite);
    const auto energy = failure_of([&] {
      by_energy.sweep(
          [&](const Pair<double>&) {
            return Transfer<double>{0, bad, 0};
          },
          {.order = SweepOrder::forward});
    });
    EXPECT_EQ(energy.cause(), FailureCause::non_finite);
    EXPECT_EQ(energy.ids(), (std::vector<std::uint32_t>{20, 21}));
  }
}

TEST(Update, ThrowsWithTheIdsAndTheCause) {
  const double infinite = std::numeric_limits<double>::infinity();
  struct Case {
    double energy, velocity;
    FailureCause cause;
  };
  for (const Case& bad : {Case{0, 0, FailureCause::negative_internal_energy},
                          Case{-1, 0, FailureCause::negative_internal_energy},
                          Case{-1, std::nan(""), FailureCause::negative_internal_energy},
                          Case{std::nan(""), 0, FailureCause::non_finite},
                          Case{infinite, 0, FailureCause::non_finite},
                          Case{1, std::nan(""), FailureCause::non_finite},
                          Case{1, -infinite, FailureCause::non_finite}}) {
    const auto change = [&](std::size_t place, Vector& velocity, double& energy) {
      if (place != 1) return;
      velocity[2] = bad.velocity;
      energy = bad.energy;
    };
    System updated = three_particles();
    const auto failure = failure_of([&] { updated.update(change); });
    EXPECT_EQ(failure.cause(), bad.cause);
    EXPECT_EQ(failure.ids(), std::vector<std::uint32_t>{21});
    System replaced = three_particles();
    Motion motion = replaced.motion();
    change(1, motion.velocity[1], motion.internal_energy[1]);
    EXPECT_EQ(failure_of([&] { replaced.set_motion(motion); }).cause(), bad.cause);
  }
}

TEST(Apply, AddsMomentaAndEnergiesAndThrowsWhereNoneIsLeft) {
  System system = three_particles();
  Exchange exchange;
  exchange.reset(3);
  exchange.momentum[0] = Vector(1, 2, 3);
  exchange.energy[2] = -4;
  system.apply(exchange);
  EXPECT_LT((system.state().velocity[0] - Vector(1, 2, 3) / 1.25).norm(), 1e-15);
  EXPECT_EQ(system.state().internal_energy[2], 6);
  EXPECT_EQ(system.state().internal_energy[1], 10);
  exchange.energy[2] = -7;
  EXPECT_EQ(failure_of([&] { system.apply(exchange); }).ids(), std::vector<std::uint32_t>{22});
}

TEST(Move, GoesThroughTheBoxAndStopsWhereNothingIsFinite) {
  System system = small_system();
  const State start = system.state();
  system.move(10);
  for (std::size_t i = 0; i < 27; ++i) {
    const Vector end = start.position[i] + 10 * start.velocity[i];
    EXPECT_LT(small_box().minimum_image(system.state().position[i] - end).norm(), 1e-12);
    EXPECT_GE(system.state().position[i].minCoeff(), 0);
    EXPECT_LT(system.state().position[i].maxCoeff(), 3);
  }
  State broken = start;
  broken.velocity[4][0] = std::nan("");
  system.set_state(broken);
  const auto failure = failure_of([&] { system.move(1); });
  EXPECT_EQ(failure.cause(), FailureCause::non_finite);
  EXPECT_EQ(failure.ids(), std::vector<std::uint32_t>{start.id[4]});
}

TEST(Move, ThatLeavesTheBoxFarBehindFailsOrStaysInside) {
  for (const double speed : {1e12, 1e20, 1e80, 1e150}) {
    System system = small_system();
    State fast = system.state();
    fast.velocity[7] = Vector(speed, -speed, speed / 3);
    system.set_state(fast);
    try {
      system.move(1);
    } catch (const StepFailure& failure) {
      EXPECT_EQ(failure.cause(), FailureCause::non_finite);
      continue;
    }
    EXPECT_GE(system.state().position[7].minCoeff(), 0) << "at a speed of " << speed;
    EXPECT_LT(system.state().position[7].maxCoeff(), 3) << "at a speed of " << speed;
  }
}

TEST(Move, DoesNothingToFrozenParticles) {
  System system = small_system(all_terms, 0.5, true);
  const State start = system.state();
  system.move(0.7);
  EXPECT_TRUE(same_bits(system.state(), start));
  EXPECT_TRUE(system.frozen());
  system.kick(0.1);
  EXPECT_GT(distance(small_box(), system.state(), start).velocity, 0.01);
}

std::vector<Vector> forces_by_hand(const Fluid& fluid, const State& state) {
  std::vector<Vector> force(state.size(), Vector::Zero());
  for (const auto& [i, j] : pairs_of(state)) {
    const Vector apart = small_box().minimum_image(state.position[i] - state.position[j]);
    force[i] += fluid.repulsive_force(apart.norm()) * apart.normalized();
    force[j] -= fluid.repulsive_force(apart.norm()) * apart.normalized();
  }
  return force;
}

void expect_forces_of_the_present(System& system) {
  const auto expected = forces_by_hand(system.fluid(), system.state());
  double potential = 0;
  for (const auto& [i, j] : pairs_of(system.state())) {
    const auto& r = system.state().position;
    potential += system.fluid().potential(small_box().minimum_image(r[i] - r[j]).norm());
  }
  const auto& force = system.conservative_force();
  for (std::size_t i = 0; i < system.size(); ++i) {
    EXPECT_LT((force[i] - expected[i]).norm(), 1e-11);
  }
  EXPECT_NEAR(system.potential_energy(), potential, 1e-11);
}

TEST(ConservativeForce, IsRenewedWhenPositionsChangeAndOnlyThen) {
  System system = small_system();
  expect_forces_of_the_present(system);
  const auto once = system.counters().pair_evaluations;
  EXPECT_EQ(once, pairs_of(system.state()).size());
  expect_forces_of_the_present(system);
  system.kick(0.1);
  EXPECT_EQ(system.counters().pair_evaluations, once);
  system.move(0.3);
  expect_forces_of_the_present(system);
  EXPECT_GT(system.counters().pair_evaluations, once);
  system.set_state(shuffled_state(system.fluid().parameters()));
  expect_forces_of_the_present(system);
}

TEST(ConservativeForce, IsTheGradientOfThePotentialEnergy) {
  System system = small_system();
  const State start = system.state();
  const auto force = system.conservative_force();
  for (const std::size_t place : {0U, 11U, 26U}) {
    for (int axis = 0; axis < 3; ++axis) {
      double energy[2];
      for (int side = 0; side < 2; ++side) {
        State moved = start;
        moved.position[place][axis] += side == 0 ? -1e-5 : 1e-5;
        system.set_state(moved);
        energy[side] = system.potential_energy();
      }
      EXPECT_NEAR(force[place][axis], -(energy[1] - energy[0]) / 2e-5, 1e-4);
    }
  }
}

TEST(Kick, ChangesMomentaByTheForceTimesTheDuration) {
  System system = small_system();
  const State start = system.state();
  const auto force = forces_by_hand(system.fluid(), start);
  system.kick(0.2);
  for (std::size_t i = 0; i < 27; ++i) {
    EXPECT_LT((system.state().velocity[i] - start.velocity[i] - 0.2 / 1.25 * force[i]).norm(),
              1e-12);
  }
}

TEST(Energies, AreTheSumsOverParticles) {
  System system = small_system();
  double kinetic = 0, internal = 0;
  Vector momentum = Vector::Zero();
  for (std::size_t i = 0; i < 27; ++i) {
    kinetic += 1.25 * system.state().velocity[i].squaredNorm() / 2;
    internal += system.state().internal_energy[i];
    momentum += 1.25 * system.state().velocity[i];
  }
  EXPECT_NEAR(system.kinetic_energy(), kinetic, 1e-12);
  EXPECT_NEAR(system.internal_energy(), internal, 1e-11);
  EXPECT_LT((system.momentum() - momentum).norm(), 1e-13);
  EXPECT_NEAR(system.total_energy(), kinetic + internal + system.potential_energy(), 1e-11);
}

// ---- A scene pays only for what it has. --------------------------------------------------------

TEST(Counters, CountTheNumbersOfTheTermsThatActAndNoOthers) {
  struct Case {
    Terms terms;
    bool friction;
    double boltzmann;
    int numbers_per_pair;
  };
  const HeatForm none = HeatForm::none, heat = HeatForm::temperature;
  const auto noise = FrictionClosure::noise;
  for (const Case& c :
       {Case{{noise, none, true}, false, 1, 0}, Case{{noise, none, true}, true, 1, 1},
        Case{{noise, heat, true}, false, 1, 1}, Case{{noise, heat, true}, true, 1, 2},
        Case{{noise, heat, false}, true, 1, 2}, Case{{noise, heat, true}, true, 0, 0}}) {
    auto f = small_fluid(c.terms, c.boltzmann);
    f.heat_range = f.repulsion_range = 1;  // every pair within range has every term
    if (!c.friction) f.friction = 0;
    System system(Fluid(f), small_box(), small_state(f), Noise(1, 1));
    Exchange total;
    system.accumulate([](const Pair<double>&) { return Transfer<double>{}; }, total);
    const auto pairs = system.counters().pair_evaluations;
    EXPECT_GT(pairs, 30U);
    EXPECT_EQ(system.counters().random_numbers,
              pairs * static_cast<std::uint64_t>(c.numbers_per_pair));
    EXPECT_EQ(system.counters().solver_iterations, 0U);
  }
}

TEST(Counters, OfAFluidWithoutTermsStayAtZero) {
  FluidParameters f;
  System system(Fluid(f), small_box(), small_state(f), Noise(1, 1));
  Exchange total;
  system.accumulate([](const Pair<double>&) { return Transfer<double>{1, 1, 1}; }, total);
  system.kick(1);
  system.move(1);
  EXPECT_EQ(system.counters().pair_evaluations, 0U);
  EXPECT_EQ(system.counters().random_numbers, 0U);
  EXPECT_EQ(system.potential_energy(), 0);
}

TEST(Counters, CountTheNumbersOfEveryTermThatFluctuates) {
  Exchange total;
  for (const auto heat : {HeatForm::none, HeatForm::temperature}) {
    for (const double boltzmann : {0.0, 1.0}) {
      const auto f = small_fluid({FrictionClosure::noise, heat}, boltzmann);
      System system(Fluid(f), small_box(), small_state(f), Noise(1, 1));
      system.accumulate([](const auto& pair) { return Transfer{0 * pair.v}; }, total);
      const std::uint64_t terms = boltzmann == 0 ? 0 : heat == HeatForm::none ? 1 : 2;
      EXPECT_GT(system.counters().pair_evaluations, 0U);
      EXPECT_EQ(system.counters().random_numbers, terms * system.counters().pair_evaluations);
    }
  }
}

TEST(Noise, OfTrialStepsIsDrawnOncePerStepStageAndPositions) {
  System system = small_system();
  Exchange total;
  const auto draw = [&](unsigned stage) {
    const auto before = system.counters().random_numbers;
    system.accumulate(
        system.motion(),
        [](const auto& start, const auto& end) { return Transfer{start.noise + end.heat_noise}; },
        total, stage, Rounds::several);
    return system.counters().random_numbers - before;
  };
  const auto numbers = draw(0);
  const auto first = total.momentum;
  EXPECT_GT(numbers, 0U);
  EXPECT_EQ(draw(0), 0U);
  EXPECT_EQ(total.momentum, first);
  EXPECT_EQ(draw(1), numbers);
  EXPECT_NE(total.momentum, first);
  system.set_step(1);
  EXPECT_EQ(draw(1), numbers);
  const auto before_move = total.momentum;
  system.move(0.01);
  EXPECT_GT(draw(1), 0U);
  EXPECT_NE(total.momentum, before_move);
}

/// So many particles at density 3, at random.
System random_system(const FluidParameters& f, std::size_t particles) {
  Box box{Vector::Constant(std::cbrt(static_cast<double>(particles) / 3))};
  Uniform uniform(3);
  State state;
  for (std::uint32_t id = 0; id < particles; ++id) {
    state.position.push_back(uniform.vector(0, 1).cwiseProduct(box.lengths));
    state.velocity.push_back(uniform.vector(-1, 1));
    state.internal_energy.push_back(uniform(5, 15));
    state.id.push_back(id);
  }
  return System(Fluid(f), box, state, Noise(4, 2));
}

/// Every quantity of a pair and of its trial end.
constexpr auto everything_of_a_trial = [](const auto& start, const auto& end) {
  auto total = everything(start);
  return total += everything(end) += Transfer{end.dv_i, end.dv_j, start.v};
};

// Small systems keep more than large ones.
TEST(Rounds, ThatShareWhatIsKeptSeeWhatOneAloneSees) {
  for (const std::size_t particles : {200, 10100}) {
    for (const auto heat : {HeatForm::none, HeatForm::temperature}) {
      for (const double friction : {0.0, 2.0}) {
        auto f = small_fluid({FrictionClosure::noise, heat, true}, 0.5);
        f.friction = friction;
        System system = random_system(f, particles);
        Motion trial = system.motion();
        Exchange alone, shared;
        for (int round = 0; round < 3; ++round) {
          system.accumulate(trial, everything_of_a_trial, alone, 1);
          system.accumulate(trial, everything_of_a_trial, shared, 1, Rounds::several);
          EXPECT_EQ(alone.momentum, shared.momentum) << particles << " round " << round;
          EXPECT_EQ(alone.energy, shared.energy) << particles << " round " << round;
          for (auto& velocity : trial.velocity) velocity *= 1.5;
          if (round == 1) system.set_motion(trial);
        }
      }
    }
  }
}

// The end to which a change leads is the end itself, and the change may be overwritten by what the
// pairs exchange.
TEST(Trials, AreSeenByWhatLeadsToThem) {
  for (const std::size_t particles : {200, 10100}) {
    for (const bool isothermal : {false, true}) {
      auto f = small_fluid({FrictionClosure::noise, HeatForm::none, true}, 0.5);
      f.isothermal = isothermal;
      System system = random_system(f, particles);
      Exchange change;
      system.accumulate(everything, change, 7);
      Motion trial = system.motion();
      for (std::size_t i = 0; i < system.size(); ++i) {
        trial.velocity[i] += change.momentum[i] * (1 / system.mass(i));
        trial.internal_energy[i] += change.energy[i];
      }
      Exchange by_motion, by_change;
      system.accumulate(trial, everything_of_a_trial, by_motion, 1);
      system.accumulate(change, everything_of_a_trial, by_change, 1);
      // To rounding: the processor's variant of the pairs may fuse what the loop above rounds.
      for (std::size_t i = 0; i < system.size(); ++i) {
        EXPECT_NEAR((by_motion.momentum[i] - by_change.momentum[i]).norm(), 0, 1e-10) << particles;
        EXPECT_NEAR(by_motion.energy[i], by_change.energy[i], 1e-10) << particles;
      }
      system.accumulate(change, everything_of_a_trial, change, 1);
      EXPECT_EQ(by_change.momentum, change.momentum) << particles;
      EXPECT_EQ(by_change.energy, change.energy) << particles;
    }
  }
}

// ---- What a system refuses. --------------------------------------------------------------------

TEST(System, RefusesStatesThatAreNone) {
  const auto f = small_fluid(all_terms, 1);
  const auto make = [&](State state, const Box& box = small_box()) {
    return System(Fluid(f), box, std::move(state), Noise(0, 0));
  };
  State state = small_state(f);
  EXPECT_NO_THROW(make(state));
  State twice = state;
  twice.id[3] = twice.id[8];
  EXPECT_THROW(make(twice), std::invalid_argument);
  EXPECT_THROW(make(state).set_state(twice), std::invalid_argument);
  for (int array = 0; array < 3; ++array) {
    State shorter = state;
    if (array == 0) shorter.velocity.pop_back();
    if (array == 1) shorter.internal_energy.pop_back();
    if (array == 2) shorter.id.pop_back();
    EXPECT_THROW(make(shorter), std::invalid_argument);
  }
  EXPECT_THROW(make(state, Box{Vector(3, 1.9, 3)}), std::invalid_argument);
}

TEST(System, WrapsThePositionsThatItIsGiven) {
  const auto f = small_fluid(all_terms, 1);
  State state = small_state(f);
  State shifted = state;
  for (auto& position : shifted.position) position += Vector(3, -6, 9);
  System system(Fluid(f), small_box(), shifted, Noise(0, 0));
  EXPECT_LT(distance(small_box(), system.state(), state).position, 1e-14);
  for (const auto& position : system.state().position) {
    EXPECT_GE(position.minCoeff(), 0);
    EXPECT_LT(position.maxCoeff(), 3);
  }
}

TEST(Box, WrapsIntoTheBoxAndFindsTheShortestImage) {
  const Box box{Vector(2, 3, 5)};
  EXPECT_EQ(box.volume(), 30);
  EXPECT_EQ(box.wrap(Vector(2, 3, 5)), Vector(0, 0, 0));
  EXPECT_EQ(box.wrap(Vector(-0.5, 3.5, 12)), Vector(1.5, 0.5, 2));
  const Vector tiny = box.wrap(Vector::Constant(-1e-300));  // rounds to the upper edge
  EXPECT_EQ(tiny, Vector(0, 0, 0));
  EXPECT_EQ(box.minimum_image(Vector(1.5, -1.75, 5)), Vector(-0.5, 1.25, 0));
  Uniform uniform(1);
  for (int n = 0; n < 1000; ++n) {
    const Vector r = uniform.vector(-40, 40);
    const Vector wrapped = box.wrap(r), image = box.minimum_image(r);
    EXPECT_TRUE((wrapped.array() >= 0).all() && (wrapped.array() < box.lengths.array()).all());
    EXPECT_TRUE((image.array().abs() <= box.lengths.array() / 2 + 1e-14).all());
    const Vector periods = (wrapped - image).cwiseQuotient(box.lengths);
    EXPECT_LT((periods - periods.array().round().matrix()).norm(), 1e-13);
  }
}

// ---- Few particles. ----------------------------------------------------------------------------

TEST(System, OfOneParticleHasNoPairs) {
  const auto f = small_fluid(all_terms, 1);
  State state;
  state.position = {Vector(1, 2, 0.5)};
  state.velocity = {Vector(0.5, 0, -1)};
  state.internal_energy = {4};
  state.id = {77};
  System system(Fluid(f), small_box(), state, Noise(0, 0));
  system.sweep(everything);
  system.kick(1);
  system.move(1);
  EXPECT_EQ(system.counters().pair_evaluations, 0U);
  EXPECT_EQ(system.potential_energy(), 0);
  EXPECT_EQ(system.state().internal_energy[0], 4);
  EXPECT_EQ(system.state().position[0], Vector(1.5, 2, 2.5));
}

TEST(System, OfTwoParticlesSeesThemThroughTheBox) {
  const auto f = small_fluid(all_terms, 0);
  State state;
  state.position = {Vector(0.25, 1, 1), Vector(2.75, 1, 1)};
  state.velocity = {Vector(1, 0, 0), Vector(-1, 5, 0)};
  state.internal_energy = {4, 5};
  state.id = {9, 2};  // i is the second in storage
  System system(Fluid(f), small_box(), state, Noise(0, 0));
  int visits = 0;
  system.sweep(
      [&](const Pair<double>& pair) {
        ++visits;
        EXPECT_NEAR(pair.r, 0.5, 1e-15);
        EXPECT_NEAR(pair.v, 2, 1e-15);  // they fly apart
        EXPECT_EQ(pair.u_i, 5);
        EXPECT_EQ(pair.u_j, 4);
        return Transfer<double>{1.25, 1, -1};
      },
      {.order = SweepOrder::forward});
  EXPECT_EQ(visits, 1);
  EXPECT_LT((system.state().velocity[0] - Vector(2, 0, 0)).norm(), 1e-15);
  EXPECT_LT((system.state().velocity[1] - Vector(-2, 5, 0)).norm(), 1e-15);
  EXPECT_EQ(system.state().internal_energy, (std::vector<double>{3, 6}));
}

TEST(FailureCause, HasWords) {
  EXPECT_EQ(to_string(FailureCause::non_finite), "non-finite number");
  EXPECT_EQ(to_string(FailureCause::negative_internal_energy), "negative internal energy");
  EXPECT_EQ(to_string(FailureCause::not_converged), "solver did not converge");
}

}  // namespace
}  // namespace driftless::testing
