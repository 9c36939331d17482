#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/prepared_scene.hpp"
#include "experiments/scene_keys.hpp"

// Scenes of several species start in their exact law and know what is exact.
namespace driftless::testing {
namespace {

Scene scene_of(bool isothermal, double second_heat_capacity) {
  Scene scene = find_preset("mackie-1999")->scene;
  scene.particles = 300;
  scene.fluid.further_species = {{.mass = 3, .heat_capacity = second_heat_capacity}};
  scene.further_shares = {0.3};
  scene.fluid.isothermal = isothermal;
  if (isothermal) {
    scene.fluid.conduction = 0;
    scene.initial_state = InitialState::canonical;
  }
  return scene;
}

TEST(SceneOfSpecies, StartsInItsLawAndKnowsWhatIsExact) {
  const Scene scene = scene_of(false, 20);
  const PreparedScene prepared(scene, 1, 3);
  ASSERT_TRUE(prepared.law());
  const auto species = scene_species(scene);
  const auto second = std::count(species.begin(), species.end(), 1);
  EXPECT_GT(second, 80);
  EXPECT_LT(second, 100);
  const double total =
      1.5 * 299 + static_cast<double>(300 - second) * 101 + static_cast<double>(second) * 41;
  EXPECT_NEAR(prepared.law()->total_shape(), total, 1e-9);
  const double energy = total * 0.5 * 1.1;
  for (const unsigned replica : {0U, 2U}) {  // the last one off equilibrium
    System system = prepared.start(replica);
    EXPECT_NEAR(system.total_energy(), energy, 1e-9);
    EXPECT_LT(system.momentum().norm(), 1e-10);
    EXPECT_EQ(system.state().species, species);
  }
  EXPECT_NEAR(prepared.reference("kinetic_temperature")->value, 1.1, 1e-12);
  EXPECT_NEAR(prepared.reference("internal_temperature")->value, 1.1 * total / (total - 1), 1e-12);
  const double shapes = total - 1.5 * 299;
  EXPECT_NEAR(prepared.reference("internal_energy_mean")->value, energy * shapes / total / 300,
              1e-9);
  for (const char* name : {"internal_energy_variance", "internal_energy_distance"}) {
    EXPECT_FALSE(prepared.reference(name)) << name;
    EXPECT_TRUE(PreparedScene(scene_of(false, 50), 1, 3).reference(name)) << name;
  }
  EXPECT_TRUE(prepared.reference("momentum_distance"));
}

/// Velocities in units of their thermal ones have the spread 1 in every species: 7 errors.
TEST(SceneOfSpecies, StartsAtTheBathsTemperatureInEverySpecies) {
  for (const bool isothermal : {false, true}) {
    const PreparedScene prepared(scene_of(isothermal, 20), 1, 40);
    std::array<double, 2> squares = {}, number = {};
    for (unsigned replica = 0; replica < 30; ++replica) {
      const System system = prepared.start(replica);
      for (std::size_t i = 0; i < system.size(); ++i) {
        const auto& state = system.state();
        const double thermal = 0.5 * 1.1 * (1 - system.mass(i) / (300 * 1.6));
        squares[state.species[i]] += system.mass(i) * state.velocity[i].squaredNorm() / thermal;
        number[state.species[i]] += 3;
      }
    }
    for (const std::size_t s : {0U, 1U}) {
      EXPECT_NEAR(squares[s] / number[s], 1, 7 * std::sqrt(2 / number[s]));
    }
    EXPECT_NEAR(prepared.reference("kinetic_temperature")->value, 1.1, 1e-12);
  }
}

}  // namespace
}  // namespace driftless::testing
