// What `driftless bench` reports, on systems so small that it takes no time; no test depends on how
// long anything took.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "experiments/bench/bench.hpp"
#include "experiments/bench/bench_page.hpp"
#include "experiments/bench/scaling.hpp"
#include "experiments/study.hpp"

namespace driftless {
namespace {

// ---- Sampling

TEST(Spread, MedianAndQuartiles) {
  const auto odd = spread({5, 1, 3, 2, 4});
  EXPECT_DOUBLE_EQ(odd.median, 3);
  EXPECT_DOUBLE_EQ(odd.lower, 2);
  EXPECT_DOUBLE_EQ(odd.upper, 4);
  EXPECT_EQ(odd.samples, 5u);
  const auto even = spread({4, 1, 2, 3});
  EXPECT_DOUBLE_EQ(even.median, 2.5);
  EXPECT_DOUBLE_EQ(even.lower, 1.75);
  EXPECT_DOUBLE_EQ(even.upper, 3.25);
  const auto single = spread({7});
  EXPECT_DOUBLE_EQ(single.lower, 7);
  EXPECT_DOUBLE_EQ(single.upper, 7);
  EXPECT_THROW(spread({}), std::invalid_argument);
}

/// Contestants a, b, ... that write their letter at every step.
std::vector<Contestant> writers(std::string& trace, char last) {
  std::vector<Contestant> all;
  for (char letter = 'a'; letter <= last; ++letter) {
    all.push_back({[&trace, letter] { trace += letter; }, 10});
  }
  return all;
}

TEST(TimeInTurns, TakesTurnsSampleBySample) {
  std::string trace;
  const auto measured = time_in_turns(writers(trace, 'b'), {3, 0, 2, 1e9});
  // Warm-up and calibration of each, then three rounds of two steps each.
  EXPECT_EQ(trace,
            "aaabbb"
            "aabb"
            "aabb"
            "aabb");
  ASSERT_EQ(measured.size(), 2u);
  for (const auto& one : measured) {
    EXPECT_EQ(one.failure, "");
    EXPECT_EQ(one.nanoseconds.samples, 3u);
  }
}

TEST(TimeInTurns, WhoTakesTooLongIsSampledLessButAlongside) {
  std::string trace;
  time_in_turns(writers(trace, 'a'),
                {9, 0, 1, 0});  // nothing affordable: three samples of one step
  EXPECT_EQ(trace,
            "aaa"
            "aaa");
  trace.clear();
  const auto measured = time_in_turns(writers(trace, 'a'), {2, 0, 1, 0});  // never more than asked
  EXPECT_EQ(trace,
            "aaa"
            "aa");
  EXPECT_EQ(measured[0].nanoseconds.samples, 2u);
}

TEST(TimeInTurns, WhoFailsTakesPartNoMore) {
  std::string trace;
  auto contestants = writers(trace, 'b');
  int left = 4;
  contestants[0].step = [&] {
    trace += 'a';
    if (--left == 0) throw StepFailure(FailureCause::not_converged, {});
  };
  const auto measured = time_in_turns(contestants, {2, 0, 2, 1e9});
  EXPECT_EQ(trace,
            "aaabbb"
            "abb"
            "bb");
  EXPECT_NE(measured[0].failure.find("solver did not converge"), std::string::npos);
  EXPECT_EQ(measured[0].nanoseconds.samples, 0u);
  EXPECT_EQ(measured[1].nanoseconds.samples, 2u);
}

// ---- Tables

BenchPlan tiny_plan() { return {{200}, {1, 2}, {2, 0, 1, 1e9}, 150}; }

bool has_null(const nlohmann::json& value) {
  if (value.is_null()) return true;
  return value.is_structured() &&
         std::any_of(value.begin(), value.end(), [](const auto& part) { return has_null(part); });
}

TEST(Bench, PlansCoverOneThreadAndAllCpus) {
  EXPECT_EQ(full_plan().particles, (std::vector<std::size_t>{3000, 24000, 192000}));
  EXPECT_EQ(quick_plan().particles, (std::vector<std::size_t>{3000, 24000}));
  for (const auto& plan : {full_plan(), quick_plan()}) {
    EXPECT_EQ(plan.threads.front(), 1u);
    EXPECT_EQ(plan.threads.back(), usable_processors());
    EXPECT_GE(plan.sampling.samples, 7u);
  }
}

TEST(Bench, SmallSystemsAreForOneThread) {
  EXPECT_EQ(useful_threads(100), 1U);
  EXPECT_EQ(useful_threads(1'000'000), usable_processors());
  EXPECT_LE(useful_threads(1500), 2U);
}

// A long run of 600 particles of this fluid has 6.03 pairs a particle, which fluctuate by 0.039; of
// 2400 by half of that. Six standard deviations are a false alarm in 5e8; particles at random, at
// 6.28, are beyond them.
TEST(Bench, StartsFromTheSoftFluidAtItsTemperature) {
  constexpr std::size_t particles = 2400;
  const auto start = bench_start(particles);
  System system(start.fluid, start.box, start.state, Noise(1, 0));
  std::size_t pairs = 0;
  system.for_each_pair([&](const auto&) { ++pairs; });
  EXPECT_NEAR(static_cast<double>(pairs) / particles, 6.03, 6 * 0.039 / 2);
  const double energy = system.kinetic_energy() + system.internal_energy();
  EXPECT_NEAR(energy / particles, 1.5 + 61, 1e-3);  // 1e-3 for the momentum at rest
  EXPECT_NEAR(particles / start.box.volume(), 3, 1e-9);
}

TEST(Bench, KernelsOnEveryNumberOfThreads) {
  const auto rows = bench_kernels(tiny_plan(), 200);
  ASSERT_EQ(rows.size(), 4u);
  std::set<std::pair<std::string, unsigned>> seen;
  for (const auto& row : rows) {
    seen.insert({row.kernel, row.threads});
    EXPECT_EQ(row.particles, 200u);
    const auto json = to_json(row);
    EXPECT_FALSE(json["naive_ns_per_particle_step"].is_null()) << json;
    for (const auto* key : {"kernel", "particles", "threads", "ns_per_particle_step",
                            "naive_ns_per_particle_step", "speed_up", "bytes_per_particle"}) {
      EXPECT_TRUE(json.contains(key)) << key;
    }
    EXPECT_GT(json["ns_per_particle_step"], 0.0);
    EXPECT_DOUBLE_EQ(json["speed_up"].get<double>() * json["ns_per_particle_step"].get<double>(),
                     json["naive_ns_per_particle_step"].get<double>());
    EXPECT_LE(json["spread"]["lower"], json["ns_per_particle_step"]);
    EXPECT_GE(json["spread"]["upper"], json["ns_per_particle_step"]);
  }
  const std::set<std::pair<std::string, unsigned>> wanted = {
      {"force-parallel", 1}, {"force-parallel", 2}, {"sequential", 1}, {"sequential", 2}};
  EXPECT_EQ(seen, wanted);
}

TEST(Bench, ScenesThatLeaveSomethingOutInBothKernels) {
  const auto rows = bench_scenes(tiny_plan());
  EXPECT_EQ(rows.size(), 12u);
  std::set<std::pair<std::string, std::string>> seen;
  for (const auto& row : rows) {
    seen.insert({row.scene, row.kernel});
    if (row.scene == "full") {
      EXPECT_DOUBLE_EQ(row.share, 1);
    }
    EXPECT_GT(row.share, 0);
    EXPECT_GT(row.stages.total(), 0);
  }
  EXPECT_EQ(seen.size(), rows.size());
}

/// A method that cannot be stepped.
class Stuck : public Integrator {
 public:
  void step(System&, double) override { throw StepFailure(FailureCause::not_converged, {}); }
};

TEST(Bench, EveryMethodHasItsCostOrItsCause) {
  if (!find_method("stuck")) {
    Method stuck;
    stuck.name = "stuck";
    stuck.closures = {FrictionClosure::friction};
    stuck.make = [](const Options&) -> std::unique_ptr<Integrator> {
      return std::make_unique<Stuck>();
    };
    register_method(stuck);
  }
  const auto rows = bench_methods(tiny_plan());
  ASSERT_EQ(rows.size(), methods().size());
  for (const auto& row : rows) {
    const auto json = to_json(row);
    EXPECT_FALSE(has_null(json)) << json;
    if (row.method == "stuck") {
      EXPECT_EQ(row.closure, "friction");
      EXPECT_NE(row.failure.find("solver did not converge"), std::string::npos);
      continue;
    }
    EXPECT_EQ(row.failure, "") << row.method;
    EXPECT_GT(row.nanoseconds.median, 0) << row.method;
    EXPECT_GT(row.visits, 0.5) << row.method;
    EXPECT_GT(row.numbers, 0) << row.method;
    if (row.method == "averaged-drift") {
      // One visit and two numbers a pair; pairs are counted at the end alone.
      EXPECT_DOUBLE_EQ(row.factor, 1);
      EXPECT_NEAR(row.visits, 1, 0.1);
      EXPECT_NEAR(row.numbers, 2, 0.2);
      EXPECT_EQ(row.iterations, 0);
    }
    if (row.method == "avalos-mackie-implicit") {
      EXPECT_EQ(row.iterations, 1);  // amplitudes of the closure `noise`: explicit
    }
  }
}

TEST(Bench, NaiveReferenceIsSparedLargeSystems) {
  auto plan = tiny_plan();
  plan.most_naive = 199;
  for (const auto& row : bench_kernels(plan, 200)) {
    EXPECT_FALSE(row.has_naive());
    const auto json = to_json(row);
    for (const auto* key : {"naive_ns_per_particle_step", "naive_spread", "speed_up"}) {
      EXPECT_TRUE(json.at(key).is_null()) << key;
    }
  }
}

// A lower bound that no change of the library's storage goes below: positions and motion by cells.
TEST(Bench, BytesOfMemoryArePlausibleWhereTheAllocatorTellsThem) {
  for (const auto& row : bench_sizes(3000, {1}, {1, 0, 1, 1e9})) {
    if (!row.bytes) GTEST_SKIP() << "another allocator";
    EXPECT_GT(*row.bytes, 64);
    EXPECT_LT(*row.bytes, 10'000);
  }
}

// Tolerances of pairs per particle as above, for 27000 particles; the start is of 27 copies.
TEST(Bench, LargeStartsAreFluidsOfCopiesInNoOrder) {
  constexpr std::size_t particles = 216'000;
  const auto start = bench_start(particles);
  ASSERT_EQ(start.state.size(), particles);
  EXPECT_NEAR(particles / start.box.volume(), 3, 1e-9);
  System system(start.fluid, start.box, start.state, Noise(1, 0));
  std::size_t pairs = 0;
  system.for_each_pair([&](const auto&) { ++pairs; });
  EXPECT_NEAR(static_cast<double>(pairs) / particles, 6.03, 6 * 0.039 / 6.7);
  const double energy = system.kinetic_energy() + system.internal_energy();
  EXPECT_NEAR(energy / particles, 1.5 + 61, 1e-3);
  EXPECT_LT(system.momentum().norm() / particles, 1e-9);
}

// ---- Scaling

TEST(Scaling, TrafficCountsPartsPairsAndLines) {
  for (const auto* kernel : {"force-parallel", "sequential"}) {
    const double none = bytes_per_step(kernel, 0), six = bytes_per_step(kernel, 6);
    double per_pair = 0;
    for (const auto& part : step_traffic(kernel)) per_pair += part.per_pair;
    EXPECT_GT(none, 0);
    EXPECT_DOUBLE_EQ(six, none + 6 * per_pair);
  }
  EXPECT_THROW(step_traffic("none"), std::invalid_argument);
  EXPECT_GT(triad_bandwidth(1 << 20, 1), 0);
}

TEST(Scaling, PageTellsWhatLimitsInNumbersOfItsOwn) {
  ScalingPlan plan;
  plan.particles = {150, 300};
  plan.sampling = {2, 0, 1, 1e9};
  plan.thread_particles = {300};
  plan.threads = {1, 2};
  plan.terms_particles = plan.cached_particles = 150;
  plan.triad_bytes = 1 << 20;
  nlohmann::json bench = {{"provenance", {{"usable_cpus", 2}, {"command", "a < b"}}},
                          {"rows", nlohmann::json::array()},
                          {"scaling", run_scaling(plan)}};
  for (const auto& row : bench_kernels(tiny_plan(), 200)) bench["rows"].push_back(to_json(row));
  for (const auto& row : bench_methods(tiny_plan())) bench["methods"].push_back(to_json(row));
  const auto& scaling = bench["scaling"];
  EXPECT_EQ(scaling["sizes"].size(), 8u);
  EXPECT_EQ(scaling["threads"].size(), 4u);
  EXPECT_EQ(scaling["limits"].size(), 4u);
  EXPECT_EQ(scaling["terms"].size(), 12u);
  const std::string page = bench_page(bench);
  EXPECT_NE(page.find("At N = 150 on one thread"), std::string::npos);
  EXPECT_NE(page.find("a &lt; b"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org/2000/svg"));
}

TEST(Bench, RefusesAFileThatCannotBeWrittenBeforeItMeasures) {
  BenchArguments arguments;
  arguments.json = "/no-such-folder/bench.json";
  EXPECT_THROW(run_bench(arguments), InputError);
  arguments.json = testing::TempDir();
  EXPECT_THROW(run_bench(arguments), InputError);
}

}  // namespace
}  // namespace driftless
