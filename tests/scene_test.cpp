#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "experiments/location.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/study.hpp"
#include "tests/scene_reading.hpp"

namespace driftless {
namespace {

using nlohmann::json;
using testing::read;
using testing::refusal_of;

TEST(Presets, have_the_published_parameters) {
  const Scene mackie = read({{"preset", "mackie-1999"}});
  EXPECT_EQ(mackie.fluid.boltzmann, 0.5);
  EXPECT_EQ(mackie.fluid.heat_capacity, 50);  // B = k/phi = 0.01
  EXPECT_EQ(mackie.fluid.conduction, 17 * mackie.fluid.heat_capacity);
  EXPECT_EQ(mackie.fluid.temperature, 1.1);
  EXPECT_EQ(mackie.fluid.friction_range, 1.24);
  EXPECT_EQ(mackie.fluid.heat_range, 1.24);
  EXPECT_EQ(mackie.fluid.friction_closure, FrictionClosure::friction);
  EXPECT_FALSE(mackie.fluid.has_repulsion());
  EXPECT_EQ(mackie.density, 1);

  const Scene soft = read({{"preset", "soft-fluid"}});
  EXPECT_EQ(soft.fluid.repulsion, 25);
  EXPECT_EQ(soft.density, 3);
  EXPECT_EQ(soft.fluid.friction, 4.5);
  EXPECT_EQ(soft.fluid.heat_capacity, 60);
  EXPECT_EQ(soft.fluid.friction_closure, FrictionClosure::noise);

  const Scene pairs = read({{"preset", "two-body"}});
  EXPECT_EQ(pairs.layout, Layout::pairs);
  EXPECT_TRUE(pairs.frozen);
  EXPECT_NEAR(Fluid(pairs.fluid).friction_weight(pairs.pair_distance), 0.5, 0.02);
}

TEST(Presets, make_boxes_of_at_least_two_ranges_and_start_at_their_temperature) {
  for (const auto& preset : presets()) {
    SCOPED_TRACE(preset.name);
    const Scene& scene = preset.scene;
    const Fluid fluid(scene.fluid);
    const Box box =
        make_box(fluid, scene.layout, scene.particles, scene.density, scene.pair_distance);
    EXPECT_GE(box.lengths.minCoeff(), 2 * fluid.range());
    EXPECT_EQ(scene.initial_temperature, scene.fluid.temperature);
    EXPECT_EQ(scene.preset, preset.name);
    EXPECT_FALSE(preset.title.empty());
    EXPECT_FALSE(preset.source.empty());
  }
}

// 2 m a/(density zeta_0 [w]) with [w] = 2 pi r^3/15.
TEST(RelaxationTime, of_friction_alone_is_the_derived_one) {
  const Scene mackie = read({{"preset", "mackie-1999"}, {"heat_form", "none"}});
  const double volume = 2 * std::numbers::pi * std::pow(1.24, 3) / 15;
  EXPECT_NEAR(relaxation_time(mackie), 2 * 101 / volume, 1e-9 * 250);
  EXPECT_NEAR(relaxation_time(mackie), 253, 1);
  const Scene soft = read({{"preset", "soft-fluid"}, {"heat_form", "none"}});
  EXPECT_NEAR(relaxation_time(soft), 21.6, 0.1);
}

TEST(RelaxationTime, of_both_adds_their_rates_and_forgets_the_form_of_conduction) {
  const Scene both = read({{"preset", "mackie-1999"}});
  const Scene friction = read({{"preset", "mackie-1999"}, {"heat_form", "none"}});
  const Scene conduction = read({{"preset", "mackie-1999"}, {"friction", 0}});
  const Scene other_form = read({{"preset", "mackie-1999"}, {"heat_form", "temperature"}});
  EXPECT_NEAR(1 / relaxation_time(both),
              1 / relaxation_time(friction) + 1 / relaxation_time(conduction), 1e-12);
  // density L_0 [w]/(phi T^2)
  const double volume = 2 * std::numbers::pi * std::pow(1.24, 3) / 15;
  EXPECT_NEAR(1 / relaxation_time(conduction), 17 * volume / (1.1 * 1.1), 1e-9);
  EXPECT_NEAR(relaxation_time(other_form), relaxation_time(both), 1e-12);
}

TEST(RelaxationTime, integrates_any_weight) {
  // int_0^1 (1 - r)^s 4 pi r^2 dr by the midpoint rule.
  for (const double exponent : {0.5, 1.0, 2.0, 3.5}) {
    double volume = 0;
    const int points = 200000;
    for (int i = 0; i < points; ++i) {
      const double r = (i + 0.5) / points;
      volume += 4 * std::numbers::pi * r * r * std::pow(1 - r, exponent) / points;
    }
    const Scene scene =
        read({{"preset", "soft-fluid"}, {"heat_form", "none"}, {"weight_exponent", exponent}});
    EXPECT_NEAR(relaxation_time(scene), 2 * 61 / (3 * 4.5 * volume), 1e-4) << exponent;
  }
}

TEST(RelaxationTime, of_pairs_is_that_of_their_slower_motion) {
  // Friction: m/(4 zeta w), conduction: phi T^2/(2 L w), alike for the preset.
  const double weight = 0.49;
  EXPECT_NEAR(relaxation_time(read({{"preset", "two-body"}})), 1 / (4 * weight), 1e-12);
  EXPECT_NEAR(relaxation_time(read({{"preset", "two-body"}, {"friction", 0.1}})),
              1 / (0.4 * weight), 1e-12);
  EXPECT_NEAR(relaxation_time(read({{"preset", "two-body"}, {"conduction", 10}})),
              50 / (20 * weight), 1e-12);
  EXPECT_NEAR(relaxation_time(read({{"preset", "two-body"}, {"heat_form", "none"}})),
              1 / (4 * weight), 1e-12);
}

TEST(RelaxationTime, is_infinite_where_nothing_acts) {
  const Scene scene = read({{"preset", "mackie-1999"}, {"heat_form", "none"}, {"friction", 0}});
  EXPECT_EQ(relaxation_time(scene), std::numeric_limits<double>::infinity());
}

TEST(Overrides, of_boltzmann_keep_the_heat_capacity_in_its_units) {
  const Scene scene = read({{"preset", "mackie-1999"}, {"boltzmann", 0.25}});
  EXPECT_EQ(scene.fluid.heat_capacity, 25);
  EXPECT_EQ(to_json(scene)["heat_capacity"], 100);
  const Scene both = read({{"preset", "mackie-1999"}, {"boltzmann", 2}, {"heat_capacity", 3}});
  EXPECT_EQ(both.fluid.heat_capacity, 6);
}

TEST(Overrides, without_boltzmann_keep_the_heat_capacity_itself) {
  const json rest = {{"preset", "mackie-1999"}, {"boltzmann", 0}, {"initial_state", "rest"}};
  EXPECT_EQ(read(rest).fluid.heat_capacity, 50);
  EXPECT_EQ(to_json(read(rest))["heat_capacity"], 50);
  json given = rest;
  given["heat_capacity"] = 7;
  EXPECT_EQ(read(given).fluid.heat_capacity, 7);
}

TEST(Overrides, of_the_heat_form_convert_the_conduction_at_the_temperature) {
  const json form = {{"preset", "mackie-1999"}, {"heat_form", "temperature"}};
  EXPECT_DOUBLE_EQ(read(form).fluid.conduction, 850 / 1.21);
  json hotter = form;
  hotter["temperature"] = 2;
  EXPECT_DOUBLE_EQ(read(hotter).fluid.conduction, 850.0 / 4);
  json given = form;
  given["conduction"] = 3;
  EXPECT_EQ(read(given).fluid.conduction, 3);
  EXPECT_EQ(read({{"preset", "mackie-1999"}, {"temperature", 2}}).fluid.conduction, 850);
}

TEST(Overrides, of_velocities_imply_a_given_start) {
  const Scene spread = read({{"preset", "mackie-1999"}, {"initial_velocity_spread", 0.3}});
  EXPECT_EQ(spread.initial_state, InitialState::given);
  EXPECT_EQ(spread.initial_temperature, 1.1);
  const Scene listed = read({{"preset", "two-body"},
                             {"boltzmann", 0},
                             {"particles", 2},
                             {"initial_velocities", {{1, 0, 0}, {-1, 0, 0}}},
                             {"initial_temperature", 3}});
  EXPECT_EQ(listed.initial_state, InitialState::given);
  EXPECT_EQ(listed.initial_velocities[1], Vector(-1, 0, 0));
  EXPECT_EQ(listed.initial_temperature, 3);
}

TEST(SceneAsJson, reads_back_to_every_bit) {
  const std::vector<json> scenes = {
      {{"preset", "mackie-1999"}},
      {{"preset", "mackie-1999"}, {"heat_form", "temperature"}, {"temperature", 0.7}},
      {{"preset", "mackie-1999"}, {"boltzmann", 0}, {"initial_state", "rest"}},
      {{"preset", "soft-fluid"}, {"initial_velocity_spread", 0.1}, {"frame_velocity", {1, 2, 0.1}}},
      {{"preset", "two-body"}, {"pair_distance", 0.123}, {"conduction", 1.0 / 3}},
      {{"preset", "two-body"}, {"particles", 2}, {"initial_velocities", {{1, 0, 0}, {0.1, 0, 0}}}},
      {{"preset", "mackie-1999"}, {"frozen", true}, {"friction", 0}, {"heat_form", "none"}},
  };
  for (const auto& written : scenes) {
    SCOPED_TRACE(written.dump());
    Scene scene = read(written);
    scene.name = "a name";
    const Scene again = read(to_json(scene));
    EXPECT_EQ(again.fluid, scene.fluid);
    EXPECT_EQ(again.initial_velocities, scene.initial_velocities);
    EXPECT_EQ(again.initial_state, scene.initial_state);
    EXPECT_EQ(again.initial_temperature, scene.initial_temperature);
    EXPECT_EQ(to_json(again), to_json(scene));
  }
}

TEST(SceneAsJson, keeps_the_heat_capacity_as_written_for_any_boltzmann) {
  std::size_t quotients_that_differ = 0;
  for (int i = 1; i < 2000; ++i) {
    const double k = i / 1000.0, ratio = 3 + i % 97;
    Scene scene = read({{"preset", "mackie-1999"}, {"boltzmann", k}, {"heat_capacity", ratio}});
    scene.name = "a name";
    if (scene.fluid.heat_capacity / k != ratio) ++quotients_that_differ;
    ASSERT_EQ(to_json(scene)["heat_capacity"], ratio) << i;
    ASSERT_EQ(read(to_json(scene)).fluid.heat_capacity, scene.fluid.heat_capacity) << i;
  }
  EXPECT_GT(quotients_that_differ, 0u);
}

TEST(BoxCheck, names_the_smallest_number_that_fits) {
  EXPECT_NE(refusal_of({{"preset", "mackie-1999"}, {"particles", 15}}).find("at least 16"),
            std::string::npos);
  EXPECT_EQ(refusal_of({{"preset", "mackie-1999"}, {"particles", 16}}), "");
  // 3 (2 r)^3 = 24 exactly.
  EXPECT_NE(refusal_of({{"preset", "soft-fluid"}, {"particles", 23}}).find("at least 24"),
            std::string::npos);
  EXPECT_EQ(refusal_of({{"preset", "soft-fluid"}, {"particles", 24}}), "");
}

TEST(SceneTable, has_a_meaning_and_a_range_for_every_key) {
  std::set<std::string> names;
  for (const auto& key : scene_keys()) {
    EXPECT_TRUE(names.insert(std::string(key.name)).second) << key.name;
    EXPECT_FALSE(key.meaning.empty()) << key.name;
    EXPECT_FALSE(key.rule.allowed().empty()) << key.name;
    EXPECT_FALSE(key.rule.schema().empty()) << key.name;
  }
  EXPECT_EQ(names.size(), 37u);
}

}  // namespace
}  // namespace driftless
