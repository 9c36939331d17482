// What the parts of a step cost, each alone: the search for pairs, random numbers, a pass over all
// pairs with and without new noise, a sweep, and what is done particle by particle; processor time
// per pair or per particle (columns per_pair, per_particle), one thread. The fluid is that of
// `driftless bench`, at its start.

#include <benchmark/benchmark.h>

#include <map>

#include "experiments/bench/bench.hpp"
#include "integrators/shardlow.hpp"

namespace driftless {
namespace {

constexpr double time_step = 0.01;

/// The start for so many particles, made once.
const BenchStart& start_of(const benchmark::State& state) {
  static std::map<std::int64_t, BenchStart> starts;
  const auto particles = state.range(0);
  const auto found = starts.find(particles);
  if (found != starts.end()) return found->second;
  return starts.emplace(particles, bench_start(static_cast<std::size_t>(particles))).first->second;
}

System system_of(const BenchStart& start, bool frozen = false) {
  return System(start.fluid, start.box, start.state, Noise(1, 0), frozen);
}

/// (id_i, id_j) of all pairs.
std::vector<std::pair<std::uint32_t, std::uint32_t>> pair_ids(System& system) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ids;
  system.for_each_pair([&](const auto& pair) {
    ids.emplace_back(system.state().id[pair.i], system.state().id[pair.j]);
  });
  return ids;
}

/// Processor time per iteration and unit.
void report(benchmark::State& state, const char* column, std::size_t units) {
  using benchmark::Counter;
  state.counters[column] =
      Counter(static_cast<double>(units), Counter::kIsIterationInvariantRate | Counter::kInvert);
}
void per_pair(benchmark::State& state, System& system) {
  report(state, "per_pair", pair_ids(system).size());
}
void per_particle(benchmark::State& state, const System& system) {
  report(state, "per_particle", system.size());
}

/// Positions move by next to nothing, so that the pairs stay what they are and must be found anew.
void search(benchmark::State& state) {
  System system = system_of(start_of(state));
  for (auto _ : state) {
    system.move(1e-12);
    std::size_t pairs = 0;
    system.for_each_pair([&](const auto&) { ++pairs; });
    benchmark::DoNotOptimize(pairs);
  }
  per_pair(state, system);
}

void noise_of_a_pair(benchmark::State& state) {
  System system = system_of(start_of(state));
  const auto ids = pair_ids(system);
  Noise noise(1, 0);
  std::uint64_t step = 0;
  for (auto _ : state) {
    noise.set_step(++step);
    double sum = 0;
    for (const auto& [i, j] : ids) {
      const auto normals = noise.pair_normals(i, j, 0, true, true);
      sum += normals.friction + normals.heat;
    }
    benchmark::DoNotOptimize(sum);
  }
  report(state, "per_pair", ids.size());
}

/// A pass of averaged-drift over pairs that stay; new noise in every pass, or in none.
void accumulate(benchmark::State& state, bool new_noise) {
  System system = system_of(start_of(state), true);
  const Fluid& fluid = system.fluid();
  Exchange exchange;
  std::uint64_t step = 0;
  for (auto _ : state) {
    if (new_noise) system.set_step(++step);
    system.accumulate([&](const auto& pair) { return euler_exchange(fluid, pair, time_step); },
                      exchange);
    benchmark::DoNotOptimize(exchange.energy.data());
  }
  per_pair(state, system);
}

/// A sweep of shardlow-s1 likewise.
void sweep(benchmark::State& state, bool new_noise) {
  System system = system_of(start_of(state), true);
  std::uint64_t step = 0;
  for (auto _ : state) {
    if (new_noise) system.set_step(++step);
    shardlow_sweep(system, 1e-6, SweepOrder::forward, 0, {});  // far from any failure
  }
  per_pair(state, system);
}

void conservative_force(benchmark::State& state) {
  System system = system_of(start_of(state));
  for (auto _ : state) {
    state.PauseTiming();
    system.move(1e-12);
    system.for_each_pair([](const auto&) {});
    state.ResumeTiming();
    benchmark::DoNotOptimize(system.conservative_force().data());
  }
  per_pair(state, system);
}

void apply(benchmark::State& state) {
  System system = system_of(start_of(state));
  Exchange nothing;
  nothing.reset(system.size());
  for (auto _ : state) system.apply(nothing);
  per_particle(state, system);
}

void move(benchmark::State& state) {
  System system = system_of(start_of(state));
  for (auto _ : state) system.move(1e-12);
  per_particle(state, system);
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(3000)->Arg(24000)->Unit(benchmark::kMicrosecond);
}

BENCHMARK(search)->Apply(sizes);
BENCHMARK(noise_of_a_pair)->Apply(sizes);
BENCHMARK_CAPTURE(accumulate, same_noise, false)->Apply(sizes);
BENCHMARK_CAPTURE(accumulate, new_noise, true)->Apply(sizes);
BENCHMARK_CAPTURE(sweep, same_noise, false)->Apply(sizes);
BENCHMARK_CAPTURE(sweep, new_noise, true)->Apply(sizes);
BENCHMARK(conservative_force)->Apply(sizes);
BENCHMARK(apply)->Apply(sizes);
BENCHMARK(move)->Apply(sizes);

}  // namespace
}  // namespace driftless

BENCHMARK_MAIN();
