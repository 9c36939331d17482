#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "experiments/answers.hpp"
#include "experiments/campaign.hpp"
#include "experiments/prepared_scene.hpp"
#include "experiments/report.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/study_warnings.hpp"
#include "tests/json_schema.hpp"
#include "tests/scene_reading.hpp"
#include "tests/scratch_folder.hpp"

// Isothermal scenes from the key to the report: what a bath leaves of a result, and what it is
// compared with.
namespace driftless {
namespace {

using nlohmann::json;
using testing::read;
using testing::refusal_of;
using Folder = testing::ScratchFolder;

// ---- Keys. -------------------------------------------------------------------------------------

TEST(IsothermalKey, TakesWhatAPresetHasOfInternalEnergiesAway) {
  for (const auto* preset : {"mackie-1999", "soft-fluid", "two-body", "groot-warren-1997"}) {
    SCOPED_TRACE(preset);
    Scene scene = read({{"preset", preset}, {"isothermal", true}});
    EXPECT_TRUE(scene.fluid.isothermal);
    EXPECT_FALSE(scene.fluid.has_conduction());
    EXPECT_EQ(scene.initial_state, InitialState::canonical);
    const json parameters = scene_parameters(scene);
    for (const auto* key : {"heat_capacity", "heat_form", "conduction", "heat_range",
                            "friction_closure", "initial_temperature"}) {
      EXPECT_FALSE(parameters.contains(key)) << key;
    }
    scene.name = "a name";
    const Scene again = read(to_json(scene));
    EXPECT_EQ(again.fluid, scene.fluid);
    EXPECT_EQ(to_json(again), to_json(scene));
  }
  const Scene back = read({{"preset", "groot-warren-1997"}, {"isothermal", false}});
  EXPECT_EQ(back.initial_state, InitialState::microcanonical);
  EXPECT_EQ(read({{"preset", "mackie-1999"}, {"isothermal", true}, {"initial_state", "rest"}})
                .initial_state,
            InitialState::rest);
}

TEST(IsothermalKey, ThePresetIsThatOfGrootAndWarren) {
  const Scene scene = read({{"preset", "groot-warren-1997"}});
  EXPECT_TRUE(scene.fluid.isothermal);
  EXPECT_EQ(scene.fluid.repulsion, 25);
  EXPECT_EQ(scene.fluid.friction, 4.5);  // sigma^2/(2 k T), sigma = 3
  EXPECT_EQ(scene.fluid.boltzmann * scene.fluid.temperature, 1);
  EXPECT_EQ(scene.density, 3);
}

TEST(IsothermalKey, RefusesWhatHasNoMeaningWithABath) {
  const json bath = {{"preset", "soft-fluid"}, {"isothermal", true}};
  const auto with = [&](const char* key, const json& value) {
    json object = bath;
    object[key] = value;
    return refusal_of(object);
  };
  EXPECT_EQ(
      with("heat_form", "temperature"),
      "scene.json: scene.heat_form: is \"temperature\" but has no effect here, for isothermal "
      "is true and particles have no heat that they could exchange; allowed is to leave it "
      "out");
  EXPECT_EQ(with("heat_capacity", 10),
            "scene.json: scene.heat_capacity: is 10 but has no effect here, for isothermal is true "
            "and particles have no internal energy; allowed is to leave it out");
  EXPECT_NE(with("friction_closure", "friction").find("neither coefficient depends on anything"),
            std::string::npos);
  EXPECT_NE(with("conduction", 1).find("no heat"), std::string::npos);
  EXPECT_NE(with("initial_temperature", 1).find("no internal energy"), std::string::npos);
  EXPECT_EQ(
      with("friction", 0),
      "scene.json: scene.friction: is 0, but friction and its noise are the only contact with "
      "the bath where isothermal is true; allowed is a number > 0");
  EXPECT_EQ(with("initial_state", "microcanonical"),
            "scene.json: scene.initial_state: is \"microcanonical\", the law of isolated systems, "
            "and isothermal is true; allowed is \"canonical\", \"rest\" or \"given\"");
  EXPECT_NE(with("boltzmann", 0).find("nothing fluctuates"), std::string::npos);
  EXPECT_EQ(
      refusal_of({{"preset", "soft-fluid"}, {"initial_state", "canonical"}}),
      "scene.json: scene.initial_state: is \"canonical\", the law of a bath, and isothermal is "
      "false; allowed is \"microcanonical\", \"rest\" or \"given\"");
}

// ---- What is known exactly. --------------------------------------------------------------------

TEST(IsothermalReference, IsTheBathsTemperatureAndMaxwellsLaw) {
  for (const auto* preset : {"mackie-1999", "two-body"}) {
    const Scene scene = read({{"preset", preset}, {"isothermal", true}, {"particles", 40}});
    const PreparedScene prepared(scene, 1, 3);
    EXPECT_EQ(prepared.reference("kinetic_temperature")->value, scene.fluid.temperature);
    EXPECT_EQ(prepared.reference("kinetic_temperature")->error, 0);
    EXPECT_EQ(prepared.reference("momentum_distance")->value, 0);
    for (const auto* name : {"internal_temperature", "internal_energy_mean", "kinetic_share",
                             "internal_energy_distance", "energy_drift"}) {
      EXPECT_FALSE(prepared.reference(name)) << name;
    }
    const bool pairs = scene.layout == Layout::pairs;
    EXPECT_EQ(prepared.reference("pressure").has_value(), !pairs);
    if (!pairs) {
      EXPECT_DOUBLE_EQ(prepared.reference("pressure")->value, 0.5 * 1.1);
    }
    const double degrees = pairs ? 20 : 117;
    EXPECT_DOUBLE_EQ(prepared.energy_per_particle() * 40,
                     degrees / 2 * scene.fluid.boltzmann * scene.fluid.temperature);
  }
}

/// Two particles alone: <psi> and <r F> are quotients of integrals over their distance.
TEST(IsothermalReference, OfTwoRepellingParticlesIsAnIntegral) {
  const Scene scene = read(
      {{"preset", "groot-warren-1997"}, {"particles", 2}, {"density", 0.25}, {"repulsion", 6}});
  const PreparedScene prepared(scene, 3, 2);
  const Fluid fluid(scene.fluid);
  const double volume = prepared.box().volume();
  double weights = volume - 4.0 / 3.0 * M_PI, potential = 0, virial = 0;
  const int points = 20000;
  for (int i = 0; i < points; ++i) {
    const double r = (i + 0.5) / points, psi = fluid.potential(r);
    const double weight = 4 * M_PI * r * r / points * std::exp(-psi);
    weights += weight;
    potential += weight * psi;
    virial += weight * r * fluid.repulsive_force(r);
  }
  // 6 errors: of the chain's some 100 independent looks, estimated with them.
  const auto found = prepared.reference("potential_energy").value();
  EXPECT_NEAR(found.value, 0.5 * potential / weights, 6 * found.error);
  EXPECT_LT(found.error, 0.3 * found.value);
  const auto pressure = prepared.reference("pressure").value();
  EXPECT_NEAR(pressure.value, (2 + virial / weights / 3) / volume, 6 * pressure.error);
  EXPECT_EQ(prepared.reference("configurational_temperature")->value, 1);
  EXPECT_EQ(prepared.reference("configurational_temperature")->error, 0);
}

TEST(IsothermalStart, IsCanonicalAndOfTheLastReplicaHalfAsHot) {
  const Scene scene = read({{"preset", "groot-warren-1997"}, {"particles", 648}});
  const PreparedScene prepared(scene, 1, 3);
  const double thermal = prepared.thermal_kinetic_energy();
  EXPECT_DOUBLE_EQ(thermal, 1.5 * 647);
  for (unsigned replica = 0; replica < 3; ++replica) {
    System system = prepared.start(replica);
    EXPECT_EQ(system.internal_energy(), 0);
    EXPECT_LT(system.momentum().norm(), 1e-11);
    const double share = replica == 2 ? 0.5 : 1;
    // K/kT is Gamma(970.5): 6.1 times its relative width.
    EXPECT_NEAR(system.kinetic_energy() / thermal, share, share * 6.1 / std::sqrt(970.5));
  }
  EXPECT_TRUE(prepared.starts_off_equilibrium(2));
  EXPECT_FALSE(prepared.starts_off_equilibrium(1));
}

TEST(IsothermalRelaxation, IsOfTheKineticEnergyAlone) {
  const Scene scene = read({{"preset", "mackie-1999"}, {"isothermal", true}});
  EXPECT_TRUE(std::isinf(relaxation_time(scene)));
  EXPECT_NEAR(kinetic_relaxation_time(scene), 1.878, 0.001);
}

// ---- A study with isothermal scenes and another. -----------------------------------------------

Study mixed_study() {
  const json study = {
      {"format", "driftless-study/1"},
      {"name", "mixed"},
      {"scenes",
       {{{"preset", "mackie-1999"}, {"particles", 40}, {"name", "isolated"}},
        {{"preset", "mackie-1999"}, {"particles", 40}, {"isothermal", true}, {"name", "bath"}},
        {{"preset", "groot-warren-1997"}, {"particles", 24}, {"name", "soft"}},
        {{"preset", "two-body"}, {"particles", 40}, {"isothermal", true}, {"name", "pairs"}}}},
      {"methods", {"shardlow-s1", "averaged-drift", "avalos-mackie-midpoint"}},
      {"time_steps", {0.01, 0.02}},
      {"duration", {{"equilibrate", 10}, {"measure", 40}, {"sample_every", 0.2}}},
      {"replicas", 3},
      {"seed", 7}};
  return parse_study(study.dump(), "mixed.json");
}

const json& mixed_result() {
  static const json result = [] {
    const Folder folder("isothermal-mixed");
    return run_campaign(mixed_study(), {folder.path(), 2, "driftless run mixed.json", true});
  }();
  return result;
}

const json& cell_of(const std::string& scene, const std::string& method, double time_step) {
  for (const auto& cell : mixed_result()["cells"]) {
    if (cell["scene"] == scene && cell["method"] == method && cell["time_step"] == time_step) {
      return cell;
    }
  }
  throw std::out_of_range(scene);
}

std::set<std::string> observables_of(const std::string& scene) {
  std::set<std::string> names;
  for (const auto& [name, entry] : cell_of(scene, "shardlow-s1", 0.01)["observables"].items()) {
    names.insert(name);
  }
  return names;
}

TEST(MixedStudy, FollowsTheSchema) {
  EXPECT_EQ(schema_errors(result_schema(), mixed_result()), std::vector<std::string>{});
  // Which asks as much as ever of a scene with internal energies, and no more of one without.
  json without = mixed_result();
  without["scenes"][0].erase("relaxation_time");
  EXPECT_NE(schema_errors(result_schema(), without), std::vector<std::string>{});
  json with = mixed_result();
  with["scenes"][1]["relaxation_time"] = 3;
  EXPECT_NE(schema_errors(result_schema(), with), std::vector<std::string>{});
}

TEST(MixedStudy, HasNoObservablesOfEnergiesThatThereAreNot) {
  using Names = std::set<std::string>;
  EXPECT_EQ(observables_of("bath"),
            (Names{"kinetic_temperature", "momentum_distance", "momentum_error", "pressure"}));
  EXPECT_EQ(observables_of("soft"),
            (Names{"kinetic_temperature", "configurational_temperature", "momentum_distance",
                   "momentum_error", "pressure", "potential_energy"}));
  EXPECT_EQ(observables_of("pairs"),
            (Names{"kinetic_temperature", "momentum_distance", "momentum_error"}));
  EXPECT_TRUE(observables_of("isolated").contains("internal_temperature"));
  EXPECT_TRUE(observables_of("isolated").contains("energy_drift"));
  for (const auto* scene : {"bath", "soft", "pairs"}) {
    const auto& cell = cell_of(scene, "shardlow-s1", 0.01);
    EXPECT_EQ(cell["status"], "ok");
    EXPECT_FALSE(cell.contains("energy_trace"));
    EXPECT_TRUE(cell["curves"].contains("momentum"));
    EXPECT_FALSE(cell["curves"].contains("internal_energy"));
    EXPECT_TRUE(cell["observables"]["kinetic_temperature"].contains("exact"));
    EXPECT_EQ(cell["observables"]["kinetic_temperature"]["status"], "ok");
    EXPECT_TRUE(cell["off_equilibrium"]["agrees"]);
  }
  EXPECT_TRUE(cell_of("soft", "shardlow-s1", 0.01)["curves"].contains("radial_distribution"));
}

TEST(MixedStudy, AgreesWithTheExactLaws) {
  for (const auto* scene : {"bath", "soft", "pairs"}) {
    const auto& observables = cell_of(scene, "shardlow-s1", 0.01)["observables"];
    for (const auto* name : {"kinetic_temperature", "momentum_distance"}) {
      const auto& entry = observables[name];
      // Errors from a few replicas: 8 of them, and another one of the distance's own size.
      EXPECT_NEAR(entry["mean"].get<double>(), entry["exact"].get<double>(),
                  8 * entry["error"].get<double>())
          << scene << ' ' << name;
    }
  }
}

TEST(MixedStudy, RefusesMethodsOfInternalEnergiesWhereThereAreNone) {
  EXPECT_EQ(cell_of("isolated", "avalos-mackie-midpoint", 0.01)["status"], "ok");
  const auto& cell = cell_of("bath", "avalos-mackie-midpoint", 0.01);
  EXPECT_EQ(cell["status"], "not_applicable");
  EXPECT_EQ(cell["reason"],
            "avalos-mackie-midpoint is built for particles with internal energies, this scene is "
            "isothermal and has none");
  const auto warnings = study_warnings(mixed_study(), "mixed.json");
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings[0], "avalos-mackie-midpoint does not apply to bath, soft and pairs");
  for (const auto& warning : warnings) {
    EXPECT_EQ(warning.find("internal energies relax"), std::string::npos) << warning;
  }
}

TEST(MixedStudy, AnswersByTheKineticTemperatureWhereItIsAllThereIs) {
  const auto& result = mixed_result();
  const auto& cell = cell_of("bath", "shardlow-s1", 0.02);
  const auto worst = worst_deviation(cell, equilibrium_observable);
  ASSERT_TRUE(worst);
  EXPECT_EQ(worst->bound, cell["observables"]["kinetic_temperature"]["deviation"]["bound"]);
  std::set<std::string> asked;
  for (const auto& answer : result["answers"]) {
    if (answer["scene"] != "bath") continue;
    asked.insert(answer["observable"].get<std::string>());
    if (answer["observable"] != equilibrium_observable) continue;
    EXPECT_EQ(answer["cells_compared"], 4);
    EXPECT_EQ(answer["sentence"].get<std::string>().find(
                  "For bath, to have the kinetic temperature within"),
              0U);
  }
  EXPECT_EQ(asked, (std::set<std::string>{"equilibrium", "kinetic_temperature", "momentum_distance",
                                          "pressure"}));
}

TEST(MixedStudy, IsSummedUpInWordsThatFitEachScene) {
  const std::string text = summary(mixed_result());
  const auto section = [&](const std::string& scene) {
    const auto from = text.find("\n## " + scene);
    return text.substr(from, text.find("\n## ", from + 1) - from);
  };
  EXPECT_NE(section("isolated").find("energy drift"), std::string::npos);
  EXPECT_NE(section("isolated").find("The largest of these errors"), std::string::npos);
  EXPECT_EQ(section("bath").find("energy drift"), std::string::npos);
  EXPECT_EQ(section("bath").find("internal"), std::string::npos);
  EXPECT_NE(section("bath").find("whose kinetic temperature is"), std::string::npos);
  EXPECT_NE(section("bath").find("The error, and in brackets"), std::string::npos);
}

/// A bath warms up what starts at rest; that is no runaway energy, but one that grows without end
/// is.
TEST(IsothermalRuns, MayWarmUpButNotWithoutEnd) {
  json study = {
      {"format", "driftless-study/1"},
      {"scene",
       {{"preset", "two-body"}, {"particles", 2}, {"isothermal", true}, {"initial_state", "rest"}}},
      {"methods", {"marsh-coveney"}},
      {"time_steps", {0.05}},
      {"duration", {{"equilibrate", 5}, {"measure", 100}, {"sample_every", 1}}},
      {"replicas", 4}};
  const auto status = [&](const std::string& name) {
    const Folder folder("isothermal-" + name);
    const auto result =
        run_campaign(parse_study(study.dump(), "s.json"), {folder.path(), 1, "", true});
    return result["cells"][0]["status"].get<std::string>();
  };
  EXPECT_EQ(status("warm"), "ok");
  study["scene"]["friction"] = 45;  // zeta dt/mu = 2.2: an Euler step overshoots
  EXPECT_EQ(status("hot"), "unstable");
}

}  // namespace
}  // namespace driftless
