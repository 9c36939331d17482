#include "experiments/bench/bench.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>

#include "experiments/bench/bench_run.hpp"
#include "experiments/bench/naive.hpp"
#include "experiments/scene_keys.hpp"
#include "model/initial.hpp"

namespace driftless {
namespace {

constexpr double density = 3;
constexpr double time_step = bench_time_step;
constexpr std::uint64_t seed = bench_seed;

FluidParameters soft_fluid() { return find_preset("soft-fluid")->scene.fluid; }

std::vector<Measured> time_runs(const std::vector<std::unique_ptr<BenchRun>>& runs,
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

MethodRow method_row(const Method& method, BenchRun& run, const Measured& measured) {
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
    {"isothermal",
     [](FluidParameters& f) {
       f.conduction = 0;
       f.isothermal = true;
     }},
};

}  // namespace

BenchPlan full_plan() {
  BenchPlan plan{{3000, 24000, 192000}, {1}};
  if (usable_processors() > 1) plan.threads.push_back(usable_processors());
  return plan;
}

BenchPlan quick_plan() {
  BenchPlan plan = full_plan();
  plan.particles.pop_back();
  plan.sampling.samples = 7;
  return plan;
}

namespace {

BenchStart equilibrated_start(std::size_t particles) {
  const Fluid fluid(soft_fluid());
  const Noise noise(seed, 0);
  const Box box = make_box(fluid, Layout::fluid, particles, density, 0);
  State state = place(box, Layout::fluid, Placement::random, particles, 0, noise);
  const double energy =
      microcanonical_law(fluid, Layout::fluid, particles).energy_at(fluid.parameters().temperature);
  draw_microcanonical(fluid, Layout::fluid, energy, noise, state);
  System system(fluid, box, state, noise);
  system.set_threads(usable_processors());
  const auto integrator = bench_kinds[1].library().make({});
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

/// How often the box of a smaller start is repeated along each axis; 1 if that does not work out.
int copies_of_a_start(std::size_t particles) {
  constexpr std::size_t least = 3000, most = 100'000;
  for (std::size_t copies = 2; copies * copies * copies * least <= particles; ++copies) {
    const std::size_t cube = copies * copies * copies;
    if (particles % cube == 0 && particles / cube <= most) return static_cast<int>(copies);
  }
  return 1;
}

/// Copies of a fluid side by side, with velocities and energies of their own, shuffled: a
/// particle's place in storage tells nothing of its position, as after a long run.
BenchStart repeated(const BenchStart& part, int copies) {
  BenchStart whole{part.fluid, {part.box.lengths * copies}, {}};
  auto& positions = whole.state.position;
  for (int z = 0; z < copies; ++z) {
    for (int y = 0; y < copies; ++y) {
      for (int x = 0; x < copies; ++x) {
        const Vector shift = part.box.lengths.cwiseProduct(Vector(x, y, z));
        for (const auto& position : part.state.position) {
          positions.push_back(whole.box.wrap(position + shift));
        }
      }
    }
  }
  std::shuffle(positions.begin(), positions.end(), std::mt19937_64(seed));
  const std::size_t particles = positions.size();
  whole.state.velocity.assign(particles, Vector::Zero());
  whole.state.internal_energy.assign(particles, 0);
  whole.state.id.resize(particles);
  std::iota(whole.state.id.begin(), whole.state.id.end(), 0U);
  const auto law = microcanonical_law(whole.fluid, Layout::fluid, particles);
  draw_microcanonical(whole.fluid, Layout::fluid,
                      law.energy_at(whole.fluid.parameters().temperature), Noise(seed, 0),
                      whole.state);
  return whole;
}

}  // namespace

BenchStart bench_start(std::size_t particles) {
  constexpr std::size_t equilibrated = 200'000;
  const int copies = particles > equilibrated ? copies_of_a_start(particles) : 1;
  if (copies == 1) return equilibrated_start(particles);
  const auto cube = static_cast<std::size_t>(copies * copies * copies);
  return repeated(equilibrated_start(particles / cube), copies);
}

std::vector<KernelRow> bench_kernels(const BenchPlan& plan, std::size_t particles) {
  const BenchStart start = bench_start(particles);
  std::vector<KernelRow> rows;
  for (const BenchKernel& kernel : bench_kinds) {
    std::vector<std::unique_ptr<BenchRun>> runs;
    std::vector<Contestant> contestants;
    for (const unsigned threads : plan.threads) {
      auto& run =
          *runs.emplace_back(std::make_unique<BenchRun>(kernel.library(), start.fluid, start));
      run.system().set_threads(threads);
      contestants.push_back({[&run] { run.advance(); }, particles});
    }
    std::unique_ptr<NaiveFluid> naive;
    if (particles <= plan.most_naive) {
      naive = std::make_unique<NaiveFluid>(start.fluid.parameters(), start.box, start.state, seed);
      contestants.push_back({[&] { ((*naive).*kernel.naive_step)(time_step); }, particles});
    }
    const auto measured = time_in_turns(contestants, plan.sampling);
    for (std::size_t n = 0; n < runs.size(); ++n) {
      // The bench's own fluid and step are no trouble for either scheme.
      if (!measured[n].failure.empty()) throw std::runtime_error(measured[n].failure);
      KernelRow row{kernel.name, particles, plan.threads[n], measured[n].nanoseconds};
      if (naive) row.naive = measured.back().nanoseconds;
      row.bytes = bytes_per_particle(runs[n]);
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<SceneRow> bench_scenes(const BenchPlan& plan) {
  const BenchStart start = bench_start(plan.table_particles);
  std::vector<SceneRow> rows;
  std::vector<std::unique_ptr<BenchRun>> runs;
  for (const BenchKernel& kernel : bench_kinds) {
    for (const auto& omission : omissions) {
      FluidParameters fluid = start.fluid.parameters();
      omission.leave_out(fluid);
      runs.push_back(
          std::make_unique<BenchRun>(kernel.library(), Fluid(fluid), start, omission.frozen));
      runs.back()->system().set_threads(1);
      rows.push_back({omission.name, kernel.name, plan.table_particles});
    }
  }
  const auto measured = time_runs(runs, plan.sampling);
  double full = 0;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (!measured[n].failure.empty()) throw std::runtime_error(measured[n].failure);
    rows[n].nanoseconds = measured[n].nanoseconds;
    if (rows[n].scene == omissions[0].name) full = measured[n].nanoseconds.median;
    rows[n].share = measured[n].nanoseconds.median / full;
    rows[n].stages = stages_of(*runs[n]);
  }
  for (std::size_t n = 0; n < rows.size(); ++n) rows[n].bytes = bytes_per_particle(runs[n]);
  return rows;
}

std::vector<MethodRow> bench_methods(const BenchPlan& plan) {
  const BenchStart start = bench_start(plan.table_particles);
  std::vector<std::unique_ptr<BenchRun>> runs;
  for (const Method* method : methods()) {
    FluidParameters fluid = start.fluid.parameters();
    fluid.friction_closure = closure_for(*method);
    runs.push_back(std::make_unique<BenchRun>(*method, Fluid(fluid), start));
    runs.back()->system().set_threads(1);
  }
  const auto measured = time_runs(runs, plan.sampling);
  std::vector<MethodRow> rows;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    rows.push_back(method_row(*methods()[n], *runs[n], measured[n]));
  }
  for (std::size_t n = 0; n < runs.size(); ++n) rows[n].bytes = bytes_per_particle(runs[n]);
  const auto reference = std::find_if(rows.begin(), rows.end(), [](const MethodRow& row) {
    return row.method == "averaged-drift" && row.failure.empty();
  });
  if (reference == rows.end()) return rows;
  const double cost = reference->nanoseconds.median;
  for (auto& row : rows) row.factor = row.nanoseconds.median / cost;
  return rows;
}

}  // namespace driftless
