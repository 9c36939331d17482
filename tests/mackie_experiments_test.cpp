#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/reproduce/mackie_roll.hpp"
#include "experiments/reproduce/reproduce.hpp"

/// What the experiments of Mackie, Bonet Avalos, Navas (1999) conclude, from records made up so
/// that the answer is known.
namespace driftless::reproduce {
namespace {

using nlohmann::json;

const Conditions quick{Effort::quick, 1};
constexpr double boltzmann = 0.5, phi = 50, wall_temperature = 1.1;
constexpr double particles = 30000;

const std::string explicit_scheme = "avalos-mackie-explicit:own_products=true";

template <class Record>
Outcome outcome_of(const std::string& name, Record&& record, const Conditions& conditions = quick) {
  const auto& asked = *read_experiments({name}).front();
  Records records;
  for (const auto& part : asked.parts(conditions)) records[part.name] = record(part.name);
  return asked.conclude(conditions, records);
}

const Row& row_of(const Outcome& outcome, const std::string& quantity, const std::string& setting) {
  for (const auto& row : outcome.rows) {
    if (row.quantity.starts_with(quantity) && row.setting.starts_with(setting)) return row;
  }
  throw std::out_of_range("no row " + quantity + " of " + setting);
}

// Distributions of momentum and internal energy.

constexpr std::size_t bins = 240;
constexpr double shape = 101;

/// Equally likely bins with a little scatter, the first tenth of them too full by `excess`.
json blocks(std::size_t seed, double excess) {
  json all = json::array();
  for (std::size_t block = 0; block < 16; ++block) {
    std::vector<std::uint64_t> counts;
    for (std::size_t bin = 0; bin < bins; ++bin) {
      const double wobble = std::sin(1e3 * static_cast<double>(bin + bins * block + 7 * seed + 1));
      const double share = bin < bins / 10 ? 1 + excess : 1 - excess / 9;
      counts.push_back(static_cast<std::uint64_t>(1e5 * share + 100 * wobble));
    }
    all.push_back(counts);
  }
  return all;
}

/// Samples of <p^2>, <u> and <u^2> over the law's, u of a variance that is off by `excess`.
json distributions(double excess) {
  json moments = json::array();
  for (int sample = 0; sample < 200; ++sample) {
    const double wobble = 1e-4 * std::sin(1e3 * sample + 1);
    moments.push_back(1 + wobble);
    moments.push_back(shape);
    moments.push_back(shape * shape + shape * (1 + excess + wobble));
  }
  return {{"momentum", blocks(1, 0)}, {"energy", blocks(2, excess)}, {"moments", moments}};
}

Outcome figures_1_2(double excess) {
  return outcome_of("mackie-1999-figures-1-2", [=](const std::string& part) {
    return distributions(part == explicit_scheme + ", step 0.01" ? excess : 0);
  });
}

TEST(MackieFigures1And2, TheLawAgrees) {
  const auto outcome = figures_1_2(0);
  for (const auto& row : outcome.rows) {
    const bool compared = row.paper.has_value();
    EXPECT_EQ(row.verdict == Verdict::agrees, compared) << row.quantity << ", " << row.setting;
  }
  const auto& distance = row_of(outcome, "Kullback-Leibler distance, u", "avalos-mackie-explicit");
  EXPECT_NEAR(distance.ours.value, 0, 1e-7);
}

TEST(MackieFigures1And2, AVarianceThatIsOffIsADifference) {
  const auto outcome = figures_1_2(0.03);
  const std::string explicit_one = explicit_scheme + ", step 0.01";
  for (const char* quantity : {"variance of u over", "largest deviation of the density, u"}) {
    const auto& row = row_of(outcome, quantity, explicit_one);
    EXPECT_EQ(row.verdict, Verdict::differs) << quantity;
    EXPECT_NEAR(row.ours.value, 3, 0.1) << quantity;
    EXPECT_EQ(row_of(outcome, quantity, "avalos-mackie-implicit").verdict, Verdict::agrees);
  }
  EXPECT_EQ(row_of(outcome, "largest deviation of the density, mom", explicit_one).verdict,
            Verdict::agrees);
  EXPECT_EQ(row_of(outcome, "variance of u less that of p", explicit_one).verdict, Verdict::agrees);
  // (1/2) sum (share - law)^2/law.
  const auto& distance = row_of(outcome, "Kullback-Leibler distance, u", explicit_one);
  EXPECT_NEAR(distance.ours.value, 0.5 * (0.1 * 0.03 * 0.03 + 0.9 * std::pow(0.03 / 9, 2)), 1e-6);
}

// Cooling, then warming.

/// Down to `least` at t* = 1, then to the walls' temperature with a time constant.
json course(double least, double time_constant) {
  json record = {{"time", json::array()},
                 {"kinetic", json::array()},
                 {"internal", json::array()},
                 {"inverse", json::array()}};
  for (int n = 0; n <= 1200; ++n) {
    const double time = 0.1 * n;
    const double temperature =
        time < 1
            ? 1 + (least - 1) * time
            : wall_temperature - (wall_temperature - least) * std::exp(-(time - 1) / time_constant);
    record["time"].push_back(time);
    record["kinetic"].push_back(1.5 * particles * boltzmann * temperature);
    record["internal"].push_back(particles * phi * temperature);
    record["inverse"].push_back(1 / temperature);
  }
  return record;
}

TEST(MackieFigure3, FindsTheCoolingAndTheWarming) {
  // 0.99 of 1.1 is reached after 25 ln(0.12/0.011) = 60.
  const auto outcome =
      outcome_of("mackie-1999-figure-3", [](const std::string&) { return course(0.98, 25); });
  const std::string setting = explicit_scheme + ", walls on 6 faces";
  for (const char* quantity :
       {"least internal temperature <theta>", "least internal temperature 1/<1/theta>",
        "time of the least", "time to stay within 1 %"}) {
    EXPECT_EQ(row_of(outcome, quantity, setting).verdict, Verdict::agrees) << quantity;
  }
  EXPECT_NEAR(row_of(outcome, "least internal temperature <", setting).ours.value, 0.98, 1e-9);
  EXPECT_NEAR(row_of(outcome, "time of the least", setting).ours.value, 1, 1e-9);
  EXPECT_NEAR(row_of(outcome, "time constant", setting).ours.value, 25, 1e-6);
  EXPECT_NEAR(row_of(outcome, "time to stay", setting).ours.value, 1 + 25 * std::log(0.12 / 0.011),
              0.1);
  EXPECT_NEAR(row_of(outcome, "kinetic less internal", setting).ours.value, 0, 1e-9);
}

TEST(MackieFigure3, ACoolingThatIsTooDeepOrAWarmingThatIsTooSoonIsADifference) {
  const auto outcome = outcome_of("mackie-1999-figure-3", [](const std::string& part) {
    return part.starts_with("shardlow-s1") ? course(0.95, 10) : course(0.98, 25);
  });
  for (const char* quantity : {"least internal temperature <theta>", "time to stay within 1 %"}) {
    EXPECT_EQ(row_of(outcome, quantity, "shardlow-s1").verdict, Verdict::differs) << quantity;
    EXPECT_EQ(row_of(outcome, quantity, "avalos-mackie").verdict, Verdict::agrees) << quantity;
  }
  EXPECT_EQ(row_of(outcome, "time of the least", "shardlow-s1").verdict, Verdict::agrees);
}

// Pressure on the walls, closed boxes, books.

/// A series in which the walls are pushed at a rate and `made` energy comes out of nothing a step.
json series(double push_rate, double bulk, double temperature, double particle_count, double made) {
  json columns;
  for (int n = 0; n <= 160; ++n) {
    const double wobble = 1e-3 * std::sin(1e3 * n + 1), time = 0.5 * n;
    columns["time"].push_back(time);
    columns["kinetic"].push_back(1.5 * particle_count * boltzmann * temperature * (1 + wobble));
    columns["internal"].push_back(particle_count * phi * temperature + made * n -
                                  1.5 * particle_count * boltzmann * temperature * wobble);
    columns["potential"].push_back(0);
    columns["inverse"].push_back((1 + wobble) / temperature);
    columns["pushed"].push_back(push_rate * time * (1 + 1e-3 * wobble));
    columns["bulk"].push_back(bulk * (1 + wobble));
    for (int face = 0; face < 6; ++face) {
      columns["heat_" + std::to_string(face)].push_back(0);
    }
  }
  return columns;
}

/// Boxes with the paper's pressure, an ideal gas in the middle; a closed one at a temperature.
Outcome walls(double pressure, double closed_temperature, double made,
              const Conditions& conditions = quick) {
  return outcome_of(
      "mackie-1999-walls",
      [=](const std::string& part) {
        const double side = std::cbrt(particles), inner = side - 5;
        const bool two = part.find("on 2 faces") != part.npos;
        if (part.starts_with("closed box")) {
          const double count = 2000;
          json record = series(0, 0, closed_temperature, count, 0);
          if (part.ends_with("B = 0.1")) {
            for (auto& inverse : record["inverse"]) inverse = 1.25;
            for (auto& kinetic : record["kinetic"]) kinetic = 1.5 * count * boltzmann * 0.8;
          }
          return record;
        }
        if (part.starts_with("books")) return series(0, 0, 1, 300, made);
        const double area = (two ? 2 : 6) * side * side;
        const double volume = two ? inner * side * side : std::pow(inner, 3);
        return series(pressure * boltzmann * area, volume, wall_temperature, particles, 0);
      },
      conditions);
}

TEST(MackieWalls, ThePapersPressureAgrees) {
  const auto outcome = walls(1.137, 1 / 1.025, 0);
  const std::string setting = explicit_scheme + ", walls of range 1.24";
  const auto& pressure = row_of(outcome, "wall pressure", setting);
  EXPECT_NEAR(pressure.ours.value, 1.137, 1e-3);
  EXPECT_EQ(pressure.verdict, Verdict::agrees);
  // (phi + 5 k/2) T = phi, but for 1/N.
  const auto& closed = row_of(outcome, "final kinetic temperature", "closed box");
  EXPECT_EQ(closed.verdict, Verdict::agrees);
  EXPECT_NEAR(closed.theory->value, 1 / 1.025, 1e-4);
  EXPECT_FALSE(closed.paper);
  EXPECT_EQ(row_of(outcome, "final internal temperature", "closed box").verdict, Verdict::agrees);
  const auto& books = row_of(outcome, "largest energy of a step", "shardlow-s1");
  EXPECT_EQ(books.verdict, Verdict::agrees);
}

TEST(MackieWalls, WhatIsWrongIsADifference) {
  const auto outcome = walls(1.1, 0.99, 1e-6);
  const std::string setting = explicit_scheme + ", walls of range 1.24";
  EXPECT_EQ(row_of(outcome, "wall pressure", setting).verdict, Verdict::differs);
  EXPECT_EQ(row_of(outcome, "final kinetic temperature", "closed box").verdict, Verdict::differs);
  EXPECT_EQ(row_of(outcome, "final internal temperature", "closed box").verdict, Verdict::differs);
  const auto& books = row_of(outcome, "largest energy of a step", "shardlow-s1");
  EXPECT_EQ(books.verdict, Verdict::differs);
  EXPECT_NEAR(books.ours.value, 1e-6 / (boltzmann * wall_temperature), 1e-8);
  EXPECT_EQ(row_of(outcome, "largest energy of a step", "avalos-mackie-explicit").verdict,
            Verdict::ours_alone);
}

TEST(MackieWalls, AnotherMethodIsComparedAndNotExplainedAsThePapers) {
  const auto explained = [](const Outcome& outcome, const std::string& words) {
    for (const auto& row : outcome.rows) {
      if (row.explanation.find(words) != std::string::npos) return true;
    }
    return false;
  };
  EXPECT_TRUE(explained(walls(1.137, 1 / 1.025, 1e-6), "proportional to the step"));
  const Conditions drifting{Effort::quick, 1, MethodChoice{"averaged-drift", {}}};
  const auto outcome = walls(1.137, 1 / 1.025, 1e-6, drifting);
  EXPECT_FALSE(explained(outcome, "proportional to the step"));
  EXPECT_EQ(row_of(outcome, "wall pressure", "averaged-drift, walls of range 1.24").verdict,
            Verdict::agrees);
  EXPECT_EQ(row_of(outcome, "wall pressure", "averaged-drift, hard walls").verdict,
            Verdict::agrees);
  for (const auto& row : outcome.rows) {
    EXPECT_EQ(row.setting.find(explicit_scheme), std::string::npos) << row.setting;
  }
}

TEST(MackieWalls, AClosedBoxThatFailsIsTold) {
  const Conditions conditions{Effort::quick, 1, MethodChoice{"averaged-drift", {}}};
  const auto outcome = outcome_of(
      "mackie-1999-walls",
      [](const std::string& part) {
        if (part == "closed box, averaged-drift, B = 0.1") return json{{"failure", "made up"}};
        return series(1, 1, 1, part.starts_with("closed") ? 2000 : particles, 0);
      },
      conditions);
  const auto& row = row_of(outcome, "final", "closed box, averaged-drift, B = 0.1");
  EXPECT_EQ(row.verdict, Verdict::not_resolved);
  EXPECT_EQ(row.explanation, "made up");
}

// The convection roll.

struct MadeRoll {
  double flow;             ///< psi_0
  double in, out, change;  ///< of energy, per time
};

/// Three hundred samples, and a section whose mass flow has the stream function psi_0 sin sin.
json roll_record(const MadeRoll& made) {
  json series;
  for (int n = 0; n < 300; ++n) {
    const double time = 10.0 * n, wobble = std::sin(1e3 * n + 1);
    series["time"].push_back(time);
    series["roll"].push_back(made.flow + 0.01 * wobble);
    series["kinetic"].push_back(1000 + 0.25 * made.change * time);
    series["internal"].push_back(5000 + 0.75 * made.change * time);
    series["potential"].push_back(0);
    series["hot"].push_back(-made.in * time + wobble);
    series["cold"].push_back(made.out * time + wobble);
  }
  constexpr int cells = 10;
  const double wave = std::numbers::pi / cells, speed = made.flow * std::numbers::pi / roll_side();
  json quantities;
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const double x = wave * (column + 0.5), z = wave * (row + 0.5);
      quantities["number_density"]["values"].push_back(1);
      quantities["velocity_x"]["values"].push_back(speed * std::sin(x) * std::cos(z));
      quantities["velocity_z"]["values"].push_back(-speed * std::cos(x) * std::sin(z));
      quantities["velocity_z"]["errors"].push_back(1e-4);
      quantities["internal_temperature"]["values"].push_back(1.9 - 0.02 * column);
    }
  }
  return {{"series", series},
          {"fields", {{"bins", {cells, 1, cells}}, {"quantities", quantities}}}};
}

Outcome figures_4_6(const MadeRoll& made) {
  return outcome_of("mackie-1999-figures-4-6", [&](const std::string& part) -> json {
    if (part.starts_with("temperatures")) return {{"failure", "made up"}};
    return roll_record(made);
  });
}

TEST(MackieFigures4To6, ARollUpAlongTheHotWallIsSeen) {
  const auto outcome = figures_4_6({-1.2, 50, 50, 0});
  const auto& flow = row_of(outcome, "mass flow around", "hot left wall");
  EXPECT_EQ(flow.verdict, Verdict::agrees);
  EXPECT_NEAR(flow.ours.value, -1.2, 1e-3);
  EXPECT_NEAR(row_of(outcome, "largest stream", "hot left wall").ours.value, -1.2, 0.02);
  EXPECT_NEAR(row_of(outcome, "fall of the internal", "hot left wall").ours.value, 0.2, 1e-12);
  EXPECT_NEAR(row_of(outcome, "Nusselt", "hot left wall").ours.value, 1, 0.01);
  const auto& out = row_of(outcome, "heat flux out", "hot left wall");
  EXPECT_EQ(out.verdict, Verdict::agrees);
  EXPECT_NEAR(out.ours.value, 50 * roll_side() / 13000, 1e-3);
}

TEST(MackieFigures4To6, NoRollIsNotResolvedAndTheWrongSenseDiffers) {
  const auto verdict = [](double flow, const char* setting) {
    return row_of(figures_4_6({flow, 50, 50, 0}), "mass flow around", setting).verdict;
  };
  EXPECT_EQ(verdict(0, "hot left wall"), Verdict::not_resolved);
  EXPECT_EQ(verdict(0, "hot floor"), Verdict::not_resolved);
  EXPECT_EQ(verdict(1.2, "hot left wall"), Verdict::differs);
  EXPECT_EQ(verdict(1.2, "hot floor"), Verdict::agrees);
}

TEST(MackieFigures4To6, HeatThatTheFluidGivesOffIsTold) {
  const auto outcome = figures_4_6({-1.2, 50, 75, -25});
  const auto& out = row_of(outcome, "heat flux out", "hot left wall");
  EXPECT_EQ(out.verdict, Verdict::differs);
  const auto change = fmt::format("{:+.4f}", -25 * roll_side() / 13000);
  EXPECT_NE(out.explanation.find(change), std::string::npos) << out.explanation;
}

}  // namespace
}  // namespace driftless::reproduce
