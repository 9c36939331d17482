#include "model/initial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/random/gamma_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "model/system.hpp"
#include "tests/small_system.hpp"

// Statistical bounds are 6.5 standard errors (false-alarm rate 8e-11 each) or quantiles of chi^2
// beyond 1e-10; less than 100 comparisons in all.
namespace driftless::testing {
namespace {

constexpr double bound = 6.5;

Fluid fluid_with(double heat_capacity, double boltzmann = 0.5) {
  FluidParameters f;
  f.boltzmann = boltzmann;
  f.mass = 1.25;
  f.heat_capacity = heat_capacity;
  f.friction = 1;
  return Fluid(f);
}

// ---- One check of a way to draw, by name of what is broken. ------------------------------------

using Draw = std::function<void(const Fluid&, Layout, double energy, const Noise&, State&)>;
using Complaints = std::set<std::string>;

/// Shares of an island's energy in one draw.
struct Shares {
  double kinetic = 0, first = 0, second = 0;  ///< K/E, u_1/E, u_2/E
  double square = 0;                          ///< p_x^2/(2 m E (1 - 1/n)) of the first
};

Shares shares(const Fluid& fluid, const State& s, std::size_t begin, std::size_t end,
              double energy) {
  Shares found;
  for (std::size_t i = begin; i < end; ++i) {
    found.kinetic += 0.5 * fluid.mass() * s.velocity[i].squaredNorm() / energy;
  }
  found.first = s.internal_energy[begin] / energy;
  found.second = s.internal_energy[begin + 1] / energy;
  const double one_less = 1 - 1 / static_cast<double>(end - begin);
  found.square =
      fluid.mass() * s.velocity[begin][0] * s.velocity[begin][0] / (2 * energy * one_less);
  return found;
}

/// chi^2 over 128 bins of equal probability under Beta(a, b).
bool has_beta_law(const std::vector<double>& x, double a, double b) {
  const boost::math::beta_distribution<double> law(a, b);
  std::vector<double> count(128, 0.0);
  for (const double z : x) {
    if (!(z >= 0 && z <= 1)) return false;
    ++count[static_cast<std::size_t>(std::min(127.0, 128 * boost::math::cdf(law, z)))];
  }
  const double expected = static_cast<double>(x.size()) / 128;
  double sum = 0;
  for (const double c : count) sum += (c - expected) * (c - expected) / expected;
  const boost::math::chi_squared chi_squared(127);
  return sum < boost::math::quantile(boost::math::complement(chi_squared, 1e-10));
}

/// Mean and variance of Beta(a, b), with the variance's error from the fourth moment.
bool has_beta_moments(const std::vector<double>& x, double a, double b) {
  const boost::math::beta_distribution<double> law(a, b);
  const double n = static_cast<double>(x.size());
  const double mean = boost::math::mean(law), variance = boost::math::variance(law);
  double sum = 0, squares = 0;
  for (const double z : x) {
    sum += (z - mean) / n;
    squares += (z - mean) * (z - mean) / n;
  }
  const double spread = variance * std::sqrt(boost::math::kurtosis(law) - 1);
  return std::abs(sum) < bound * std::sqrt(variance / n) &&
         std::abs(squares - variance) < bound * spread / std::sqrt(n);
}

/// Everything asked of a draw from the microcanonical law of islands of `n` particles.
Complaints check(const Draw& draw, Layout layout, std::size_t n, double heat_capacity) {
  const Fluid fluid = fluid_with(heat_capacity);
  const double energy = 40, shape = heat_capacity / 0.5 + 1;
  const double kinetic = layout == Layout::pairs ? 0.5 : 1.5 * static_cast<double>(n - 1);
  const double total = kinetic + static_cast<double>(n) * shape;
  const std::size_t particles = layout == Layout::pairs ? 400 : n;
  const std::size_t draws = 30000 * n / particles;
  Complaints complaints;
  std::vector<double> k, u, square;
  double product = 0;
  for (std::size_t replica = 0; replica < draws; ++replica) {
    State state = place(Box{Vector::Constant(9)}, layout, Placement::lattice, particles, 0.5,
                        Noise(5, replica));
    draw(fluid, layout, energy, Noise(5, replica), state);
    for (std::size_t begin = 0; begin < particles; begin += n) {
      const auto s = shares(fluid, state, begin, begin + n, energy);
      double sum = s.kinetic;
      Vector momentum = Vector::Zero();
      for (std::size_t i = begin; i < begin + n; ++i) {
        sum += state.internal_energy[i] / energy;
        momentum += state.velocity[i];
      }
      if (std::abs(sum - 1) > 1e-13) complaints.insert("energy");
      if (momentum.norm() > 1e-12) complaints.insert("momentum");
      k.push_back(s.kinetic);
      u.push_back(s.first);
      square.push_back(s.square);
      product += (s.first - shape / total) * (s.second - shape / total);
    }
  }
  if (!has_beta_law(k, kinetic, total - kinetic)) complaints.insert("law of K");
  if (!has_beta_law(u, shape, total - shape)) complaints.insert("law of u");
  if (!has_beta_law(square, 0.5, total - 0.5)) complaints.insert("law of p");
  if (!has_beta_moments(k, kinetic, total - kinetic)) complaints.insert("moments of K");
  if (!has_beta_moments(u, shape, total - shape)) complaints.insert("moments of u");
  // Dirichlet covariance of two shares; the product's spread is at most about that of Var u.
  const double covariance = -shape * shape / (total * total * (total + 1));
  const double variance = shape * (total - shape) / (total * total * (total + 1));
  const double samples = static_cast<double>(u.size());
  if (std::abs(product / samples - covariance) > 2 * bound * variance / std::sqrt(samples)) {
    complaints.insert("covariance of u");
  }
  return complaints;
}

TEST(Microcanonical, DrawsFollowTheExactLaw) {
  for (const double heat_capacity : {1.5, 25.0}) {
    EXPECT_EQ(check(draw_microcanonical, Layout::fluid, 3, heat_capacity), Complaints{});
    EXPECT_EQ(check(draw_microcanonical, Layout::fluid, 8, heat_capacity), Complaints{});
    EXPECT_EQ(check(draw_microcanonical, Layout::pairs, 2, heat_capacity), Complaints{});
  }
}

TEST(MicrocanonicalFaults, AreSeen) {
  const auto fluid_draw = [](const Draw& faulty) { return check(faulty, Layout::fluid, 4, 1.5); };
  // Internal energies of one shape less, as if the weight were the entropy's exponent alone.
  const auto lower_shape =
      fluid_draw([](const Fluid&, Layout layout, double energy, const Noise& noise, State& state) {
        draw_microcanonical(fluid_with(1.0), layout, energy, noise, state);
      });
  EXPECT_TRUE(lower_shape.count("law of u"));
  EXPECT_TRUE(lower_shape.count("law of K"));
  EXPECT_TRUE(lower_shape.count("moments of K"));
  // Kinetic and internal energies each scaled to their means: another ensemble.
  const auto apart = fluid_draw(
      [](const Fluid& f, Layout layout, double energy, const Noise& noise, State& state) {
        draw_microcanonical(f, layout, energy, noise, state);
        const auto law = microcanonical_law(f, layout, state.size());
        double kinetic = 0;
        for (const auto& v : state.velocity) kinetic += 0.5 * f.mass() * v.squaredNorm();
        const double wanted = law.kinetic_energy(energy);
        for (auto& v : state.velocity) v *= std::sqrt(wanted / kinetic);
        for (auto& u : state.internal_energy) u *= (energy - wanted) / (energy - kinetic);
      });
  EXPECT_TRUE(apart.count("law of K"));
  EXPECT_FALSE(apart.count("energy"));
  // No scaling to the prescribed energy: a canonical draw.
  EXPECT_TRUE(fluid_draw([](const Fluid& f, Layout layout, double energy, const Noise& noise,
                            State& state) {
                auto stream = noise.particle_stream(99, Purpose::monte_carlo);
                const double shape = microcanonical_law(f, layout, state.size()).total_shape();
                boost::random::gamma_distribution<double> gamma(shape, energy / shape);
                draw_microcanonical(f, layout, gamma(stream), noise, state);
              }).count("energy"));
  EXPECT_TRUE(fluid_draw([](const Fluid& f, Layout layout, double energy, const Noise& noise,
                            State& state) {
                draw_microcanonical(f, layout, energy, noise, state);
                std::swap(state.velocity[0], state.velocity[1]);
                state.velocity[0] *= -1;
              }).count("momentum"));
  // Two particles alike: each has its law, together they have not.
  EXPECT_TRUE(fluid_draw([](const Fluid& f, Layout layout, double energy, const Noise& noise,
                            State& state) {
                draw_microcanonical(f, layout, energy, noise, state);
                state.internal_energy[1] = state.internal_energy[0];
              }).count("covariance of u"));
  EXPECT_TRUE(check(draw_off_equilibrium, Layout::fluid, 4, 1.5).count("law of u"));
}

TEST(Microcanonical, DrawsDependOnSeedReplicaAndIdNotOnStorage) {
  const Fluid fluid = fluid_with(5);
  const auto draw = [&](const Noise& noise, bool swapped) {
    State state = place(small_box(), Layout::fluid, Placement::random, 10, 0, Noise(1, 1));
    if (swapped) std::swap(state.id[2], state.id[7]);
    draw_microcanonical(fluid, Layout::fluid, 50, noise, state);
    return state;
  };
  const State one = draw(Noise(1, 1), false);
  EXPECT_TRUE(same_bits(one, draw(Noise(1, 1), false)));
  EXPECT_NE(one.internal_energy, draw(Noise(1, 2), false).internal_energy);
  EXPECT_NE(one.internal_energy, draw(Noise(2, 1), false).internal_energy);
  const State swapped = draw(Noise(1, 1), true);
  EXPECT_NEAR(swapped.internal_energy[2], one.internal_energy[7], 1e-13);
  EXPECT_LT((swapped.velocity[7] - one.velocity[2]).norm(), 1e-13);
}

// ---- The formulas of the law. ------------------------------------------------------------------

TEST(MicrocanonicalLaw, HasTheMomentsOfTheBetaLaw) {
  for (const double heat_capacity : {1.5, 25.0}) {
    for (const std::size_t n : {3U, 10U, 3000U}) {
      const auto law = microcanonical_law(fluid_with(heat_capacity), Layout::fluid, n);
      const double a = heat_capacity / 0.5 + 1, kinetic = 1.5 * static_cast<double>(n - 1);
      const double total = kinetic + static_cast<double>(n) * a;
      EXPECT_DOUBLE_EQ(law.total_shape(), total);
      const boost::math::beta_distribution<double> u(a, total - a), k(kinetic, total - kinetic);
      const double e = 70;
      EXPECT_NEAR(law.internal_energy_mean(e) / (e * boost::math::mean(u)), 1, 1e-13);
      EXPECT_NEAR(law.internal_energy_variance(e) / (e * e * boost::math::variance(u)), 1, 1e-12);
      EXPECT_NEAR(law.internal_energy_skewness() / boost::math::skewness(u), 1, 1e-11);
      EXPECT_NEAR(law.kinetic_energy(e) / (e * boost::math::mean(k)), 1, 1e-13);
      EXPECT_NEAR(law.kinetic_temperature(e),
                  law.kinetic_energy(e) / (0.5 * 3 * static_cast<double>(n - 1) * 0.5), 1e-12 * e);
      EXPECT_NEAR(law.kinetic_temperature(law.energy_at(1.3)), 1.3, 1e-13);
      EXPECT_NEAR(law.kinetic_temperature(e) / law.internal_temperature(e), (total - 1) / total,
                  1e-13);
    }
  }
}

// Independent of the drawing under test: gamma variates divided by their sum, <1/theta> averaged.
TEST(MicrocanonicalLaw, HasTheInternalTemperatureOfAMonteCarloAverage) {
  for (const auto layout : {Layout::fluid, Layout::pairs}) {
    const std::size_t n = layout == Layout::pairs ? 2 : 4;
    const double heat_capacity = 1.5, k = 0.5, energy = 12;
    const auto law = microcanonical_law(fluid_with(heat_capacity), layout, n);
    boost::random::gamma_distribution<double> kinetic(layout == Layout::pairs ? 0.5 : 4.5);
    boost::random::gamma_distribution<double> internal(heat_capacity / k + 1);
    Uniform uniform(12);
    double sum = 0, squares = 0;
    constexpr double samples = 300000;
    for (int draw = 0; draw < samples; ++draw) {
      const double first = internal(uniform.engine());
      double all = first + kinetic(uniform.engine());
      for (std::size_t i = 1; i < n; ++i) all += internal(uniform.engine());
      const double inverse_temperature = heat_capacity * all / (energy * first);
      sum += inverse_temperature / samples;
      squares += inverse_temperature * inverse_temperature / samples;
    }
    const double error = std::sqrt((squares - sum * sum) / samples);
    EXPECT_LT(std::abs(sum - 1 / law.internal_temperature(energy)), bound * error);
    EXPECT_GT(std::abs(sum - 1 / law.kinetic_temperature(energy)), bound * error);
  }
}

TEST(MicrocanonicalLaw, OfPairsIsThatOfIslandsOfTwoWithOneDegree) {
  const auto law = microcanonical_law(fluid_with(5), Layout::pairs, 60);
  EXPECT_EQ(law.islands, 30U);
  EXPECT_EQ(law.particles, 2U);
  EXPECT_EQ(law.degrees, 1);
  EXPECT_DOUBLE_EQ(law.total_shape(), 0.5 + 2 * 11);
  const auto fluid = microcanonical_law(fluid_with(5), Layout::fluid, 60);
  EXPECT_EQ(fluid.islands, 1U);
  EXPECT_EQ(fluid.particles, 60U);
  EXPECT_EQ(fluid.degrees, 3 * 59);
}

// ---- Several species. --------------------------------------------------------------------------

Fluid two_species() {
  auto f = fluid_with(1.5).parameters();
  f.further_species = {{.mass = 5, .heat_capacity = 6}};
  return Fluid(f);
}

/// Everything asked of draws of one particle of the first species and two of the second.
Complaints check_species(const Draw& draw) {
  const Fluid fluid = two_species();
  const double energy = 40, shapes[] = {4, 13, 13}, masses[] = {1.25, 5, 5};
  const double total = 3 + 4 + 13 + 13;
  std::vector<double> kinetic, u[2], square[2];
  Complaints complaints;
  for (std::uint64_t replica = 0; replica < 30000; ++replica) {
    State state = place(small_box(), Layout::fluid, Placement::lattice, 3, 0, Noise(5, replica));
    state.species = {0, 1, 1};
    draw(fluid, Layout::fluid, energy, Noise(5, replica), state);
    double k = 0, internal = 0;
    Vector momentum = Vector::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      k += 0.5 * masses[i] * state.velocity[i].squaredNorm();
      internal += state.internal_energy[i];
      momentum += masses[i] * state.velocity[i];
    }
    if (std::abs(k + internal - energy) > 1e-12) complaints.insert("energy");
    if (momentum.norm() > 1e-12) complaints.insert("momentum");
    kinetic.push_back(k / energy);
    for (const std::size_t i : {0U, 1U}) {
      u[i].push_back(state.internal_energy[i] / energy);
      const double x = state.velocity[i][0];
      square[i].push_back(0.5 * masses[i] * x * x / energy / (1 - masses[i] / 11.25));
    }
  }
  if (!has_beta_law(kinetic, 3, total - 3)) complaints.insert("law of K");
  for (const std::size_t i : {0U, 1U}) {
    if (!has_beta_law(u[i], shapes[i], total - shapes[i])) complaints.insert("law of u");
    if (!has_beta_moments(u[i], shapes[i], total - shapes[i])) complaints.insert("moments of u");
    if (!has_beta_law(square[i], 0.5, total - 0.5)) complaints.insert("law of p");
  }
  return complaints;
}

TEST(Microcanonical, DrawsOfSpeciesFollowTheExactLaw) {
  EXPECT_EQ(check_species(draw_microcanonical), Complaints{});
  const auto law = microcanonical_law(two_species(), Layout::fluid, 3, {0, 1, 1});
  EXPECT_DOUBLE_EQ(law.total_shape(), 33);
  EXPECT_FALSE(law.alike);
  EXPECT_DOUBLE_EQ(law.internal_energy_mean(33), 10);
  EXPECT_DOUBLE_EQ(law.internal_temperature(16), 1);
  EXPECT_TRUE(microcanonical_law(two_species(), Layout::fluid, 3, {0, 0, 0}).alike);
}

TEST(MicrocanonicalFaults, OfSpeciesAreSeen) {
  // Particles whose energies are drawn as if all were of the first species.
  const auto one_shape = check_species(
      [](const Fluid& f, Layout layout, double energy, const Noise& noise, State& state) {
        auto parameters = f.parameters();
        parameters.further_species[0].heat_capacity = parameters.heat_capacity;
        draw_microcanonical(Fluid(parameters), layout, energy, noise, state);
      });
  EXPECT_TRUE(one_shape.count("law of u"));
  // And velocities as if all had its mass.
  const auto one_mass = check_species(
      [](const Fluid& f, Layout layout, double energy, const Noise& noise, State& state) {
        auto parameters = f.parameters();
        parameters.further_species[0].mass = parameters.mass;
        draw_microcanonical(Fluid(parameters), layout, energy, noise, state);
      });
  EXPECT_TRUE(one_mass.count("momentum"));
  EXPECT_TRUE(one_mass.count("energy"));
  EXPECT_TRUE(check_species(draw_off_equilibrium).count("law of u"));
}

TEST(OffEquilibrium, GivesEverySpeciesOneTemperature) {
  const Fluid fluid = two_species();
  State state = place(small_box(), Layout::fluid, Placement::lattice, 9, 0, Noise(5, 0));
  state.species = {0, 1, 1, 0, 1, 0, 0, 1, 0};
  draw_off_equilibrium(fluid, Layout::fluid, 40, Noise(5, 0), state);
  for (std::size_t i = 0; i < 9; ++i) {
    const auto& particle = fluid.equation_of_state(state.species[i]);
    EXPECT_NEAR(particle.temperature(state.internal_energy[i]),
                fluid.temperature(state.internal_energy[0]), 1e-12);
  }
}

// ---- Places. -----------------------------------------------------------------------------------

/// How many others are within the fluid's range of each particle.
std::vector<int> neighbours(const Fluid& fluid, const Box& box, const State& state) {
  std::vector<int> count(state.size(), 0);
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (std::size_t j = 0; j < state.size(); ++j) {
      const Vector apart = box.minimum_image(state.position[i] - state.position[j]);
      if (i != j && apart.norm() < fluid.range()) ++count[i];
    }
  }
  return count;
}

TEST(Pairs, HaveExactlyOneNeighbourEachAndLieAlongTheFirstAxis) {
  for (const double range : {0.3, 1.0, 2.5}) {
    auto f = fluid_with(5).parameters();
    f.friction_range = range;
    const Fluid fluid(f);
    for (const double share : {0.1, 0.5, 0.99}) {
      for (const std::size_t particles : {2U, 4U, 54U, 56U, 250U}) {
        const double apart = share * range;
        const Box box = make_box(fluid, Layout::pairs, particles, 3, apart);
        const State state =
            place(box, Layout::pairs, Placement::random, particles, apart, Noise(1, 0));
        ASSERT_EQ(state.size(), particles);
        EXPECT_EQ(neighbours(fluid, box, state), std::vector<int>(particles, 1));
        System system(fluid, box, state, Noise(1, 0), true);
        std::size_t pairs = 0;
        system.for_each_pair([&](const System::Geometry& g) {
          EXPECT_EQ(g.i / 2, g.j / 2);
          EXPECT_NEAR(std::abs(g.e[0]), 1, 1e-12);
          EXPECT_NEAR(g.r, apart, 1e-12 * box.lengths.maxCoeff());
          ++pairs;
        });
        EXPECT_EQ(pairs, particles / 2);
      }
    }
  }
}

TEST(Pairs, TooNearToOthersWouldBeNoticed) {
  const Fluid fluid = fluid_with(5);
  Box box = make_box(fluid, Layout::pairs, 54, 3, 0.5);
  box.lengths *= 0.75;
  const State state = place(box, Layout::pairs, Placement::lattice, 54, 0.5, Noise(1, 0));
  EXPECT_NE(neighbours(fluid, box, state), std::vector<int>(54, 1));
}

TEST(Pairs, MoveAlongTheirAxisAlone) {
  const Fluid fluid = fluid_with(5);
  State state =
      place(Box{Vector::Constant(20)}, Layout::pairs, Placement::lattice, 40, 0.5, Noise(1, 0));
  draw_microcanonical(fluid, Layout::pairs, 30, Noise(1, 0), state);
  for (std::size_t i = 0; i < 40; i += 2) {
    EXPECT_NE(state.velocity[i][0], 0);
    EXPECT_EQ(state.velocity[i].tail<2>().norm(), 0);
    EXPECT_NEAR(state.velocity[i][0], -state.velocity[i + 1][0], 1e-14);
  }
}

TEST(FluidBox, HasTheDensity) {
  const Box box = make_box(fluid_with(5), Layout::fluid, 3000, 3, 0);
  EXPECT_NEAR(3000 / box.volume(), 3, 1e-12);
  EXPECT_EQ(box.lengths[0], box.lengths[1]);
  EXPECT_EQ(box.lengths[0], box.lengths[2]);
}

TEST(Lattice, KeepsParticlesApartAndInsideWhateverTheirNumber) {
  for (const std::size_t particles : {1U, 2U, 7U, 8U, 10U, 27U, 64U, 100U}) {
    const Box box = make_box(fluid_with(5), Layout::fluid, particles, 1, 0);
    const State state = place(box, Layout::fluid, Placement::lattice, particles, 0, Noise(1, 0));
    ASSERT_EQ(state.size(), particles);
    // Sites of the smallest cube that holds them all are this far apart.
    const double side = std::ceil(std::cbrt(static_cast<double>(particles)) - 1e-9);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < particles; ++i) {
      EXPECT_EQ(state.id[i], i);
      EXPECT_TRUE((state.position[i].array() >= 0).all());
      EXPECT_TRUE((state.position[i].array() < box.lengths.array()).all());
      for (std::size_t j = 0; j < i; ++j) {
        nearest =
            std::min(nearest, box.minimum_image(state.position[i] - state.position[j]).norm());
      }
    }
    EXPECT_GE(nearest, box.lengths[0] / side - 1e-12);
  }
}

TEST(RandomPlaces, AreUniformInEveryComponent) {
  const Box box{Vector(1, 2, 4)};
  const State state = place(box, Layout::fluid, Placement::random, 30000, 0, Noise(8, 0));
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> x;
    for (const auto& position : state.position) x.push_back(position[axis] / box.lengths[axis]);
    EXPECT_TRUE(has_beta_law(x, 1, 1));
    for (double& z : x) z *= z;
    EXPECT_FALSE(has_beta_law(x, 1, 1));
  }
  double product = 0;  // of variates of variance 1/12
  for (const auto& r : state.position) product += (r[0] - 0.5) * (r[1] / 2 - 0.5) * 12;
  EXPECT_LT(std::abs(product), bound * std::sqrt(30000.0));
}

// ---- The other starts. -------------------------------------------------------------------------

TEST(OffEquilibrium, HasTheSameEnergyFarFromTheLaw) {
  const Fluid fluid = fluid_with(5);
  for (const auto layout : {Layout::fluid, Layout::pairs}) {
    const std::size_t island = layout == Layout::pairs ? 2 : 40;
    const auto law = microcanonical_law(fluid, layout, 40);
    State state =
        place(Box{Vector::Constant(20)}, layout, Placement::lattice, 40, 0.5, Noise(1, 0));
    draw_off_equilibrium(fluid, layout, 30, Noise(1, 0), state);
    for (std::size_t begin = 0; begin < 40; begin += island) {
      double kinetic = 0, internal = 0;
      Vector momentum = Vector::Zero();
      for (std::size_t i = begin; i < begin + island; ++i) {
        kinetic += 0.5 * fluid.mass() * state.velocity[i].squaredNorm();
        internal += state.internal_energy[i];
        momentum += state.velocity[i];
        EXPECT_EQ(state.internal_energy[i], state.internal_energy[0]);
      }
      EXPECT_NEAR(kinetic, law.kinetic_energy(30) / 2, 1e-12);
      EXPECT_NEAR(kinetic + internal, 30, 1e-12);
      EXPECT_LT(momentum.norm(), 1e-12);
    }
  }
}

TEST(GivenSpread, HasItsSpreadNoMomentumAndOneTemperature) {
  const Fluid fluid = fluid_with(5, 0);  // legal without fluctuations
  State state =
      place(Box{Vector::Constant(20)}, Layout::fluid, Placement::random, 20000, 0, Noise(2, 0));
  draw_given_spread(fluid, Layout::fluid, 0.7, 1.2, Noise(2, 0), state);
  double squares = 0;
  Vector momentum = Vector::Zero();
  for (std::size_t i = 0; i < 20000; ++i) {
    squares += state.velocity[i].squaredNorm() / 60000;
    momentum += state.velocity[i];
    EXPECT_DOUBLE_EQ(state.internal_energy[i], 5 * 1.2);
  }
  EXPECT_NEAR(squares, 0.49, bound * 0.49 * std::sqrt(2.0 / 60000));
  EXPECT_LT(momentum.norm(), 1e-10);
}

TEST(Boost, AddsOneVelocityToAll) {
  const Fluid fluid = fluid_with(5);
  State state = small_state(fluid.parameters());
  const State before = state;
  boost_frame(Vector(1, -2, 3), state);
  for (std::size_t i = 0; i < state.size(); ++i) {
    EXPECT_EQ(state.velocity[i], before.velocity[i] + Vector(1, -2, 3));
  }
  EXPECT_EQ(state.internal_energy, before.internal_energy);
}

TEST(FewParticles, CanBeDrawn) {
  const Fluid fluid = fluid_with(5);
  for (const std::size_t particles : {1U, 2U}) {
    for (const auto draw : {draw_microcanonical, draw_off_equilibrium}) {
      State state =
          place(small_box(), Layout::fluid, Placement::lattice, particles, 0, Noise(1, 0));
      draw(fluid, Layout::fluid, 10, Noise(1, 0), state);
      double energy = 0;
      for (std::size_t i = 0; i < particles; ++i) {
        energy += state.internal_energy[i] + 0.5 * 1.25 * state.velocity[i].squaredNorm();
      }
      EXPECT_NEAR(energy, 10, 1e-12) << particles << " particles";
    }
  }
}

}  // namespace
}  // namespace driftless::testing
