#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/bench/sampling.hpp"
#include "experiments/processors.hpp"
#include "integrators/integrator.hpp"

namespace driftless {

/// What is measured: the soft fluid at density 3, in the step 0.01.
struct BenchPlan {
  std::vector<std::size_t> particles;
  std::vector<unsigned> threads;
  Sampling sampling = {};
  std::size_t table_particles = 3000;  ///< of the tables of scenes and of methods
  std::size_t most_naive = 200'000;    ///< the naive reference is not shown larger systems
};
/// One thread and all CPUs; the quick one without the largest system.
BenchPlan full_plan();
BenchPlan quick_plan();
/// The fewest particles that the naive reference takes at this density, in round numbers.
constexpr std::size_t least_bench_particles = 100;

/// Seconds that went into each stage of a step.
struct StageSeconds {
  double search = 0;       ///< particles into cells, pairs found and put in order
  double noise = 0;        ///< random numbers
  double arithmetic = 0;   ///< geometry, weights, kernels
  double scatter = 0;      ///< from pairs to particles
  double integration = 0;  ///< what is done particle by particle

  double total() const { return search + noise + arithmetic + scatter + integration; }
};

/// A kernel of the library beside the naive reference of the same scheme on one core.
struct KernelRow {
  std::string kernel;  ///< "force-parallel" (averaged-drift) or "sequential" (shardlow-s1)
  std::size_t particles;
  unsigned threads;
  Spread nanoseconds = {}, naive = {};  ///< per particle and step; naive may have no samples
  std::optional<double> bytes = {};     ///< of memory per particle beyond the State
  StageSeconds stages = {};  ///< per particle and step, where they were measured, on one thread

  bool has_naive() const { return naive.samples > 0; }
  double speed_up() const { return naive.median / nanoseconds.median; }
};
/// Every kernel on every number of threads, for one number of particles.
std::vector<KernelRow> bench_kernels(const BenchPlan& plan, std::size_t particles);

/// A scene that leaves something out, in both kernels.
struct SceneRow {
  std::string scene, kernel;
  std::size_t particles;
  Spread nanoseconds = {};           ///< per particle and step
  double share = 1;                  ///< of the full fluid's
  StageSeconds stages = {};          ///< per particle and step
  std::optional<double> bytes = {};  ///< of memory per particle beyond the State
};
std::vector<SceneRow> bench_scenes(const BenchPlan& plan);

/// A method on the full fluid, under the first closure it is built for.
struct MethodRow {
  std::string method, closure, failure;  ///< nothing below means anything after a failure
  std::size_t particles = 0;
  Spread nanoseconds = {};           ///< per particle and step
  double pairs = 0;                  ///< within the range, per particle
  double visits = 0;                 ///< evaluations of a pair, per pair and step
  double iterations = 0;             ///< of the implicit solve, per step
  double numbers = 0;                ///< random numbers, per pair and step
  double factor = 0;                 ///< of the cost of averaged-drift; 0 if that one failed
  StageSeconds stages = {};          ///< per particle and step
  std::optional<double> bytes = {};  ///< of memory per particle beyond the State

  double nanoseconds_per_visit() const { return nanoseconds.median / (pairs * visits); }
};
std::vector<MethodRow> bench_methods(const BenchPlan& plan);

/// The state that every contestant starts from: a soft fluid in the cubic box of the density; a
/// large one is of copies of a smaller one, drawn anew in all but their positions.
struct BenchStart {
  Fluid fluid;
  Box box;
  State state;
};
BenchStart bench_start(std::size_t particles);

/// What `driftless bench` was asked for.
struct BenchArguments {
  bool quick = false;
  bool scaling = false;                ///< sizes, threads and terms besides; a page needs them
  std::string page;                    ///< HTML file, empty for none
  std::string json;                    ///< file, empty for none
  std::vector<unsigned> threads;       ///< empty for the plan's
  std::vector<std::size_t> particles;  ///< empty for the plan's
};
/// Measures and prints the tables as they grow, then writes the JSON. Throws InputError where the
/// file could not be written, before anything is measured.
void run_bench(const BenchArguments& arguments);

/// The rows for the JSON file; spreads by their quartiles.
nlohmann::json to_json(const KernelRow& row);
nlohmann::json to_json(const SceneRow& row);
nlohmann::json to_json(const MethodRow& row);
nlohmann::json to_json(const StageSeconds& stages);  ///< in nanoseconds

}  // namespace driftless
