#include "model/heat_slabs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "integrators/integrator.hpp"
#include "tests/small_system.hpp"

namespace driftless::testing {
namespace {

const Terms terms{FrictionClosure::noise, HeatForm::inverse_temperature, true};

HeatSlabs slabs_of(SlabDrive drive) {
  return {.drive = drive,
          .axis = 1,
          .hot = {0, 0.75},
          .cold = {1.5, 2.25},
          .rate = 3,
          .hot_temperature = 1.6,
          .cold_temperature = 0.8,
          .period = drive == SlabDrive::heat_rate ? 0 : 0.03};
}

System small_system() {
  const auto f = small_fluid(terms, 0.5);
  return System(Fluid(f), small_box(), small_state(f), Noise(4, 2));
}

SlabHeater heater(const HeatSlabs& slabs) {
  return {slabs, Fluid(small_fluid(terms, 0.5)), small_box(), Noise(5, 0)};
}

const SlabDrive all_drives[] = {SlabDrive::heat_rate, SlabDrive::velocity_exchange,
                                SlabDrive::energy_exchange, SlabDrive::temperatures};

/// What the energy of a driven run says more than the books of its slabs, at worst, and how much
/// energy was moved. `leak` is taken from a particle at every step by somebody else.
struct Balance {
  double worst = 0, moved = 0;
};
Balance balance(SlabDrive drive, double leak = 0) {
  System system = small_system();
  const auto method = find_method("isoenergetic-verlet")->make({});
  SlabHeater slabs = heater(slabs_of(drive));
  const double start = system.total_energy();
  Balance found;
  for (std::uint64_t step = 1; step <= 300; ++step) {
    run(*method, system, 0.01, step, step + 1);
    slabs.act(system, 0.01);
    if (leak != 0) {
      system.update([&](std::size_t i, Vector&, double& u) { u -= i == 0 ? leak : 0; });
    }
    const double stored = system.total_energy() - start;
    found.worst = std::max(found.worst, std::abs(stored - slabs.given()));
    const double driver = system.state().surroundings[driver_place].energy;
    found.worst = std::max(found.worst, std::abs(stored + driver));
    found.moved = std::abs(slabs.given_to_hot());
  }
  return found;
}

TEST(HeatSlabs, EnergyInIsEnergyStoredAtEveryStep) {
  for (const auto drive : all_drives) {
    const Balance found = balance(drive);
    EXPECT_LT(found.worst, 1e-9) << static_cast<int>(drive);
    EXPECT_GT(found.moved, 1) << static_cast<int>(drive);
  }
}

TEST(HeatSlabs, TheBalanceSeesALeakOfOneMillionth) {
  for (const auto drive : all_drives) EXPECT_GT(balance(drive, 1e-6).worst, 1e-5);
}

TEST(HeatSlabs, HeatIsSharedEquallyAndNothingElseChanges) {
  System system = small_system();
  const State before = system.state();
  SlabHeater slabs = heater(slabs_of(SlabDrive::heat_rate));
  slabs.act(system, 0.5);
  std::vector<double> hot, cold;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double change = system.state().internal_energy[i] - before.internal_energy[i];
    const double y = before.position[i][1];
    if (y < 0.75) {
      hot.push_back(change);
    } else if (y >= 1.5 && y < 2.25) {
      cold.push_back(change);
    } else {
      EXPECT_EQ(change, 0);
    }
  }
  ASSERT_GT(hot.size(), 1U);
  ASSERT_GT(cold.size(), 1U);
  for (const double gain : hot) EXPECT_NEAR(gain, 1.5 / static_cast<double>(hot.size()), 1e-14);
  for (const double gain : cold) EXPECT_NEAR(gain, -1.5 / static_cast<double>(cold.size()), 1e-14);
  EXPECT_EQ(system.state().velocity, before.velocity);
  EXPECT_EQ(slabs.given_to_hot(), 1.5);
  EXPECT_EQ(slabs.given_to_cold(), -1.5);
}

TEST(HeatSlabs, HeatWaitsForParticlesInBothSlabs) {
  const auto f = small_fluid(terms, 0.5);
  State state = small_state(f);
  for (auto& position : state.position) {
    if (position[1] >= 1.5 && position[1] < 2.25) position[1] = 1;
  }
  System system(Fluid(f), small_box(), state, Noise(4, 2));
  SlabHeater slabs = heater(slabs_of(SlabDrive::heat_rate));
  slabs.act(system, 0.5);
  EXPECT_EQ(slabs.given_to_hot(), 0);
  EXPECT_EQ(slabs.owed(), 1.5);
  EXPECT_EQ(system.state().internal_energy, state.internal_energy);
  system.set_state(small_state(f));
  slabs.act(system, 0.5);
  EXPECT_EQ(slabs.given_to_hot(), 3);
  EXPECT_EQ(slabs.owed(), 0);
}

TEST(HeatSlabs, AHeatThatAParticleDoesNotHaveIsAFailureThatChangesNothing) {
  System system = small_system();
  const State before = system.state();
  SlabHeater slabs = heater(slabs_of(SlabDrive::heat_rate));
  try {
    slabs.act(system, 1000);
    ADD_FAILURE() << "more heat was taken than there is";
  } catch (const StepFailure& failure) {
    EXPECT_EQ(failure.cause(), FailureCause::negative_internal_energy);
    EXPECT_FALSE(failure.ids().empty());
  }
  EXPECT_TRUE(same_bits(system.state(), before));
  EXPECT_EQ(slabs.given_to_hot(), 0);
}

TEST(HeatSlabs, TheSlowestOfTheHotAndTheFastestOfTheColdSlabSwapVelocities) {
  System system = small_system();
  const State before = system.state();
  SlabHeater slabs = heater(slabs_of(SlabDrive::velocity_exchange));
  slabs.act(system, 0.03);
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (system.state().velocity[i] != before.velocity[i]) changed.push_back(i);
  }
  ASSERT_EQ(changed.size(), 2U);
  const bool in_order = before.position[changed[0]][1] < 0.75;
  const std::size_t hot = changed[in_order ? 0 : 1], cold = changed[in_order ? 1 : 0];
  EXPECT_EQ(system.state().velocity[hot], before.velocity[cold]);
  EXPECT_EQ(system.state().velocity[cold], before.velocity[hot]);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double speed = before.velocity[i].squaredNorm(), y = before.position[i][1];
    if (y < 0.75) {
      EXPECT_GE(speed, before.velocity[hot].squaredNorm());
    }
    if (y >= 1.5 && y < 2.25) {
      EXPECT_LE(speed, before.velocity[cold].squaredNorm());
    }
  }
  EXPECT_EQ(system.state().internal_energy, before.internal_energy);
}

TEST(HeatSlabs, ExchangesKeepEnergyAndMomentumToRounding) {
  for (const auto drive : {SlabDrive::velocity_exchange, SlabDrive::energy_exchange}) {
    System system = small_system();
    const double energy = system.total_energy();
    const Vector momentum = system.momentum();
    SlabHeater slabs = heater(slabs_of(drive));
    for (int n = 0; n < 5; ++n) slabs.act(system, 0.03);
    EXPECT_EQ(slabs.acts(), 5U);
    EXPECT_GT(slabs.given_to_hot(), 0);
    EXPECT_NEAR(system.total_energy(), energy, 1e-12 * energy);
    EXPECT_LT((system.momentum() - momentum).norm(), 1e-12);
  }
}

TEST(HeatSlabs, ExchangesStopOnceTheHotSlabIsTheHotterOne) {
  System system = small_system();
  SlabHeater slabs = heater(slabs_of(SlabDrive::energy_exchange));
  for (int n = 0; n < 100; ++n) slabs.act(system, 0.03);
  const double given = slabs.given_to_hot();
  const State before = system.state();
  slabs.act(system, 0.03);
  EXPECT_EQ(slabs.given_to_hot(), given);
  EXPECT_TRUE(same_bits(system.state(), before));
}

TEST(HeatSlabs, APeriodIsKeptWhateverTheDurationsOfTheCalls) {
  for (const int calls : {1, 3, 7, 100}) {
    System system = small_system();
    SlabHeater slabs = heater(slabs_of(SlabDrive::temperatures));
    for (int n = 0; n < calls; ++n) slabs.act(system, 0.3 / calls);
    EXPECT_EQ(slabs.acts(), 10U) << calls;
  }
  System system = small_system();
  SlabHeater slabs = heater(slabs_of(SlabDrive::temperatures));
  slabs.act(system, 0);
  EXPECT_EQ(slabs.acts(), 0U);
}

/// Mean and variance of the energies drawn in the hot slab, as standard scores against the
/// canonical law at `temperature`.
struct Scores {
  double mean, variance;
};
Scores scores_of_draws(double temperature) {
  System system = small_system();
  SlabHeater slabs = heater(slabs_of(SlabDrive::temperatures));
  std::vector<double> drawn;
  for (int n = 0; n < 2000; ++n) {
    slabs.act(system, 0.03);
    for (std::size_t i = 0; i < system.size(); ++i) {
      if (system.state().position[i][1] < 0.75) drawn.push_back(system.state().internal_energy[i]);
    }
  }
  const double shape = 12 / 0.5 + 1, scale = 0.5 * temperature;
  const auto count = static_cast<double>(drawn.size());
  double mean = 0, variance = 0;
  for (const double u : drawn) mean += u / count;
  for (const double u : drawn) variance += (u - shape * scale) * (u - shape * scale) / count;
  const double exact = shape * scale * scale;
  // The fourth central moment of a gamma law is 3 + 6/shape squared variances.
  return {(mean - shape * scale) / std::sqrt(exact / count),
          (variance - exact) / (exact * std::sqrt((2 + 6 / shape) / count))};
}

TEST(HeatSlabs, EnergiesAreDrawnFromTheCanonicalLaw) {
  // About 10^4 independent draws; a normal score is beyond 6 in 2 of 10^9 cases.
  const Scores right = scores_of_draws(1.6);
  EXPECT_LT(std::abs(right.mean), 6);
  EXPECT_LT(std::abs(right.variance), 6);
  EXPECT_GT(std::abs(scores_of_draws(1.6 * 1.03).mean), 6);
}

TEST(HeatSlabs, WhatIsSavedGoesOnWithTheSameBits) {
  for (const auto drive : all_drives) {
    System one = small_system(), other = small_system();
    SlabHeater whole = heater(slabs_of(drive)), first = heater(slabs_of(drive));
    for (int n = 0; n < 20; ++n) whole.act(one, 0.02);
    for (int n = 0; n < 10; ++n) first.act(other, 0.02);
    SlabHeater second = heater(slabs_of(drive));
    second.load(first.save());
    for (int n = 0; n < 10; ++n) second.act(other, 0.02);
    EXPECT_TRUE(same_bits(one.state(), other.state()));
    EXPECT_EQ(whole.save(), second.save());
  }
}

TEST(HeatSlabs, SpeciesOfDifferentMassesDoNotExchangeVelocities) {
  auto f = small_fluid(terms, 0.5);
  f.further_species.push_back({});
  f.further_species.back().heat_capacity = 9;
  const auto make = [&](SlabDrive drive) {
    return SlabHeater(slabs_of(drive), Fluid(f), small_box(), Noise(5, 0));
  };
  f.further_species.back().mass = f.mass;
  EXPECT_NO_THROW(make(SlabDrive::velocity_exchange));
  f.further_species.back().mass = 2 * f.mass;
  EXPECT_THROW(make(SlabDrive::velocity_exchange), std::invalid_argument);
  EXPECT_NO_THROW(make(SlabDrive::energy_exchange));
}

TEST(HeatSlabs, EnergiesAreDrawnForAConstantHeatCapacityAlone) {
  auto f = small_fluid(terms, 0.5);
  f.equation_of_state = {{0.5, 5}, {1, 12}, {2, 30}};
  const auto make = [&](SlabDrive drive) {
    return SlabHeater(slabs_of(drive), Fluid(f), small_box(), Noise(5, 0));
  };
  EXPECT_THROW(make(SlabDrive::temperatures), std::invalid_argument);
  EXPECT_NO_THROW(make(SlabDrive::heat_rate));
}

TEST(HeatSlabs, WhatMakesNoSenseIsRefused) {
  const auto refused = [](auto change) {
    HeatSlabs slabs = slabs_of(SlabDrive::heat_rate);
    change(slabs);
    EXPECT_THROW(heater(slabs), std::invalid_argument);
  };
  refused([](HeatSlabs& s) { s.axis = 3; });
  refused([](HeatSlabs& s) { s.hot.from = -0.1; });
  refused([](HeatSlabs& s) { s.cold.to = 3.1; });
  refused([](HeatSlabs& s) { s.hot.to = s.hot.from; });
  refused([](HeatSlabs& s) { s.hot.to = 1.6; });
  refused([](HeatSlabs& s) { s.rate = 0; });
  refused([](HeatSlabs& s) { s.period = -1; });
  refused([](HeatSlabs& s) {
    s.drive = SlabDrive::temperatures;
    s.hot_temperature = 0;
  });
  auto bath = small_fluid({FrictionClosure::noise, HeatForm::none, false, true}, 0.5);
  EXPECT_THROW(SlabHeater(slabs_of(SlabDrive::heat_rate), Fluid(bath), small_box(), Noise(5, 0)),
               std::invalid_argument);
}

}  // namespace
}  // namespace driftless::testing
