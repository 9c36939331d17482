#include "model/equation_of_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/small_system.hpp"

namespace driftless::testing {
namespace {

struct Named {
  const char* name;
  EquationOfState state;
};

/// A solid's: the heat capacity rises from 2 to 30 around the temperature 1.
std::vector<StatePoint> rising_points() {
  std::vector<StatePoint> points;
  for (const double theta : {0.1, 0.2, 0.3, 0.5, 0.6, 0.9, 1.0, 1.3, 2.0, 3.5}) {
    points.push_back({theta, 2 * theta + 28 * theta * theta * theta / (1 + theta * theta)});
  }
  return points;
}

/// Heat capacities that jump from interval to interval by factors of up to 1000.
const std::vector<StatePoint> rough_points = {{0.5, 0.01}, {0.6, 10},    {1, 10.1},
                                              {1.01, 30},  {1.5, 30.01}, {2, 31}};

std::vector<Named> all_forms() {
  return {{"constant", EquationOfState::constant_heat_capacity(12)},
          {"linear", EquationOfState::linear_heat_capacity(12, 7, 1.1)},
          {"table", EquationOfState::table(rising_points())},
          {"rough table", EquationOfState::table(rough_points)},
          {"table of two", EquationOfState::table({{0.5, 3}, {2, 21}})},
          {"reservoir", EquationOfState::reservoir(1.3)}};
}

/// Energies from far below to far above the tables.
std::vector<double> energies() {
  std::vector<double> all;
  for (double u = 1e-3; u < 2e3; u *= 1.1) all.push_back(u);
  return all;
}

/// The largest relative error of d(entropy)/du = 1/temperature, by central differences of 1e-5 u.
/// Theirs is (1e-5 u/(c theta))^2 in smooth stretches and half of 1e-5 u |d(1/theta)/du| beside a
/// bend of a table; of all forms here below 1e-7.
template <class Entropy, class Temperature>
double slope_error(Entropy&& entropy, Temperature&& temperature) {
  double worst = 0;
  for (const double u : energies()) {
    const double h = 1e-5 * u;
    const double slope = (entropy(u + h) - entropy(u - h)) / (2 * h);
    worst = std::max(worst, std::abs(slope * temperature(u) - 1));
  }
  return worst;
}

TEST(EquationOfState, HasTheInverseTemperatureAsSlopeOfTheEntropy) {
  for (const auto& [name, state] : all_forms()) {
    SCOPED_TRACE(name);
    const auto& one = state;
    const double error = slope_error([&](double u) { return one.entropy(u); },
                                     [&](double u) { return one.temperature(u); });
    EXPECT_LT(error, 1e-7);
  }
}

// The test of that test: an entropy whose heat capacity changes a hundredth too slowly.
TEST(EquationOfState, WithTheEntropyOfAnotherOneIsSeen) {
  const auto state = EquationOfState::linear_heat_capacity(12, 7, 1.1);
  const auto other = EquationOfState::linear_heat_capacity(12, 6.93, 1.1);
  EXPECT_GT(slope_error([&](double u) { return other.entropy(u); },
                        [&](double u) { return state.temperature(u); }),
            1e-4);
}

TEST(EquationOfState, HasAnEntropyThatRisesAndIsConcave) {
  for (const auto& [name, state] : all_forms()) {
    SCOPED_TRACE(name);
    double entropy = -std::numeric_limits<double>::infinity(), temperature = 0;
    for (const double u : energies()) {
      EXPECT_GT(state.entropy(u), entropy) << u;
      EXPECT_GT(state.temperature(u), 0) << u;
      EXPECT_TRUE(state.is_reservoir() || state.temperature(u) > temperature) << u;
      entropy = state.entropy(u);
      temperature = state.temperature(u);
    }
  }
}

TEST(EquationOfState, HasTheSlopeOfTheTemperatureAsInverseHeatCapacity) {
  for (const auto& [name, state] : all_forms()) {
    SCOPED_TRACE(name);
    for (const double u : energies()) {
      const double h = 1e-5 * u;
      const double slope = (state.temperature(u + h) - state.temperature(u - h)) / (2 * h);
      EXPECT_NEAR(slope, state.inverse_heat_capacity(u), 1e-6 * (1 + slope)) << u;
    }
  }
}

TEST(EquationOfState, HasTheEnergyOfATemperatureAsInverse) {
  for (const auto& [name, state] : all_forms()) {
    SCOPED_TRACE(name);
    if (state.is_reservoir()) continue;
    for (const double u : energies()) {
      // A flat stretch of the table makes 1e-16 of theta 1e-13 of u.
      EXPECT_NEAR(state.internal_energy(state.temperature(u)) / u, 1, 1e-12) << u;
    }
  }
  const auto bath = EquationOfState::reservoir(1.3);
  EXPECT_EQ(bath.temperature(bath.internal_energy(1.3)), 1.3);
  EXPECT_GT(bath.internal_energy(1.3), 0);
}

TEST(EquationOfState, GainsTheDifferenceOfTheEntropies) {
  for (const auto& [name, state] : all_forms()) {
    SCOPED_TRACE(name);
    for (const double u : energies()) {
      for (const double share : {-0.999, -0.6, -0.1, 0.2, 3.0, 1000.0}) {
        const double from = state.entropy(u), to = state.entropy(u + share * u);
        EXPECT_NEAR(state.entropy_gain(u, share * u), to - from,
                    1e-13 * (std::abs(from) + std::abs(to)) + 1e-11 * std::abs(to - from))
            << u << " and its share " << share;
      }
    }
  }
}

// A gain below rounding is its energy over the temperature: s(u + g) - s(u) = g/theta (1 - g/(2 c
// theta)), with c theta >= 1e-5 u in the roughest table.
TEST(EquationOfState, GainsSmallEntropiesToRounding) {
  for (const auto& [name, state] : all_forms()) {
    SCOPED_TRACE(name);
    for (const double u : energies()) {
      for (const double gain : {1e-18 * u, -1e-18 * u, 1e-25 * u}) {
        EXPECT_NEAR(state.entropy_gain(u, gain) * state.temperature(u) / gain, 1, 1e-11) << u;
      }
    }
  }
}

TEST(EquationOfState, GainsSmallEntropiesAcrossThePointsOfATable) {
  const auto points = rising_points();
  const auto state = EquationOfState::table(points);
  for (const auto& point : points) {
    for (const double share : {1e-9, 1e-12, 1e-15}) {
      const double below = point.internal_energy * (1 - share);
      const double gain = point.internal_energy * (1 + share) - below;
      // to 1e-8 in the temperature on the way, and to the rounding of the piece's temperature
      EXPECT_NEAR(state.entropy_gain(below, gain) * point.temperature / gain, 1, 1e-8);
      EXPECT_NEAR(state.entropy_gain(below + gain, -gain) * point.temperature / gain, -1, 1e-8);
    }
  }
}

TEST(EquationOfState, OfConstantHeatCapacityIsTheClosedForm) {
  const auto state = EquationOfState::constant_heat_capacity(12);
  EXPECT_TRUE(state.has_constant_heat_capacity());
  for (const double u : energies()) {
    EXPECT_EQ(state.temperature(u), u * (1 / 12.0));
    EXPECT_EQ(state.inverse_heat_capacity(u), 1 / 12.0);
    EXPECT_EQ(state.entropy(u), 12 * std::log(u));
  }
  EXPECT_EQ(state.internal_energy(1.1), 12 * 1.1);
  EXPECT_EQ(EquationOfState::linear_heat_capacity(12, 0, 3), state);
  EXPECT_FALSE(EquationOfState::linear_heat_capacity(12, 1, 3).has_constant_heat_capacity());
}

TEST(EquationOfState, OfLinearHeatCapacityHasItsValueAndSlope) {
  const auto state = EquationOfState::linear_heat_capacity(12, 7, 1.1);
  for (const double theta : {1e-3, 0.5, 1.1, 4.0, 1e3}) {
    const double u = (12 - 7 * 1.1) * theta + 3.5 * theta * theta;
    EXPECT_NEAR(state.temperature(u) / theta, 1, 1e-14);
    EXPECT_NEAR(state.internal_energy(theta) / u, 1, 1e-14);
    EXPECT_NEAR(1 / state.inverse_heat_capacity(u), 12 + 7 * (theta - 1.1), 1e-12 * (1 + theta));
  }
}

TEST(EquationOfState, OfAReservoirKeepsItsTemperature) {
  const auto state = EquationOfState::reservoir(1.3);
  EXPECT_TRUE(state.is_reservoir());
  for (const double u : {-5.0, 0.0, 1e-9, 7.0, 1e9}) {
    EXPECT_EQ(state.temperature(u), 1.3);
    EXPECT_EQ(state.inverse_heat_capacity(u), 0);
    EXPECT_EQ(state.entropy_gain(u, 2.6), 2.6 * (1 / 1.3));
    EXPECT_EQ(state.entropy_gain(u, -1e-30), -1e-30 * (1 / 1.3));
  }
}

TEST(EquationOfState, OfATableGoesThroughItsPoints) {
  for (const auto& points : {rising_points(), rough_points}) {
    const auto state = EquationOfState::table(points);
    for (const auto& point : points) {
      EXPECT_NEAR(state.temperature(point.internal_energy) / point.temperature, 1, 1e-13);
      EXPECT_NEAR(state.internal_energy(point.temperature) / point.internal_energy, 1, 1e-12);
    }
  }
}

/// s(to) - s(from) by quadrature of du/theta, between bends by pieces.
double integrated(const EquationOfState& state, const std::vector<StatePoint>& points, double from,
                  double to) {
  std::vector<double> borders{from};
  for (std::size_t n = 0; n < points.size(); ++n) {
    borders.push_back(points[n].internal_energy);
    if (n + 1 == points.size()) break;
    borders.push_back(
        state.internal_energy(0.5 * (points[n].temperature + points[n + 1].temperature)));
  }
  borders.push_back(to);
  double sum = 0;
  for (std::size_t n = 0; n + 1 < borders.size(); ++n) {
    sum += boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
        [&](double u) { return 1 / state.temperature(u); }, borders[n], borders[n + 1], 10, 1e-13);
  }
  return sum;
}

TEST(EquationOfState, OfATableHasTheIntegralOfItsInverseTemperatureAsEntropy) {
  for (const auto& points : {rising_points(), rough_points}) {
    const auto state = EquationOfState::table(points);
    const double from = 0.3 * points.front().internal_energy;
    const double to = 4 * points.back().internal_energy;
    EXPECT_NEAR(state.entropy_gain(from, to - from) / integrated(state, points, from, to), 1,
                1e-11);
  }
}

TEST(EquationOfState, OfATableOfAConstantOrLinearHeatCapacityIsThatOne) {
  for (const double slope : {0.0, 7.0}) {
    const auto exact = EquationOfState::linear_heat_capacity(12, slope, 1.1);
    std::vector<StatePoint> points;
    for (const double theta : {0.5, 0.8, 0.9, 1.4, 2.0}) {
      points.push_back({theta, exact.internal_energy(theta)});
    }
    const auto state = EquationOfState::table(points);
    for (double theta = 0.5; theta < 2; theta += 0.01) {
      const double u = exact.internal_energy(theta);
      EXPECT_NEAR(state.temperature(u), theta, 1e-13);
      EXPECT_NEAR(state.inverse_heat_capacity(u), exact.inverse_heat_capacity(u), 1e-13);
      EXPECT_NEAR(state.entropy_gain(7.0, u - 7), exact.entropy_gain(7.0, u - 7), 1e-12);
    }
  }
}

/// The largest error of the energy of a table with that many intervals over [0.5, 2].
double table_error(int intervals) {
  const auto energy = [](double theta) { return 2 * theta + theta * theta * theta * theta; };
  std::vector<StatePoint> points;
  for (int n = 0; n <= intervals; ++n) {
    const double theta = 0.5 + 1.5 * n / intervals;
    points.push_back({theta, energy(theta)});
  }
  const auto state = EquationOfState::table(points);
  double worst = 0;
  for (double theta = 0.5; theta < 2; theta += 1e-3) {
    worst = std::max(worst, std::abs(state.internal_energy(theta) - energy(theta)));
  }
  return worst;
}

TEST(EquationOfState, OfATableComesCloserByTheThirdPowerOfItsIntervals) {
  EXPECT_NEAR(std::log2(table_error(20) / table_error(40)), 3, 0.3);
  EXPECT_LT(table_error(40), 2e-4);  // of 20
}

TEST(EquationOfState, OfATableGoesOnAtConstantHeatCapacityBeyondItsEnds) {
  const auto points = rising_points();
  const auto state = EquationOfState::table(points);
  const double first = points.front().internal_energy, last = points.back().internal_energy;
  const double theta = points.front().temperature;
  for (const double u : {1e-300, 1e-9, 0.5 * first}) {
    EXPECT_EQ(state.inverse_heat_capacity(u), 1 / (first / theta));
    EXPECT_NEAR(state.temperature(u) / (u * theta / first), 1, 1e-15);
  }
  for (const double u : {1.1 * last, 1e3 * last}) {
    EXPECT_EQ(state.inverse_heat_capacity(u), state.inverse_heat_capacity(last));
  }
}

TEST(EquationOfState, HoldsAtExtremeEnergies) {
  for (const auto& [name, state] : all_forms()) {
    SCOPED_TRACE(name);
    for (const double u : {1e-300, 1e-100, 1e100, 1e300}) {
      EXPECT_TRUE(std::isfinite(state.temperature(u))) << u;
      EXPECT_GT(state.temperature(u), 0) << u;
      EXPECT_TRUE(std::isfinite(state.entropy(u))) << u;
      EXPECT_TRUE(std::isfinite(state.entropy_gain(u, 0.5 * u))) << u;
      EXPECT_EQ(state.entropy_gain(u, 0.0), 0) << u;
    }
    if (state.is_reservoir()) continue;
    EXPECT_LE(state.temperature(0.0), 0);
    EXPECT_LE(state.temperature(-3.0), 0);
  }
}

TEST(EquationOfState, GivesLanesWhatItGivesOneEnergy) {
  Uniform uniform(3);
  for (const auto& [name, state] : all_forms()) {
    SCOPED_TRACE(name);
    for (int round = 0; round < 300; ++round) {
      std::vector<double> u(Lanes::count()), gain(Lanes::count());
      for (std::size_t n = 0; n < u.size(); ++n) {
        u[n] = std::exp(uniform(-7, 7));
        gain[n] = u[n] * uniform(-0.9, 2);
      }
      const Lanes lanes = Lanes::load(u.data()), gains = Lanes::load(gain.data());
      std::vector<double> temperature(u.size()), inverse(u.size()), entropy(u.size());
      std::vector<double> gained(u.size());
      state.temperature(lanes).store(temperature.data());
      state.inverse_heat_capacity(lanes).store(inverse.data());
      state.entropy(lanes).store(entropy.data());
      state.entropy_gain(lanes, gains).store(gained.data());
      for (std::size_t n = 0; n < u.size(); ++n) {
        EXPECT_NEAR(temperature[n] / state.temperature(u[n]), 1, 1e-15);
        EXPECT_NEAR(inverse[n], state.inverse_heat_capacity(u[n]), 1e-15 * inverse[n]);
        EXPECT_NEAR(entropy[n], state.entropy(u[n]), 1e-13 * (1 + std::abs(entropy[n])));
        EXPECT_NEAR(gained[n], state.entropy_gain(u[n], gain[n]),
                    1e-13 * (1 + std::abs(gained[n])));
      }
    }
  }
}

/// The message of a refusal; empty if nothing is refused.
template <class Make>
std::string refusal(Make&& make) {
  try {
    make();
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}
std::string refusal_of_table(const std::vector<StatePoint>& points) {
  return refusal([&] { EquationOfState::table(points); });
}

TEST(EquationOfState, RefusesATableByTheOffendingPoint) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto of = [](const char* number, const char* values, const char* complaint) {
    return std::string("point ") + number + " of the equation of state (" + values +
           ") is refused: " + complaint;
  };
  EXPECT_EQ(refusal_of_table({{1, 2}, {2, 3}, {2, 4}}),
            of("3", "temperature 2, internal energy 4",
               "its temperature is not above 2, that of the point before it"));
  EXPECT_EQ(refusal_of_table({{1, 2}, {2, 1.5}, {3, 4}}),
            of("2", "temperature 2, internal energy 1.5",
               "its internal energy is not above 2, that of the point before it, so that the heat "
               "capacity between them is not above 0"));
  EXPECT_EQ(refusal_of_table({{0, 2}, {2, 3}}),
            of("1", "temperature 0, internal energy 2", "its temperature is not above 0"));
  EXPECT_EQ(refusal_of_table({{1, -2}, {2, 3}}),
            of("1", "temperature 1, internal energy -2", "its internal energy is not above 0"));
  EXPECT_EQ(
      refusal_of_table({{1, 2}, {2, infinity}}),
      of("2", "temperature 2, internal energy inf", "its internal energy is not a finite number"));
  EXPECT_EQ(
      refusal_of_table({{1, 2}, {std::nan(""), 3}}),
      of("2", "temperature nan, internal energy 3", "its temperature is not a finite number"));
  EXPECT_EQ(refusal_of_table({{1, 2}, {1 + 1e-15, 1e300}}),
            of("2", "temperature 1, internal energy 1e+300",
               "the heat capacity from the point before it is inf"));
  EXPECT_EQ(refusal_of_table({{1, 2}}), "an equation of state has 1 points, at least 2 are needed");
  EXPECT_EQ(refusal_of_table({{1, 2}, {2, 3}}), "");
}

TEST(EquationOfState, RefusesHeatCapacitiesThatAreNotAboveZero) {
  EXPECT_EQ(refusal([] { EquationOfState::constant_heat_capacity(0); }),
            "heat_capacity is 0, allowed is > 0");
  EXPECT_EQ(refusal([] { EquationOfState::constant_heat_capacity(std::nan("")); }),
            "heat_capacity is nan, allowed is > 0");
  EXPECT_EQ(refusal([] { EquationOfState::reservoir(-1); }), "temperature is -1, allowed is > 0");
  for (const double slope : {-0.1, 6.0, 7.0}) {
    EXPECT_EQ(refusal([&] {
                EquationOfState::linear_heat_capacity(12, slope, 2);
              }).find("heat_capacity_slope is "),
              0U);
  }
  EXPECT_EQ(refusal([] { EquationOfState::linear_heat_capacity(12, 5.9, 2); }), "");
  EXPECT_EQ(refusal([] { EquationOfState::linear_heat_capacity(-12, 5.9, 2); }),
            "heat_capacity is -12, allowed is > 0");
  EXPECT_EQ(refusal([] { EquationOfState::linear_heat_capacity(12, 5.9, 0); }),
            "temperature is 0, allowed is > 0");
}

}  // namespace
}  // namespace driftless::testing
