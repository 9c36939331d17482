#include "experiments/bench/bench_sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

namespace driftless {
namespace {

using nlohmann::json;

double time_of(const json& row) { return row["ns_per_particle_step"]; }
double stage(const json& row, const char* name) { return row["stage_ns_per_particle_step"][name]; }
double stage_sum(const json& row) {
  double sum = 0;
  for (const auto& [name, value] : row["stage_ns_per_particle_step"].items()) {
    sum += value.get<double>();
  }
  return sum;
}

/// The stage of which one row has most more than another, and how much.
std::pair<std::string, double> largest_growth(const json& from, const json& to) {
  std::pair<std::string, double> most{"", -1e300};
  for (const auto& [name, value] : to["stage_ns_per_particle_step"].items()) {
    const double growth = value.get<double>() - stage(from, name.c_str());
    if (growth > most.second) most = {name, growth};
  }
  return most;
}

/// The rows of a kernel on so many threads, by particles.
std::vector<json> rows_of(const json& rows, const std::string& kernel, unsigned threads) {
  std::vector<json> found;
  for (const auto& row : rows) {
    if (row["kernel"] == kernel && row["threads"] == threads) found.push_back(row);
  }
  std::sort(found.begin(), found.end(),
            [](const json& a, const json& b) { return a["particles"] < b["particles"]; });
  if (found.empty()) throw std::invalid_argument("no rows of " + kernel);
  return found;
}

json limit_of(const json& bench, const std::string& kernel, unsigned threads) {
  return rows_of(bench["scaling"]["limits"], kernel, threads).front();
}

unsigned most_threads(const json& rows) {
  unsigned most = 1;
  for (const auto& row : rows) most = std::max(most, row["threads"].get<unsigned>());
  return most;
}

/// A percentage in whole numbers.
std::string percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

std::string large_limits(const json& bench, const std::string& kernel, const json& largest) {
  const unsigned threads = largest["threads"];
  const auto limit = limit_of(bench, kernel, threads);
  const double time = time_of(largest);
  const double arithmetic = limit["arithmetic_ns_per_particle_step"],
               memory = limit["memory_ns_per_particle_step"];
  return fmt::format(
      "on {} {:.0f} ns, of which the memory limit ({:.0f} bytes at {:.1f} GB/s) explains {} and "
      "the arithmetic {}: {} is the nearer limit",
      threads == 1 ? "one thread" : fmt::format("{} threads", threads), time,
      limit["bytes_per_particle_step"].get<double>(),
      1e-9 * limit["triad_bytes_per_second"].get<double>(), percent(memory / time),
      percent(arithmetic / time), memory > arithmetic ? "memory" : "arithmetic");
}

}  // namespace

std::string sizes_sentence(const json& bench, const std::string& kernel) {
  const auto& sizes = bench["scaling"]["sizes"];
  const auto alone = rows_of(sizes, kernel, 1);
  const auto small = *std::find_if(alone.begin(), alone.end(), [&](const json& row) {
    return row["particles"] == bench["scaling"]["cached_particles"];
  });
  const auto& large = alone.back();
  const auto growth = largest_growth(small, large);
  std::string text = fmt::format(
      "At N = {} on one thread noise and arithmetic take {} of a step's {:.0f} ns, the search {}. ",
      small["particles"].get<std::size_t>(),
      percent((stage(small, "noise") + stage(small, "arithmetic")) / stage_sum(small)),
      time_of(small), percent(stage(small, "search") / stage_sum(small)));
  text += fmt::format("At N = {} it is {}", large["particles"].get<std::size_t>(),
                      large_limits(bench, kernel, large));
  const unsigned most = most_threads(sizes);
  if (most > 1) {
    text += "; " + large_limits(bench, kernel, rows_of(sizes, kernel, most).back());
  }
  return text + fmt::format(
                    ". From the small system to the large one the stage that changes most "
                    "is {} ({:+.0f} ns).",
                    growth.first, growth.second);
}

std::string memory_sentence(const json& bench) {
  std::string text = "Memory beyond the state";
  const auto& sizes = bench["scaling"]["sizes"];
  for (const char* kernel : {"force-parallel", "sequential"}) {
    const auto large = rows_of(sizes, kernel, 1).back();
    const auto& bytes = large["bytes_per_particle"];
    text += fmt::format("{} {} {}", text.back() == 'e' ? ":" : ";", kernel,
                        bytes.is_null()
                            ? "not known"
                            : fmt::format("{:.0f} bytes a particle at N = {}", bytes.get<double>(),
                                          large["particles"].get<std::size_t>()));
  }
  return text + ".";
}

std::string threads_sentence(const json& bench) {
  const auto& rows = bench["scaling"]["threads"];
  const unsigned most = most_threads(rows);
  if (most == 1) return "This machine lends one thread.";
  std::string text;
  for (const char* kernel : {"force-parallel", "sequential"}) {
    const auto one = rows_of(rows, kernel, 1).back(), all = rows_of(rows, kernel, most).back();
    const double faster = time_of(one) / time_of(all);
    const double serial = (most / faster - 1) / (most - 1);
    text += fmt::format(
        "{}{} at N = {} is {:.2f} times faster on {} threads than on one{}",
        text.empty() ? "" : "; ", kernel, one["particles"].get<std::size_t>(), faster, most,
        serial > 0
            ? fmt::format(", as if {} of a step were done by one thread alone", percent(serial))
            : "");
  }
  const auto one = limit_of(bench, "force-parallel", 1),
             all = limit_of(bench, "force-parallel", most);
  return text + fmt::format(
                    ". The memory's bandwidth grows {:.2f} times, from {:.1f} to {:.1f} GB/s: what "
                    "memory limits cannot gain more.",
                    all["triad_bytes_per_second"].get<double>() /
                        one["triad_bytes_per_second"].get<double>(),
                    1e-9 * one["triad_bytes_per_second"].get<double>(),
                    1e-9 * all["triad_bytes_per_second"].get<double>());
}

std::string methods_sentence(const json& bench) {
  std::optional<json> least, most, slowest;
  const auto share = [](const json& row) {
    return (stage(row, "noise") + stage(row, "arithmetic")) / stage_sum(row);
  };
  std::size_t particles = 0;
  for (const auto& row : bench["methods"]) {
    if (!row.contains("stage_ns_per_particle_step")) continue;
    particles = row["particles"];
    if (!least || share(row) < share(*least)) least = row;
    if (!most || share(row) > share(*most)) most = row;
    if (!slowest || time_of(row) > time_of(*slowest)) slowest = row;
  }
  if (!least) return "No method could be stepped.";
  std::string text = fmt::format(
      "At N = {} on one thread noise and arithmetic take from {} of a step ({}) to {} ({}); ",
      particles, percent(share(*least)), (*least)["method"].get<std::string>(),
      percent(share(*most)), (*most)["method"].get<std::string>());
  return text +
         fmt::format(
             "the slowest, {}, visits each pair {:.1f} times a step and draws {:.1f} numbers "
             "for it, {:.0f} ns a visit.",
             (*slowest)["method"].get<std::string>(), (*slowest)["visits_per_pair"].get<double>(),
             (*slowest)["random_numbers_per_pair"].get<double>(),
             (*slowest)["ns_per_pair_visit"].get<double>());
}

std::string terms_sentence(const json& bench, const std::string& kernel) {
  std::optional<json> full;
  std::string text;
  for (const auto& row : bench["scaling"]["terms"]) {
    if (row["kernel"] != kernel) continue;
    if (!full) {
      full = row;
      continue;
    }
    const double saved = time_of(*full) - time_of(row);
    const auto where = largest_growth(row, *full);
    text += fmt::format("{}{} {} {:.0f} ns ({}), most in {} ({:+.0f} ns)", text.empty() ? "" : "; ",
                        row["scene"].get<std::string>(), saved >= 0 ? "saves" : "costs",
                        std::abs(saved), percent(std::abs(saved) / time_of(*full)), where.first,
                        -where.second);
  }
  return text +
         fmt::format(
             ". The full fluid at N = {} spends {} of its time in noise and arithmetic, "
             "the rest on what all terms share.",
             (*full)["particles"].get<std::size_t>(),
             percent((stage(*full, "noise") + stage(*full, "arithmetic")) / stage_sum(*full)));
}

}  // namespace driftless
