#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <type_traits>

#include "integrators/end_point_iteration.hpp"
#include "integrators/energy_keeping_verlet.hpp"
#include "integrators/pairwise_exchange.hpp"
#include "integrators/second_order_terms.hpp"
#include "integrators/shardlow.hpp"
#include "integrators/trotter.hpp"
#include "tests/small_system.hpp"

// The kernels of all methods give lanes of pairs what they give a single pair.
namespace driftless::testing {
namespace {

/// Quantities of a pair at the start and at the end of a trial step.
struct Numbers {
  double r, w_friction, w_heat, v, u_i, u_j, noise, heat_noise, uniform, heat_uniform;
  double dv_i, dv_j, end_u_i, end_u_j;
};

/// States of every kind: near and far, hot and cold, weights of 0, energies about to fall below 0.
Numbers random_numbers(Uniform& uniform) {
  const double r = uniform(0.01, 1.1), weight = std::pow(std::max(0.0, 1 - r), 2);
  const double u_i = std::exp(uniform(-4, 4)), u_j = std::exp(uniform(-4, 4));
  return {r,
          weight,
          weight,
          uniform(-3, 3),
          u_i,
          u_j,
          uniform(-3, 3),
          uniform(-3, 3),
          uniform(1e-6, 1),
          uniform(1e-6, 1),
          uniform(-1, 1),
          uniform(-1, 1),
          u_i * uniform(0.5, 1.5),
          u_j * uniform(0.5, 1.5)};
}

template <class V, class Take>
TrialPair<V> trial_pair(Take&& take) {
  TrialPair<V> end;
  static_cast<Pair<V>&>(end) = {
      take(&Numbers::r),       take(&Numbers::w_friction),
      take(&Numbers::w_heat),  take(&Numbers::v) + take(&Numbers::dv_i) - take(&Numbers::dv_j),
      take(&Numbers::end_u_i), take(&Numbers::end_u_j),
      take(&Numbers::noise),   take(&Numbers::heat_noise),
      take(&Numbers::uniform), take(&Numbers::heat_uniform)};
  end.dv_i = take(&Numbers::dv_i);
  end.dv_j = take(&Numbers::dv_j);
  return end;
}

template <class V>
Pair<V> start_of(TrialPair<V> end, const V& v, const V& u_i, const V& u_j) {
  Pair<V> start = end;
  start.v = v;
  start.u_i = u_i;
  start.u_j = u_j;
  return start;
}

/// The difference, relative where numbers are large. An energy below 0, which is about to end a
/// step, may make the rest not a number, but then for lanes and scalars alike.
double difference(double found, double expected) {
  if (std::isnan(found) && std::isnan(expected)) return 0;
  const double size = std::abs(found - expected) / (1 + std::abs(expected));
  return std::isnan(size) ? std::numeric_limits<double>::infinity() : size;
}

/// How far the lanes of a kernel are from its scalar results.
template <class Kernel>
double lane_difference(Kernel&& kernel, std::uint64_t seed) {
  Uniform uniform(seed);
  double worst = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<Numbers> numbers;
    for (std::size_t n = 0; n < Lanes::count(); ++n) numbers.push_back(random_numbers(uniform));
    const auto lanes = [&](double Numbers::*member) {
      std::vector<double> values;
      for (const auto& one : numbers) values.push_back(one.*member);
      return Lanes::load(values.data());
    };
    const auto end = trial_pair<Lanes>(lanes);
    const Transfer<Lanes> all =
        kernel(start_of(end, lanes(&Numbers::v), lanes(&Numbers::u_i), lanes(&Numbers::u_j)), end);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      const auto one = [&](double Numbers::*member) { return numbers[n].*member; };
      const auto end_of_one = trial_pair<double>(one);
      const Transfer<double> expected =
          kernel(start_of(end_of_one, one(&Numbers::v), one(&Numbers::u_i), one(&Numbers::u_j)),
                 end_of_one);
      const auto lane = [&](Lanes value) {
        std::vector<double> values(Lanes::count());
        value.store(values.data());
        return values[n];
      };
      worst = std::max({worst, difference(lane(all.momentum), expected.momentum),
                        difference(lane(all.energy_i), expected.energy_i),
                        difference(lane(all.energy_j), expected.energy_j)});
    }
  }
  return worst;
}

constexpr double rounding = 1e-13;
constexpr double dt = 0.05;
const Sweep reverse{.order = SweepOrder::reverse};
const Sweep frozen{.energies = SweepEnergies::frozen};

class FlowsInLanes : public ::testing::TestWithParam<Terms> {
 protected:
  const Fluid fluid_{small_fluid(GetParam(), 0.5)};

  template <class Kernel>
  void expect_same(const char* name, Kernel&& kernel) {
    EXPECT_LT(lane_difference(kernel, 11), rounding) << name;
  }
};

TEST_P(FlowsInLanes, ExplicitAndImplicitExchanges) {
  expect_same("euler", [&](const auto& p, const auto&) { return euler_exchange(fluid_, p, dt); });
  expect_same("noises", [&](const auto& p, const auto&) { return noise_exchange(fluid_, p, dt); });
  expect_same("expanded", [&](const auto& p, const auto& end) {
    return expanded_exchange(fluid_, p, changes(p, end), dt);
  });
  expect_same("own products", [&](const auto& p, const auto&) {
    return expanded_exchange(fluid_, p, own_changes(fluid_, p, dt), dt);
  });
  expect_same("end point", [&](const auto& p, const auto& end) {
    return Transfer{end_point_momentum(fluid_, p, end, dt)};
  });
  expect_same("end point conduction", [&](const auto& p, const auto& end) {
    return end_point_conduction(fluid_, p, end, dt);
  });
  expect_same("half kick", [&](const auto& p, const auto& end) {
    return midpoint_work(0.5 * dt * fluid_.repulsive_force(p.r), p, end);
  });
}

TEST_P(FlowsInLanes, SweepsOfShardlowAndTrotter) {
  for (const auto& how : {Sweep{}, reverse, frozen}) {
    for (const bool exponential : {false, true}) {
      for (const bool as_published : {false, true}) {
        expect_same("shardlow", [&](const auto& p, const auto&) {
          return shardlow_exchange(fluid_, p, dt, how, {as_published, exponential, how.energies});
        });
      }
    }
    expect_same("trotter",
                [&](const auto& p, const auto&) { return trotter_exchange(fluid_, p, dt, how); });
  }
}

// The square root of Peters' first scheme ends where zeta dt reaches 2 mu.
TEST_P(FlowsInLanes, PairwiseExchanges) {
  expect_same("Peters I",
              [&](const auto& p, const auto&) { return peters_friction(fluid_, p, 1e-4, false); });
  expect_same("Peters II",
              [&](const auto& p, const auto&) { return peters_friction(fluid_, p, dt, true); });
  for (const auto resampling : {Resampling::exact, Resampling::maxwell}) {
    expect_same("Lowe-Andersen", [&](const auto& p, const auto&) {
      return lowe_andersen_friction(fluid_, p, dt, 20, resampling);
    });
  }
}

TEST_P(FlowsInLanes, MetropolisMoves) {
  for (const double step : {0.0, 0.05, 5.0}) {
    for (const auto kind : {ConductionProposal::euler, ConductionProposal::exponential}) {
      for (const auto& how : {Sweep{}, reverse}) {
        expect_same("Metropolis", [&](const auto& p, const auto&) {
          return metropolis_exchange(fluid_, p, step, kind, how);
        });
      }
    }
  }
}

std::vector<Terms> all_terms() {
  std::vector<Terms> all;
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    for (const auto heat : all_heat_forms()) {
      for (const bool potential : {false, true}) all.push_back({closure, heat, potential});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Terms, FlowsInLanes, ::testing::ValuesIn(all_terms()));

// ---- Faults that must be seen. ------------------------------------------------------------------

struct Differs {
  template <class V>
  Transfer<V> operator()(const Pair<V>& pair, const TrialPair<V>&) const {
    const bool scalar = std::is_same_v<V, double>;
    return Transfer{pair.v * (scalar ? 1 : 1 + 1e-12)};
  }
};
struct IsNoNumber {
  template <class V>
  Transfer<V> operator()(const Pair<V>& pair, const TrialPair<V>&) const {
    using std::log;
    const bool scalar = std::is_same_v<V, double>;
    return Transfer{log(scalar ? pair.u_i : -pair.u_i)};
  }
};

TEST(FlowsInLanesFaults, AreSeen) {
  EXPECT_GT(lane_difference(Differs(), 11), rounding);
  EXPECT_GT(lane_difference(IsNoNumber(), 11), rounding);
}

}  // namespace
}  // namespace driftless::testing
