#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "experiments/bench/bench.hpp"
#include "experiments/bench/bench_page.hpp"
#include "experiments/bench/bench_text.hpp"
#include "experiments/bench/scaling.hpp"
#include "experiments/files.hpp"
#include "experiments/provenance.hpp"
#include "experiments/study.hpp"

namespace driftless {
namespace {

namespace fs = std::filesystem;

void check_writable(const std::string& file) {
  auto folder = fs::path(file).parent_path();
  if (folder.empty()) folder = ".";
  std::error_code error;
  if (fs::is_directory(file, error) || access(folder.c_str(), W_OK) != 0) {
    throw InputError(file + ": cannot be written");
  }
}

/// The command that repeats a bench.
std::string command(const BenchArguments& arguments) {
  std::vector<std::string> words = {"driftless bench"};
  if (arguments.quick) words.push_back("--quick");
  if (!arguments.threads.empty()) {
    words.push_back(fmt::format("--threads {}", fmt::join(arguments.threads, ",")));
  }
  if (!arguments.particles.empty()) {
    words.push_back(fmt::format("--particles {}", fmt::join(arguments.particles, ",")));
  }
  if (arguments.scaling) words.push_back("--scaling");
  if (!arguments.json.empty()) words.push_back("--json " + arguments.json);
  if (!arguments.page.empty()) words.push_back("--page " + arguments.page);
  return fmt::format("{}", fmt::join(words, " "));
}

/// How much faster than the same kernel on one thread; "" if that was not measured.
std::string over_one_thread(const KernelRow& row, const std::vector<KernelRow>& rows) {
  if (row.threads == 1) return "";
  for (const auto& other : rows) {
    if (other.kernel == row.kernel && other.particles == row.particles && other.threads == 1) {
      return fmt::format("{:.2f}", other.nanoseconds.median / row.nanoseconds.median);
    }
  }
  return "";
}

std::vector<KernelRow> print_kernels(const BenchPlan& plan) {
  print_line("\n{:<14} {:>9} {:>7}  {:>26}  {:>26}  {:>8}  {:>8}  {:>8}\n", "kernel", "particles",
             "threads", "ns per particle-step", "naive, one core", "speed-up", "over one", "bytes");
  std::vector<KernelRow> all;
  for (const auto particles : plan.particles) {
    const auto rows = bench_kernels(plan, particles);
    for (const auto& row : rows) {
      print_line("{:<14} {:>9} {:>7}  {:>26}  {:>26}  {:>8}  {:>8}  {:>8}\n", row.kernel,
                 row.particles, row.threads, text(row.nanoseconds), text(row.naive),
                 row.has_naive() ? fmt::format("{:.2f}", row.speed_up()) : "-",
                 over_one_thread(row, rows), bytes_text(row.bytes));
    }
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

std::vector<SceneRow> print_scenes(const BenchPlan& plan) {
  print_line("\nWhat a scene leaves out ({} particles, one thread)\n{:<14} {:<14}  {:>26}  {:>8}\n",
             plan.table_particles, "scene", "kernel", "ns per particle-step", "share");
  const auto rows = bench_scenes(plan);
  for (const auto& row : rows) {
    print_line("{:<14} {:<14}  {:>26}  {:>8.2f}\n", row.scene, row.kernel, text(row.nanoseconds),
               row.share);
  }
  return rows;
}

void print_stages(const StageSeconds& stages) {
  print_line(
      "  search {:.1f}, noise {:.1f}, arithmetic {:.1f}, scatter {:.1f}, integration {:.1f} ns\n",
      1e9 * stages.search, 1e9 * stages.noise, 1e9 * stages.arithmetic, 1e9 * stages.scatter,
      1e9 * stages.integration);
}

std::vector<MethodRow> print_methods(const BenchPlan& plan) {
  constexpr const char* heading =
      "{:<28} {:<8}  {:>26}  {:>6}  {:>6}  {:>10}  {:>7}  {:>10}  {:>6}\n";
  print_line("\nEvery method ({} particles, one thread)\n", plan.table_particles);
  fmt::print(fmt::runtime(heading), "method", "closure", "ns per particle-step", "factor", "visits",
             "ns a visit", "numbers", "iterations", "bytes");
  fmt::print(fmt::runtime(heading), "", "", "", "", "a pair", "", "a pair", "a step", "");
  const auto rows = bench_methods(plan);
  for (const auto& row : rows) {
    if (!row.failure.empty()) {
      print_line("{:<28} {:<8}  failed: {}\n", row.method, row.closure, row.failure);
      continue;
    }
    print_line("{:<28} {:<8}  {:>26}  {:>6.2f}  {:>6.1f}  {:>10.1f}  {:>7.1f}  {:>10.1f}  {:>6}\n",
               row.method, row.closure, text(row.nanoseconds), row.factor, row.visits,
               row.nanoseconds_per_visit(), row.numbers, row.iterations, bytes_text(row.bytes));
    print_stages(row.stages);
  }
  return rows;
}

nlohmann::json quartiles(const Spread& spread) {
  return {{"lower", spread.lower}, {"upper", spread.upper}, {"samples", spread.samples}};
}

nlohmann::json number_or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

}  // namespace

nlohmann::json to_json(const StageSeconds& stages) {
  return {{"search", 1e9 * stages.search},
          {"noise", 1e9 * stages.noise},
          {"arithmetic", 1e9 * stages.arithmetic},
          {"scatter", 1e9 * stages.scatter},
          {"integration", 1e9 * stages.integration}};
}

nlohmann::json to_json(const KernelRow& row) {
  nlohmann::json json = {{"kernel", row.kernel},
                         {"particles", row.particles},
                         {"threads", row.threads},
                         {"ns_per_particle_step", row.nanoseconds.median},
                         {"spread", quartiles(row.nanoseconds)},
                         {"naive_ns_per_particle_step", nullptr},
                         {"naive_spread", nullptr},
                         {"speed_up", nullptr},
                         {"bytes_per_particle", number_or_null(row.bytes)}};
  if (row.has_naive()) {
    json["naive_ns_per_particle_step"] = row.naive.median;
    json["naive_spread"] = quartiles(row.naive);
    json["speed_up"] = row.speed_up();
  }
  if (row.stages.total() > 0) json["stage_ns_per_particle_step"] = to_json(row.stages);
  return json;
}

nlohmann::json to_json(const SceneRow& row) {
  return {{"scene", row.scene},
          {"kernel", row.kernel},
          {"particles", row.particles},
          {"ns_per_particle_step", row.nanoseconds.median},
          {"spread", quartiles(row.nanoseconds)},
          {"share_of_full", row.share},
          {"bytes_per_particle", number_or_null(row.bytes)},
          {"stage_ns_per_particle_step", to_json(row.stages)}};
}

nlohmann::json to_json(const MethodRow& row) {
  nlohmann::json json = {
      {"method", row.method}, {"closure", row.closure}, {"particles", row.particles}};
  if (!row.failure.empty()) {
    json["failure"] = row.failure;
    return json;
  }
  json["ns_per_particle_step"] = row.nanoseconds.median;
  json["spread"] = quartiles(row.nanoseconds);
  json["pairs_per_particle"] = row.pairs;
  json["visits_per_pair"] = row.visits;
  json["bytes_per_particle"] = number_or_null(row.bytes);
  json["ns_per_pair_visit"] = row.nanoseconds_per_visit();
  json["solver_iterations_per_step"] = row.iterations;
  json["random_numbers_per_pair"] = row.numbers;
  if (row.factor > 0) json["factor"] = row.factor;
  json["stage_ns_per_particle_step"] = to_json(row.stages);
  return json;
}

void run_bench(const BenchArguments& arguments) {
  for (const auto& file : {arguments.json, arguments.page}) {
    if (!file.empty()) check_writable(file);
  }
  BenchPlan plan = arguments.quick ? quick_plan() : full_plan();
  if (!arguments.threads.empty()) plan.threads = arguments.threads;
  if (!arguments.particles.empty()) plan.particles = arguments.particles;
  const unsigned most_threads = *std::max_element(plan.threads.begin(), plan.threads.end());
  auto origin = provenance(most_threads, 1, command(arguments));
  origin["usable_cpus"] = usable_processors();
  print_line("{}\n{} usable CPUs, vector instructions {}\n", origin["cpu"].get<std::string>(),
             usable_processors(), origin["instructions"].get<std::string>());
  print_line(
      "Soft fluid with friction and conduction, density 3, time step 0.01. Medians and quartiles\n"
      "of at most {} interleaved samples, by the clock on the wall. Force-parallel is\n"
      "averaged-drift, sequential is shardlow-s1; naive is the same scheme in plain code.\n"
      "Bytes are of memory per particle, beyond the 60 of its state.\n",
      plan.sampling.samples);
  const auto kernels = print_kernels(plan);
  const auto scenes = print_scenes(plan);
  const auto methods = print_methods(plan);
  nlohmann::json all = {{"format", "driftless-bench/1"},
                        {"provenance", origin},
                        {"rows", all_to_json(kernels)},
                        {"scenes", all_to_json(scenes)},
                        {"methods", all_to_json(methods)}};
  if (arguments.scaling || !arguments.page.empty()) {
    all["scaling"] = run_scaling(scaling_plan(arguments.quick));
  }
  if (!arguments.json.empty()) write_atomically(arguments.json, all.dump(2) + "\n");
  if (!arguments.page.empty()) write_atomically(arguments.page, bench_page(all));
}

}  // namespace driftless
