#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/reproduce/reproduce.hpp"
#include "experiments/reproduce/soleymani_2020.hpp"
#include "experiments/scene_keys.hpp"

/// What is concluded from heat between slabs, from records made up so that the answer is known:
/// once all is as theory has it, once a planted number is wrong.
namespace driftless::reproduce {
namespace {

using nlohmann::json;

constexpr double pi = std::numbers::pi;
const Conditions quick{Effort::quick, 1};
const std::string common = "no repulsion, heat form inverse-temperature";

const Experiment& experiment(const std::string& name) { return *read_experiments({name}).front(); }

json estimate(double mean, double relative_error = 0.005) {
  return {{"mean", mean}, {"error", std::abs(mean) * relative_error}};
}

/// The number behind a word of a part's name.
double number_of(const std::string& part, const std::string& word) {
  return std::stod(part.substr(part.find(word + " ") + word.size() + 1));
}

const Row& row_of(const Outcome& outcome, const std::string& quantity, const std::string& setting) {
  static const Row none{};
  for (const auto& row : outcome.rows) {
    if (row.quantity == quantity && row.setting.starts_with(setting)) return row;
  }
  ADD_FAILURE() << "no row of " << quantity << ", " << setting;
  return none;
}

/// The paper's fluid by hand: m = k = 1, weights (1 - r)^2, noise that does not depend on T.
struct Fluid {
  double density = 3, temperature = 1, friction = 4.5;
  bool by_temperature = false;  ///< lambda = 300 w in place of 300 w/T^2

  double strength() const { return friction / temperature; }
  double conduction() const { return by_temperature ? 300 : 300 / (temperature * temperature); }
  /// 4 pi int w r^2 dr = 2 pi/15, int w r^4 dr = 1/105.
  double collision_rate() const { return density / 3 * strength() * 2 * pi / 15; }
  double heat_rate() const { return density * conduction() * 2 * pi / 15 / 60; }
  double conductivity() const {
    return 2 * pi * density * density / 3 * conduction() / 105 +
           density * 60 * temperature / (collision_rate() + heat_rate()) +
           5 * density * temperature / (6 * collision_rate());
  }
  double viscosity() const {
    return density * temperature / (2 * collision_rate()) +
           2 * pi * density * density / 15 * strength() / 105;
  }
};

TEST(SoleymaniPreset, IsTheSceneOfTheExperiments) {
  const Scene scene = find_preset("soleymani-2020-slabs")->scene;
  const so20::Combination constant{25, HeatForm::inverse_temperature};
  EXPECT_EQ(scene.fluid, so20::fluid_of(constant));
  const auto fluid = so20::box_of(constant, so20::published, {Effort::full, 1});
  EXPECT_LT((scene_box(scene).lengths - fluid.lengths).norm(), 1e-12);
  EXPECT_EQ(scene.density, fluid.density);
  EXPECT_EQ(scene.particles, fluid.particles());
}

// ---- Fig. 4

/// `change` alters what theory says of a part.
template <class Change>
Outcome conductivities(Change&& change) {
  const auto& asked = experiment("soleymani-2020-figure-4");
  Records records;
  for (const auto& part : asked.parts(quick)) {
    Fluid fluid;
    fluid.temperature = number_of(part.name, "T =");
    fluid.density = number_of(part.name, "density");
    fluid.by_temperature = part.name.find("heat form temperature") != std::string::npos;
    const double conductivity = fluid.conductivity() * change(part.name);
    records[part.name] = {{"line",
                           {{"conductivity", estimate(conductivity)},
                            {"density", estimate(fluid.density)},
                            {"middle", estimate(fluid.temperature)}}},
                          {"conduction", estimate(50)},
                          {"heat_diffusion", estimate(0.1)},
                          {"collision_rate", estimate(fluid.collision_rate())}};
  }
  return asked.conclude(quick, records);
}

TEST(SoleymaniFigure4, ConductivitiesAsInTheoryAgreeAndAreNotCalledThePapers) {
  const auto outcome = conductivities([](const std::string&) { return 1.0; });
  int against_theory = 0;
  for (const auto& row : outcome.rows) {
    const bool is_flux = row.quantity.find("heat flux") != std::string::npos;
    EXPECT_EQ(row.verdict, Verdict::agrees) << row.quantity << ", " << row.setting;
    EXPECT_NE(row.paper.has_value(), row.theory.has_value()) << row.quantity;
    if (!row.theory) continue;
    ++against_theory;
    EXPECT_NEAR(row.ours.value, row.theory->value, 1e-9 * row.theory->value) << row.setting;
    EXPECT_EQ(row.theory_text.starts_with("analytic (eq. 17-26)"), !is_flux) << row.theory_text;
  }
  EXPECT_EQ(against_theory, 4 * 8 + 2 * 7 + 6 * 3);
  const auto& hot = row_of(outcome, "thermal conductivity",
                           common + "; isoenergetic-verlet, step 0.01; T = 1.35, density 3");
  EXPECT_NEAR(hot.ours.value, (Fluid{3, 1.35, 4.5, false}.conductivity()), 1e-9);
}

TEST(SoleymaniFigure4, OneWrongConductivityTurnsItsOwnRowsAlone) {
  const auto outcome = conductivities([](const std::string& part) {
    return part == common + ", isoenergetic-verlet, T = 1.35, density 3, flux 6" ? 1.4 : 1.0;
  });
  int wrong = 0;
  for (const auto& row : outcome.rows) wrong += row.verdict == Verdict::differs;
  EXPECT_EQ(wrong, 3);
  const std::string at = common + "; isoenergetic-verlet, step 0.01";
  EXPECT_EQ(row_of(outcome, "thermal conductivity", at + "; T = 1.35").verdict, Verdict::differs);
  const auto& trend =
      row_of(outcome, "conductivity at mean temperature 1.35 / at mean temperature 0.75", at);
  EXPECT_EQ(trend.verdict, Verdict::differs);
  EXPECT_TRUE(trend.explanation.starts_with("+40 %")) << trend.explanation;
  const auto& estimate = row_of(outcome, "thermal conductivity / analytic one", at);
  EXPECT_EQ(estimate.verdict, Verdict::differs);
  EXPECT_NEAR(estimate.ours.value, 1.4, 1e-9);
  EXPECT_NE(estimate.explanation.find("T = 1.35"), std::string::npos) << estimate.explanation;
}

// ---- Fig. 8

Records equilibrium_records() {
  Records records;
  for (const auto& part : experiment("soleymani-2020-figure-8").parts(quick)) {
    Fluid fluid;
    fluid.friction = number_of(part.name, "friction");
    records[part.name] = {{"collision_time", estimate(1 / fluid.collision_rate())},
                          {"diffusion", estimate(1 / fluid.collision_rate())},
                          {"viscosity", estimate(fluid.viscosity())},
                          {"conductivity", estimate(fluid.conductivity())},
                          {"vacf", {{"time", {0, 1}}, {"value", {1, 0.1}}}}};
  }
  return records;
}

Outcome transport(const Records& records) {
  return experiment("soleymani-2020-figure-8").conclude(quick, records);
}

TEST(SoleymaniFigure8, NumbersAsInTheoryAgreeAndAreNotCalledThePapers) {
  const auto outcome = transport(equilibrium_records());
  EXPECT_EQ(outcome.rows.size(), 10U * 5 + 2 * 3);
  for (const auto& row : outcome.rows) {
    EXPECT_EQ(row.verdict, Verdict::agrees) << row.quantity << ", " << row.setting;
    const bool in_words = row.quantity == "collision time x w_0";
    EXPECT_EQ(row.paper.has_value(), in_words) << row.quantity;
    EXPECT_EQ(row.theory.has_value(), !in_words) << row.quantity;
  }
}

TEST(SoleymaniFigure8, AWrongViscosityTurnsWhatItEntersAndNothingElse) {
  auto records = equilibrium_records();
  const std::string cell = common + ", friction 9, isoenergetic-verlet, step 0.01";
  records.at(cell)["viscosity"] = estimate(1.5 * Fluid{3, 1, 9, false}.viscosity());
  const auto outcome = transport(records);
  for (const auto& row : outcome.rows) {
    const bool enters =
        row.setting == cell && (row.quantity == "viscosity" || row.quantity == "Prandtl number" ||
                                row.quantity == "Schmidt number");
    EXPECT_EQ(row.verdict, enters ? Verdict::differs : Verdict::agrees)
        << row.quantity << ", " << row.setting;
    if (enters) {
      EXPECT_TRUE(row.explanation.starts_with("+50 %")) << row.explanation;
    }
  }
}

TEST(SoleymaniFigure8, ACollisionTimeFarFromFrictionsContradictsThePapersSentence) {
  auto records = equilibrium_records();
  const std::string cell = common + ", friction 18, isoenergetic-verlet, step 0.005";
  const double time = 2 / Fluid{3, 1, 18, false}.collision_rate();
  records.at(cell)["collision_time"] = estimate(time);
  const auto outcome = transport(records);
  const auto& sentence = row_of(outcome, "collision time x w_0", "no repulsion");
  EXPECT_EQ(sentence.verdict, Verdict::differs);
  EXPECT_NEAR(sentence.ours.value, 2, 1e-9);
  EXPECT_NE(sentence.explanation.find("friction 18"), std::string::npos) << sentence.explanation;
  EXPECT_EQ(row_of(outcome, "collision time x w_0", "repulsion").verdict, Verdict::agrees);
  EXPECT_EQ(row_of(outcome, "collision time", cell).verdict, Verdict::differs);
  EXPECT_EQ(row_of(outcome, "collision time", common + ", friction 9").verdict, Verdict::agrees);
}

TEST(SoleymaniFigure8, AFrictionThatFailsIsToldAndLeavesTheOthers) {
  auto records = equilibrium_records();
  const std::string cell = common + ", friction 18, isoenergetic-verlet, step 0.005";
  records.at(cell) = {{"failure", "negative internal energy"}};
  const auto outcome = transport(records);
  EXPECT_EQ(outcome.rows.size(), 9U * 5 + 2 * 3);
  EXPECT_NE(row_of(outcome, "Schmidt number at the largest friction / at the smallest",
                   common + "; isoenergetic-verlet, frictions 2.25 to 9")
                .theory,
            std::nullopt);
  bool told = false;
  for (const auto& remark : outcome.remarks) told = told || remark.starts_with(cell + " failed");
  EXPECT_TRUE(told);
}

// ---- Fig. 2, 3

/// Temperatures that fall from 1.2 beside the hot slab to 0.8 beside the cold one. Of an ideal
/// fluid the density is 3/T if `balanced`, else 3 everywhere.
Outcome profiles(bool balanced) {
  const auto& asked = experiment("soleymani-2020-figures-2-3");
  Records records;
  for (const auto& part : asked.parts(quick)) {
    json profile = {{"z", json::array()},
                    {"density", json::array()},
                    {"internal", json::array()},
                    {"kinetic", json::array()}};
    for (double z = 0.25; z < 14; z += 0.5) {
      const double t = 1 + 0.2 * std::sin(2 * pi * z / 14);
      profile["z"].push_back(z);
      profile["density"].push_back(estimate(balanced ? 3 / t : 3));
      profile["internal"].push_back(estimate(t));
      profile["kinetic"].push_back(estimate(t));
    }
    const auto half = [&](double t) {
      Fluid fluid{3 / t, t};
      fluid.by_temperature = part.name.find("heat form temperature") != std::string::npos;
      return json{{"density", estimate(3 / t)},
                  {"middle", estimate(t)},
                  {"conductivity", estimate(fluid.conductivity())}};
    };
    records[part.name] = {{"profile", profile},
                          {"lines", {{"hot", half(1.1)}, {"cold", half(0.9)}}}};
  }
  return asked.conclude(quick, records);
}

TEST(SoleymaniFigures23, AnIdealFluidHasOnePressureAndTheCurvatureOfTheory) {
  const std::string pressure = "p_ideal hot/cold: density x kinetic temperature";
  const auto outcome = profiles(true);
  for (const char* method : {"isoenergetic-verlet", "shardlow-s1"}) {
    const auto at = common + "; " + method;
    EXPECT_EQ(row_of(outcome, pressure, at).verdict, Verdict::agrees);
    EXPECT_NEAR(row_of(outcome, pressure, at).ours.value, 1, 1e-9);
    EXPECT_LT(row_of(outcome, "density hot/cold", at).ours.high, 0.8);
    const auto& halves = row_of(outcome, "conductivity of the hot half / of the cold half", at);
    EXPECT_EQ(halves.verdict, Verdict::agrees);
    EXPECT_NEAR(halves.ours.value,
                (Fluid{3 / 1.1, 1.1}.conductivity() / Fluid{3 / 0.9, 0.9}.conductivity()), 1e-9);
  }
  EXPECT_EQ(row_of(profiles(false), pressure, common).verdict, Verdict::differs);
}

// ---- Fig. 5, 6

Outcome crossings(double sum, const Conditions& conditions = quick) {
  const auto& asked = experiment("soleymani-2020-figures-5-6");
  Records records;
  for (const auto& part : asked.parts(conditions)) {
    json crossed;
    for (const auto& key : flux::crossed_keys()) crossed[key] = estimate(1);
    const bool planted = part.name == common + ", isoenergetic-verlet, conduction 100";
    crossed["sum by laws"] = estimate(planted ? sum : 6);
    records[part.name] = {{"crossed", crossed}};
  }
  return asked.conclude(conditions, records);
}

TEST(SoleymaniFigures56, ASumThatIsNotTheImposedFluxIsADifference) {
  for (const double sum : {6.0, 6.5}) {
    const auto outcome = crossings(sum);
    int agree = 0, differ = 0;
    for (const auto& row : outcome.rows) {
      agree += row.verdict == Verdict::agrees;
      differ += row.verdict == Verdict::differs;
    }
    EXPECT_EQ(agree + differ, 14);
    EXPECT_EQ(differ, sum == 6 ? 0 : 1);
  }
}

TEST(SoleymaniFigures56, AnotherMethodIsComparedAndNotExplainedAsThePapers) {
  const auto speaks_of_paper = [](const Outcome& outcome) {
    for (const auto& row : outcome.rows) {
      if (row.explanation.find("this method does not") != std::string::npos) return true;
    }
    return false;
  };
  EXPECT_TRUE(speaks_of_paper(crossings(6)));
  const Conditions chosen{Effort::quick, 1, MethodChoice{"shardlow-s1", {}}};
  const auto outcome = crossings(6, chosen);
  EXPECT_FALSE(speaks_of_paper(outcome));
  int compared = 0;
  for (const auto& row : outcome.rows) compared += row.verdict == Verdict::agrees;
  EXPECT_EQ(compared, 10) << "without the contrast, which is the same";
}

TEST(SoleymaniFigures23, ARepulsionThatAMethodDoesNotRunIsLeftToTheContrast) {
  const auto& asked = experiment("soleymani-2020-figures-2-3");
  const auto count = [&](const char* method) {
    const Conditions chosen{Effort::quick, 1, MethodChoice{method, {}}};
    std::size_t of_method = 0;
    for (const auto& part : asked.parts(chosen)) of_method += part.name.ends_with(method);
    return std::pair(of_method, asked.parts(chosen).size());
  };
  EXPECT_EQ(count("averaged-drift"), (std::pair<std::size_t, std::size_t>(4, 10)));
  EXPECT_EQ(count("peters"), (std::pair<std::size_t, std::size_t>(6, 12)));
  EXPECT_EQ(count("shardlow-s1"), (std::pair<std::size_t, std::size_t>(6, 6)));
}

}  // namespace
}  // namespace driftless::reproduce
