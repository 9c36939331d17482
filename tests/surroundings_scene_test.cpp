#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/prepared_scene.hpp"
#include "experiments/scene_keys.hpp"
#include "tests/scene_reading.hpp"
#include "tests/small_system.hpp"

// Scenes with walls, gravity, several species and heat slabs, as they are written and as they run.
namespace driftless::testing {
namespace {

using nlohmann::json;

json walled_scene() {
  return json::parse(R"({
    "preset": "mackie-1999", "particles": 900, "sides": [2, 1, 1.5], "initial_state": "rest",
    "walls": {
      "x_lower": {"temperature": 1.3, "repulsion": 20, "repulsion_range": 0.5, "friction": 1,
                  "friction_range": 1.24, "conduction": 850, "heat_range": 1.2},
      "x_upper": {"temperature": 0.9, "friction": 2},
      "z_lower": {"repulsion": 30}, "z_upper": {"repulsion": 30}
    },
    "gravity": [0, 0, -0.01],
    "species": [{"share": 0.2, "mass": 4}, {"share": 0.1, "heat_capacity": 0.5}],
    "species_pairs": [{"first": 2, "second": 0, "friction": 3}]
  })");
}

json slab_scene() {
  return json::parse(R"({
    "preset": "soft-fluid", "particles": 300, "sides": [1, 1, 4], "initial_state": "rest",
    "heat_slabs": {"drive": "heat-rate", "axis": "z", "hot": {"from": 2, "to": 3},
                   "cold": {"from": 7, "to": 8}, "rate": 30}
  })");
}

void expect_refusal(const json& object, const std::string& part) {
  EXPECT_NE(refusal_of(object).find(part), std::string::npos) << refusal_of(object);
}

TEST(WalledScene, IsReadAndWrittenAlike) {
  for (const auto& object : {walled_scene(), slab_scene()}) {
    const Scene scene = read(object);
    json again = scene_parameters(scene);
    again["preset"] = object["preset"];
    EXPECT_EQ(scene_parameters(read(again)), scene_parameters(scene));
  }
}

TEST(WalledScene, HasTheBoxAndTheSpeciesThatWereAskedFor) {
  const Scene scene = read(walled_scene());
  const Box box = scene_box(scene);
  EXPECT_NEAR(box.volume(), 900, 1e-9);
  EXPECT_NEAR(box.lengths[0] / box.lengths[1], 2, 1e-12);
  EXPECT_NEAR(box.lengths[2] / box.lengths[1], 1.5, 1e-12);
  EXPECT_TRUE(box.is_walled(0) && !box.is_walled(1) && box.is_walled(2));
  EXPECT_EQ(box.walls[0]->temperature, 1.3);
  EXPECT_EQ(box.walls[1]->friction, 2);
  EXPECT_FALSE(box.walls[4]->temperature.has_value());
  EXPECT_EQ(box.gravity, Vector(0, 0, -0.01));
  const auto species = scene_species(scene);
  EXPECT_NEAR(static_cast<double>(std::count(species.begin(), species.end(), 1)), 180, 2);
  EXPECT_NEAR(static_cast<double>(std::count(species.begin(), species.end(), 2)), 90, 2);
  const Fluid fluid(scene.fluid);
  EXPECT_EQ(fluid.mass(1), 4);
  EXPECT_EQ(fluid.equation_of_state(2).internal_energy(1.0), 25);
  EXPECT_EQ(fluid.law(0, 2).friction(Pair<double>{0.5, 1, 1, 0, 55, 27, 0, 0}).friction, 3);
}

TEST(WalledScene, StartsAtOneTemperatureAndAtRest) {
  auto object = walled_scene();
  object["initial_velocity_spread"] = 0.7;
  object["initial_state"] = "given";
  System system = PreparedScene(read(object), 1, 1).start(0);
  EXPECT_LT(system.momentum().norm(), 1e-9);
  for (std::size_t i = 0; i < system.size(); ++i) {
    const double u = system.state().internal_energy[i];
    EXPECT_NEAR(system.equation_of_state(i).temperature(u), 1.1, 1e-12);
  }
}

/// Nothing is lost between the fluid and what drives it, which takes part.
TEST(BoundedPresets, RunAndExchangeEnergyWithTheirSurroundings) {
  for (json object : {json{{"preset", "mackie-1999-box"}, {"particles", 1000}},
                      json{{"preset", "mackie-1999-roll"}, {"particles", 1000}},
                      json{{"preset", "soleymani-2020-slabs"}}}) {
    SCOPED_TRACE(object["preset"]);
    const bool has_repulsion = object["preset"] == "soleymani-2020-slabs";
    // The start of a soft fluid from its law is a Monte Carlo run.
    if (has_repulsion) object["initial_state"] = "rest";
    const PreparedScene prepared(read(object), 3, 1);
    System system = prepared.start(0);
    const double energy = system.energy_with_surroundings();
    const double inside = system.total_energy();
    const auto integrator = prepared.driven(
        find_method("splitting-energy-reinjection")->make({{"reinject_potential", true}}), 0);
    judge::run(*integrator, system, 0.01, 1, 20);
    EXPECT_NEAR(system.energy_with_surroundings(), energy, 1e-9 * energy);
    if (has_repulsion) {
      EXPECT_NEAR(system.total_energy(), inside, 1e-9 * energy) << "one slab gives what one gets";
    } else {
      EXPECT_GT(std::abs(system.total_energy() - inside), 1e-6 * energy);
    }
  }
}

TEST(WalledScene, RefusesWhatMakesNoSense) {
  const auto changed = [](json object, const char* pointer, const json& value) {
    object[json::json_pointer(pointer)] = value;
    return object;
  };
  expect_refusal(changed(walled_scene(), "/walls/x_uper", json::object()),
                 "walls.x_uper: is no key of walls; did you mean \"x_upper\"?");
  expect_refusal(changed(walled_scene(), "/walls/x_upper/frictoin", 1),
                 "walls.x_upper.frictoin: is no key of a wall; did you mean \"friction\"?");
  expect_refusal(changed(walled_scene(), "/walls/x_upper/friction", -1),
                 "walls.x_upper.friction: is -1; allowed is a number >= 0");
  expect_refusal(
      changed(walled_scene(), "/walls/y_lower", json::object()),
      "walls: has y_lower, a wall at one side of the box alone; allowed is to have y_upper");
  expect_refusal(changed(walled_scene(), "/gravity", {0, -1, 0}),
                 "gravity: is [0, -1, 0]; allowed is a vector along one axis, which has walls");
  expect_refusal(changed(walled_scene(), "/species/0/share", 0.95), "add up to 1.05");
  expect_refusal(changed(walled_scene(), "/species_pairs/0/first", 3),
                 "species_pairs[0].first: is 3; allowed is an integer from 0 to 2");
  expect_refusal(changed(walled_scene(), "/sides", {1, 0, 1}), "sides");
  expect_refusal(changed(slab_scene(), "/heat_slabs/drive", "heatrate"),
                 "did you mean \"heat-rate\"?");
  expect_refusal(changed(slab_scene(), "/heat_slabs/hot/to", 80), "hot slab");
}

/// What would be taken without a word and have no effect, or another one than meant.
TEST(WalledScene, RefusesWhatWouldHaveNoEffect) {
  const auto with = [](json object, const json& more) {
    object.merge_patch(more);
    return object;
  };
  expect_refusal(with(walled_scene(), {{"walls", {{"z_lower", {{"friction", 2}}}}}}),
                 "walls.z_lower.friction: is 2, but a wall without temperature is adiabatic");
  expect_refusal(with(walled_scene(), {{"walls", {{"z_lower", {{"temperature", 2}}}}}}),
                 "walls.z_lower.temperature: is 2, but neither friction nor conduction");
  auto isothermal = walled_scene();
  for (const char* key : {"species", "species_pairs"}) isothermal.erase(key);
  expect_refusal(with(isothermal, {{"isothermal", true}, {"initial_state", "canonical"}}),
                 "walls.x_lower.temperature: is 1.3, but isothermal is true");
  const auto pairs = [&](const json& list) {
    return with(walled_scene(), {{"species_pairs", list}});
  };
  expect_refusal(pairs({{{"first", 0}, {"second", 1}, {"friction", 3}},
                        {{"first", 1}, {"second", 0}, {"friction", 40}}}),
                 "species_pairs[1]: is the pair of species 1 and 0 again");
  expect_refusal(pairs({{{"first", 0}, {"second", 1}}}), "species_pairs[0]: gives no coefficient");
  auto rare = walled_scene();
  rare["species"][0]["share"] = 1e-9;
  expect_refusal(rare, "species[0].share: is 1e-09, of which");
  const auto slabs = [&](const json& more) { return with(slab_scene(), {{"heat_slabs", more}}); };
  expect_refusal(slabs({{"hot_temperature", 2}}), "is of the drive \"temperatures\" alone");
  expect_refusal(slabs({{"rate", nullptr}}), "heat_slabs.rate: is missing");
  expect_refusal(slabs({{"drive", "velocity-exchange"}}), "is of the drive \"heat-rate\" alone");
  expect_refusal(slabs({{"drive", "temperatures"},
                        {"rate", nullptr},
                        {"hot_temperature", 1},
                        {"cold_temperature", 3}}),
                 "heat_slabs.hot_temperature: is 1, not above cold_temperature");
  const auto fluid = [](const json& more) {
    json object = {{"preset", "soft-fluid"}};
    object.merge_patch(more);
    return object;
  };
  expect_refusal(fluid({{"friction_temperature_exponent", 1e6}}), "from -20 to 20");
  expect_refusal(fluid({{"heat_form", "none"}, {"conduction_temperature_exponent", 1}}),
                 "heat_form is \"none\" and nothing conducts");
}

TEST(DrivenScene, GivesWhatItTakesAndGoesOnWithTheSameBits) {
  for (const char* drive : {"heat-rate", "energy-exchange", "velocity-exchange", "temperatures"}) {
    auto object = slab_scene();
    auto& slabs = object["heat_slabs"];
    slabs["drive"] = drive;
    slabs["period"] = 0.02;
    if (slabs["drive"] != "heat-rate") slabs.erase("rate");
    if (slabs["drive"] == "temperatures") {
      slabs["hot_temperature"] = 1.2;
      slabs["cold_temperature"] = 0.8;
    }
    const PreparedScene prepared(read(object), 3, 1);
    const auto make = [&] {
      return prepared.driven(
          find_method("splitting-energy-reinjection")->make({{"reinject_potential", true}}), 0);
    };
    System system = prepared.start(0);
    const double energy = system.energy_with_surroundings();
    const auto integrator = make();
    judge::run(*integrator, system, 0.01, 1, 4);
    const auto saved = integrator->save();
    System other(prepared.fluid(), prepared.box(), system.state(), Noise(3, 0));
    const auto restored = make();
    restored->load(saved);
    judge::run(*integrator, system, 0.01, 4, 9);
    judge::run(*restored, other, 0.01, 4, 9);
    EXPECT_TRUE(judge::same_bits(system.state(), other.state())) << drive;
    EXPECT_NEAR(system.energy_with_surroundings(), energy, 1e-7) << drive;
  }
}

}  // namespace
}  // namespace driftless::testing
