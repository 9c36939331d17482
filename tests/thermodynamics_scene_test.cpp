#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "experiments/prepared_scene.hpp"
#include "tests/scene_reading.hpp"

// Scenes whose particles have other entropies, or whose coefficients follow the temperatures.

namespace driftless::testing {
namespace {

using nlohmann::json;

json scene_of(const json& overrides) {
  json object = {{"preset", "soft-fluid"}, {"repulsion", 0}, {"particles", 100}};
  object.update(overrides);
  return object;
}

const json points = {{0.5, 20.0}, {1.0, 60.0}, {2.0, 150.0}};

TEST(ThermodynamicScene, SaysWhatItsKeysSay) {
  const Scene scene = read(scene_of({{"boltzmann", 0.5},
                                     {"heat_capacity", 40},
                                     {"heat_capacity_slope", 10},
                                     {"friction_temperature_exponent", 1.5},
                                     {"conduction_temperature_exponent", -2}}));
  EXPECT_EQ(scene.fluid.heat_capacity, 20);
  EXPECT_EQ(scene.fluid.heat_capacity_slope, 5);
  EXPECT_EQ(scene.fluid.friction_temperature_exponent, 1.5);
  EXPECT_EQ(scene.fluid.conduction_temperature_exponent, -2);
  const Fluid fluid(scene.fluid);
  EXPECT_DOUBLE_EQ(1 / fluid.equation_of_state().inverse_heat_capacity(fluid.internal_energy(1.6)),
                   23);
  const Scene tabulated = read(scene_of({{"equation_of_state", points}}));
  EXPECT_DOUBLE_EQ(Fluid(tabulated.fluid).internal_energy(1), 60);
}

TEST(ThermodynamicScene, IsReadBackAsItIsWritten) {
  for (const json& overrides :
       {json{{"equation_of_state", points}, {"friction_temperature_exponent", 1}},
        json{{"heat_capacity_slope", 10}, {"conduction_temperature_exponent", 2}},
        json{{"equation_of_state", points},
             {"species", {{{"share", 0.3}, {"heat_capacity", 2}}}}}}) {
    const json written = to_json(read(scene_of(overrides)));
    EXPECT_EQ(to_json(read(written)), written);
    EXPECT_EQ(Fluid(read(written).fluid).equation_of_state(),
              Fluid(read(scene_of(overrides)).fluid).equation_of_state());
  }
}

TEST(ThermodynamicScene, GivesSpeciesMultiplesOfTheFirstOnesHeatCapacity) {
  const Fluid fluid(read(scene_of({{"equation_of_state", points},
                                   {"species", {{{"share", 0.3}, {"heat_capacity", 2}}}}}))
                        .fluid);
  for (const double theta : {0.3, 0.8, 1.7, 4.0}) {
    EXPECT_DOUBLE_EQ(fluid.equation_of_state(1).internal_energy(theta),
                     2 * fluid.internal_energy(theta));
  }
}

TEST(ThermodynamicScene, RefusesWhatIsNoEquationOfState) {
  const auto refused = [](const json& overrides) { return refusal_of(scene_of(overrides)); };
  const std::string falling =
      refused({{"equation_of_state", {{0.5, 20.0}, {1.0, 60.0}, {2.0, 59.0}}}});
  EXPECT_NE(falling.find("equation_of_state"), std::string::npos);
  EXPECT_NE(falling.find("point 3"), std::string::npos) << falling;
  EXPECT_NE(falling.find("59"), std::string::npos) << falling;
  const std::string shapeless = refused({{"equation_of_state", {{0.5, 20.0}, {1.0}}}});
  EXPECT_NE(shapeless.find("[1]"), std::string::npos) << shapeless;
  EXPECT_NE(shapeless.find("[temperature, energy]"), std::string::npos) << shapeless;
  EXPECT_NE(refused({{"equation_of_state", {{1.0, 20.0}}}}).find("at least 2"), std::string::npos);
  EXPECT_EQ(refused({{"equation_of_state", json::array()}}), "");
  const std::string steep = refused({{"heat_capacity_slope", 60}});
  EXPECT_NE(steep.find("heat_capacity_slope"), std::string::npos) << steep;
  EXPECT_NE(steep.find("< 60"), std::string::npos) << steep;
  EXPECT_EQ(refused({{"heat_capacity_slope", 59}}), "");
  EXPECT_NE(refused({{"heat_capacity_slope", -1}}).find(">= 0"), std::string::npos);
  EXPECT_NE(refused({{"equation_of_state", points}, {"heat_capacity", 50}}).find("no effect"),
            std::string::npos);
  EXPECT_NE(refusal_of({{"preset", "groot-warren-1997"}, {"friction_temperature_exponent", 1}})
                .find("no effect"),
            std::string::npos);
}

TEST(ThermodynamicScene, StartsAtItsTemperatureWithoutALaw) {
  for (const double repulsion : {0.0, 25.0}) {
    const Scene scene = read(scene_of({{"equation_of_state", points}, {"repulsion", repulsion}}));
    const PreparedScene prepared(scene, 1, 4);
    EXPECT_FALSE(prepared.law());
    EXPECT_FALSE(prepared.reference("internal_temperature"));
    EXPECT_FALSE(prepared.reference("pressure"));
    const double energy = prepared.start(0).total_energy();
    EXPECT_NEAR(energy, 100 * prepared.energy_per_particle(), 1e-10 * energy);
    for (unsigned replica = 0; replica < 4; ++replica) {
      System system = prepared.start(replica);
      EXPECT_NEAR(system.total_energy(), energy, 1e-10 * energy);
      const double kinetic = 2 * system.kinetic_energy() / (3 * 99);
      EXPECT_NEAR(kinetic, replica == 3 ? 0.5 : 1, 1e-12);
      if (repulsion > 0 || replica == 3) continue;
      for (const double u : system.state().internal_energy) EXPECT_NEAR(u, 60, 1e-10);
    }
  }
}

TEST(ThermodynamicScene, TakesARepulsionThatFollowsTheTemperatures) {
  const auto with = [](json overrides) {
    overrides["thermal_repulsion"] = 10;
    return scene_of(overrides);
  };
  const Scene scene = read(with({{"repulsion", 15}}));
  EXPECT_EQ(scene.fluid.repulsion, 15);
  EXPECT_EQ(scene.fluid.thermal_repulsion, 10);
  EXPECT_EQ(to_json(scene)["thermal_repulsion"], 10);
  EXPECT_EQ(to_json(read(to_json(scene))), to_json(scene));
  EXPECT_FALSE(to_json(read(scene_of(json::object()))).contains("thermal_repulsion"));
  EXPECT_NE(refusal_of(scene_of({{"thermal_repulsion", -1}})).find(">= 0"), std::string::npos);
  for (const json& bad : {json{{"heat_capacity_slope", 10}}, json{{"equation_of_state", points}}}) {
    const std::string told = refusal_of(with(bad));
    EXPECT_NE(told.find("thermal_repulsion: is 10, which is built for constant heat capacities; "
                        "allowed is 0 with " +
                        bad.begin().key()),
              std::string::npos)
        << told;
  }
  EXPECT_NE(
      refusal_of(with({{"frozen", true}})).find("thermal_repulsion: is 10, but a force on frozen"),
      std::string::npos);
  EXPECT_NE(refusal_of({{"preset", "groot-warren-1997"}, {"thermal_repulsion", 1}})
                .find("thermal_repulsion: is 1 but has no effect here"),
            std::string::npos);
}

TEST(ThermodynamicScene, StartsAtItsEnergyWithARepulsionThatFollowsTheTemperatures) {
  const PreparedScene prepared(
      read(scene_of({{"repulsion", 5}, {"thermal_repulsion", 20}, {"heat_capacity", 12}})), 1, 4);
  ASSERT_TRUE(prepared.law());
  const double energy = 100 * prepared.energy_per_particle();
  for (unsigned replica = 0; replica < 4; ++replica) {
    EXPECT_NEAR(prepared.start(replica).total_energy(), energy, 1e-10 * energy);
  }
  const auto value = [&](const char* name) { return prepared.reference(name)->value; };
  // The energy is that at which the temperature is 1; the errors are those of the references.
  EXPECT_NEAR(value("kinetic_temperature"), 1, 0.01);
  EXPECT_NEAR(value("internal_temperature"), 1, 0.01);
  EXPECT_NEAR(value("configurational_temperature"), 1,
              6 * prepared.reference("configurational_temperature")->error + 0.02);
  EXPECT_LT(prepared.reference("configurational_temperature")->error, 0.03);
  EXPECT_GT(value("pressure"), 5);
}

}  // namespace
}  // namespace driftless::testing
