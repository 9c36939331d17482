#include "experiments/bench/bench.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "experiments/bench/naive.hpp"
#include "experiments/scene_keys.hpp"
#include "model/initial.hpp"

namespace driftless {
namespace {

constexpr double density = 3;
constexpr double time_step = 0.01;
constexpr std::uint64_t seed = 1;

/// A kind of step, in the library and in the naive reference.
struct Kernel {
  const char* name;
  const char* method;
  void (NaiveFluid::*naive_step)(double);

  const Method& library() const { return *find_method(method); }
};
constexpr Kernel force_parallel = {"force-parallel", "averaged-drift",
                                   &NaiveFluid::force_parallel_step};
constexpr Kernel sequential = {"sequential", "shardlow-s1", &NaiveFluid::sequential_step};

FluidParameters soft_fluid() { return find_preset("soft-fluid")->scene.fluid; }

/// A method at work on a system.
class Run {
 public:
  Run(const Method& method, const Fluid& fluid, const BenchStart& start, bool frozen = false)
      : system_(fluid, start.box, start.state, Noise(seed, 0), frozen),
        integrator_(method.make({})) {}

  void advance() {
    system_.set_step(++steps_);
    integrator_->step(system_, time_step);
  }
  System& system() { return system_; }
  std::uint64_t steps() const { return steps_; }
  /// Of a counter, per step so far.
  double per_step(std::uint64_t count) const {
    return static_cast<double>(count) / static_cast<double>(steps_);
  }

 private:
  System system_;
  std::unique_ptr<Integrator> integrator_;
  std::uint64_t steps_ = 0;
};

std::vector<Measured> time_runs(const std::vector<std::unique_ptr<Run>>& runs,
                                const Sampling& sampling) {
  std::vector<Contestant> contestants;
  for (const auto& run : runs) {
    contestants.push_back({[&run = *run] { run.advance(); }, run->system().size()});
  }
  return time_in_turns(contestants, sampling);
}

/// A closure that the method is built for; `noise` wherever it is one of them.
FrictionClosure closure_for(const Method& method) {
  const auto& all = method.closures;
  const bool noise = std::find(all.begin(), all.end(), FrictionClosure::noise) != all.end();
  return noise || all.empty() ? FrictionClosure::noise : all.front();
}

/// Seconds of each stage per particle and step, of some more steps: looking at the clock takes
/// time.
StageSeconds stages_of(Run& run) {
  constexpr int steps = 20;
  System& system = run.system();
  system.measure_passes();
  const auto start = std::chrono::steady_clock::now();
  for (int n = 0; n < steps; ++n) run.advance();
  const std::chrono::duration<double> total = std::chrono::steady_clock::now() - start;
  const PassSeconds passes = system.pass_seconds();
  const double per = 1 / (steps * static_cast<double>(system.size()));
  const double known = passes.search + passes.noise + passes.arithmetic + passes.scatter;
  return {per * passes.search, per * passes.noise, per * passes.arithmetic, per * passes.scatter,
          per * (total.count() - known)};
}

MethodRow method_row(const Method& method, Run& run, const Measured& measured) {
  System& system = run.system();
  MethodRow row;
  row.method = method.name;
  row.closure = to_string(closure_for(method));
  row.failure = measured.failure;
  row.particles = system.size();
  if (!row.failure.empty()) return row;
  row.nanoseconds = measured.nanoseconds;
  const Counters counters = system.counters();
  std::size_t pairs = 0;
  system.for_each_pair([&](const auto&) { ++pairs; });
  const double particles = static_cast<double>(system.size());
  row.pairs = static_cast<double>(pairs) / particles;
  row.visits = run.per_step(counters.pair_evaluations) / static_cast<double>(pairs);
  row.iterations = run.per_step(counters.solver_iterations);
  row.numbers = run.per_step(counters.random_numbers) / static_cast<double>(pairs);
  row.stages = stages_of(run);
  return row;
}

/// A scene that leaves something out.
struct Omission {
  const char* name;
  void (*leave_out)(FluidParameters&);
  bool frozen = false;
};

const Omission omissions[] = {
    {"full", [](FluidParameters&) {}},
    {"no conduction", [](FluidParameters& f) { f.conduction = 0; }},
    {"no friction", [](FluidParameters& f) { f.friction = 0; }},
    {"no repulsion", [](FluidParameters& f) { f.repulsion = 0; }},
    {"frozen", [](FluidParameters&) {}, true},
};

}  // namespace

BenchPlan full_plan() {
  BenchPlan plan{{3000, 24000, 192000}, {1}};
  if (usable_cpus() > 1) plan.threads.push_back(usable_cpus());
  return plan;
}

BenchPlan quick_plan() {
  BenchPlan plan = full_plan();
  plan.particles.pop_back();
  plan.sampling.samples = 7;
  return plan;
}

BenchStart bench_start(std::size_t particles) {
  const Fluid fluid(soft_fluid());
  const Noise noise(seed, 0);
  const Box box = make_box(fluid, Layout::fluid, particles, density, 0);
  State state = place(box, Layout::fluid, Placement::random, particles, 0, noise);
  const double energy =
      microcanonical_law(fluid, Layout::fluid, particles).energy_at(fluid.parameters().temperature);
  draw_microcanonical(fluid, Layout::fluid, energy, noise, state);
  System system(fluid, box, state, noise);
  system.set_threads(usable_cpus());
  const auto integrator = sequential.library().make({});
  // Particles at random repel each other and heat up: fresh velocities and energies, now and then,
  // keep the temperature while positions become a fluid's.
  constexpr std::uint64_t steps = 50, fresh_every = 10;
  for (std::uint64_t step = 1; step <= steps; ++step) {
    system.set_step(step);
    integrator->step(system, 2 * time_step);
    if (step % fresh_every != 0) continue;
    state = system.state();
    draw_microcanonical(fluid, Layout::fluid, energy, Noise(seed, step), state);
    system.set_state(state);
  }
  return {fluid, box, system.state()};
}

std::vector<KernelRow> bench_kernels(const BenchPlan& plan, std::size_t particles) {
  const BenchStart start = bench_start(particles);
  std::vector<KernelRow> rows;
  for (const Kernel& kernel : {force_parallel, sequential}) {
    NaiveFluid naive(start.fluid.parameters(), start.box, start.state, seed);
    std::vector<Contestant> contestants = {
        {[&] { (naive.*kernel.naive_step)(time_step); }, particles}};
    std::vector<std::unique_ptr<Run>> runs;
    for (const unsigned threads : plan.threads) {
      auto& run = *runs.emplace_back(std::make_unique<Run>(kernel.library(), start.fluid, start));
      run.system().set_threads(threads);
      contestants.push_back({[&run] { run.advance(); }, particles});
    }
    const auto measured = time_in_turns(contestants, plan.sampling);
    for (std::size_t n = 0; n < runs.size(); ++n) {
      // The bench's own fluid and step are no trouble for either scheme.
      if (!measured[n + 1].failure.empty()) throw std::runtime_error(measured[n + 1].failure);
      rows.push_back({kernel.name, particles, plan.threads[n], measured[n + 1].nanoseconds,
                      measured[0].nanoseconds});
    }
  }
  return rows;
}

std::vector<SceneRow> bench_scenes(const BenchPlan& plan) {
  const BenchStart start = bench_start(plan.table_particles);
  std::vector<SceneRow> rows;
  std::vector<std::unique_ptr<Run>> runs;
  for (const Kernel& kernel : {force_parallel, sequential}) {
    for (const auto& omission : omissions) {
      FluidParameters fluid = start.fluid.parameters();
      omission.leave_out(fluid);
      runs.push_back(std::make_unique<Run>(kernel.library(), Fluid(fluid), start, omission.frozen));
      runs.back()->system().set_threads(1);
      rows.push_back({omission.name, kernel.name, plan.table_particles, {}, 1});
    }
  }
  const auto measured = time_runs(runs, plan.sampling);
  double full = 0;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (!measured[n].failure.empty()) throw std::runtime_error(measured[n].failure);
    rows[n].nanoseconds = measured[n].nanoseconds;
    if (rows[n].scene == omissions[0].name) full = measured[n].nanoseconds.median;
    rows[n].share = measured[n].nanoseconds.median / full;
  }
  return rows;
}

std::vector<MethodRow> bench_methods(const BenchPlan& plan) {
  const BenchStart start = bench_start(plan.table_particles);
  std::vector<std::unique_ptr<Run>> runs;
  for (const Method* method : methods()) {
    FluidParameters fluid = start.fluid.parameters();
    fluid.friction_closure = closure_for(*method);
    runs.push_back(std::make_unique<Run>(*method, Fluid(fluid), start));
    runs.back()->system().set_threads(1);
  }
  const auto measured = time_runs(runs, plan.sampling);
  std::vector<MethodRow> rows;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    rows.push_back(method_row(*methods()[n], *runs[n], measured[n]));
  }
  const auto reference = std::find_if(rows.begin(), rows.end(), [](const MethodRow& row) {
    return row.method == "averaged-drift" && row.failure.empty();
  });
  if (reference == rows.end()) return rows;
  const double cost = reference->nanoseconds.median;
  for (auto& row : rows) row.factor = row.nanoseconds.median / cost;
  return rows;
}

}  // namespace driftless
