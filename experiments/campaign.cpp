#include "experiments/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <set>

#include "experiments/answers.hpp"
#include "experiments/cell.hpp"
#include "experiments/files.hpp"
#include "experiments/interrupt.hpp"
#include "experiments/kept_parts.hpp"
#include "experiments/parallel.hpp"
#include "experiments/processors.hpp"
#include "experiments/progress.hpp"
#include "experiments/provenance.hpp"
#include "experiments/result_file.hpp"
#include "experiments/scene_keys.hpp"
#include "experiments/timing.hpp"

namespace driftless {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct Cell {
  Cell(const PreparedScene& scene, const MethodChoice& method, double step, fs::path kept)
      : prepared(&scene), choice(&method), time_step(step), file(std::move(kept)) {}

  const PreparedScene* prepared;
  const MethodChoice* choice;
  double time_step;
  fs::path file;  ///< where it is kept once finished
  json record;    ///< null until finished
  std::vector<ReplicaResult> replicas;
  std::atomic<unsigned> remaining = 0;

  bool is_refused() const { return !record.is_null() && record["status"] == "not_applicable"; }
  std::string name() const {
    return fmt::format("{}, {}, step {}", prepared->scene().name, choice->name, time_step);
  }
};

class Campaign {
 public:
  Campaign(const Study& study, const CampaignOptions& options)
      : study_(study),
        options_(options),
        threads_(options.threads > 0 ? options.threads : usable_processors()) {}

  json run();

 private:
  void prepare_scenes();
  void list_cells();
  Plan plan() const;
  void tell_of_discarded(const Plan& now) const;
  std::string interrupted() const;
  std::string cell_key(const Scene& scene, const MethodChoice& choice, double time_step) const;
  double predicted_cost(const Cell& cell) const;
  void run_cells();
  void run_one(Cell& cell, unsigned replica, Progress& progress);
  void time_all();
  json scene_records() const;
  json method_records() const;

  const Study& study_;
  const CampaignOptions& options_;
  unsigned threads_;
  unsigned threads_of_a_run_ = 1;
  std::vector<std::unique_ptr<PreparedScene>> prepared_;
  std::vector<std::unique_ptr<Cell>> cells_;
  std::atomic<std::size_t> finished_ = 0, planned_ = 0;  ///< cells whose methods apply
};

void Campaign::prepare_scenes() {
  prepared_.resize(study_.scenes.size());
  parallel(prepared_.size(), threads_, [&](std::size_t n) {
    prepared_[n] = std::make_unique<PreparedScene>(study_.scenes[n], study_.seed, study_.replicas);
  });
}

std::string Campaign::cell_key(const Scene& scene, const MethodChoice& choice,
                               double time_step) const {
  const json identity = {program_fingerprint(),
                         to_json(scene),
                         choice.name,
                         to_json(choice.options),
                         time_step,
                         study_.equilibrate,
                         study_.measure,
                         study_.sample_every,
                         study_.replicas,
                         study_.seed};
  return fingerprint(identity.dump());
}

void Campaign::list_cells() {
  for (const auto& prepared : prepared_) {
    for (const auto& choice : study_.methods) {
      const auto refused = refusal(*find_method(choice.name), prepared->fluid(), choice.options);
      for (const double time_step : study_.time_steps) {
        const auto file = cell_key(prepared->scene(), choice, time_step) + ".json";
        auto cell = std::make_unique<Cell>(*prepared, choice, time_step,
                                           options_.directory / "cells" / file);
        if (refused) cell->record = refused_cell(*prepared, choice, time_step, *refused);
        if (!refused) cell->record = kept_record(cell->file);
        cells_.push_back(std::move(cell));
      }
    }
  }
}

Plan Campaign::plan() const {
  Plan plan{program_fingerprint(), options_.command, {}, false};
  for (const auto& cell : cells_) {
    if (!cell->is_refused()) plan.cells.push_back({cell->name(), cell->file.filename().string()});
  }
  return plan;
}

/// Cells that were finished here and that this run cannot take up, because they are another build's
/// or another study's.
void Campaign::tell_of_discarded(const Plan& now) const {
  const auto before = read_plan(options_.directory);
  if (!before || options_.quiet) return;
  std::set<std::string> known;
  for (const auto& cell : now.cells) known.insert(cell.file);
  const auto discarded =
      std::count_if(before->cells.begin(), before->cells.end(), [&](const Plan::Cell& cell) {
        return !known.contains(cell.file) && fs::exists(options_.directory / "cells" / cell.file);
      });
  if (discarded == 0) return;
  fmt::print(stderr, "{} finished {} in {} not used: {} of another {}\n", discarded,
             discarded == 1 ? "cell" : "cells",
             options_.directory.string() + (discarded == 1 ? " is" : " are"),
             discarded == 1 ? "it is" : "they are",
             before->program == now.program ? "study" : "build of the program");
}

std::string Campaign::interrupted() const {
  const std::size_t planned = planned_;
  const std::string done =
      planned == 0 ? "no cell is finished yet"
                   : fmt::format("{} of {} cells are finished and kept", finished_.load(), planned);
  return fmt::format("interrupted; {}; the same command goes on: {}", done, options_.command);
}

double Campaign::predicted_cost(const Cell& cell) const {
  return static_cast<double>(StepPlan(study_, cell.time_step).steps()) *
         static_cast<double>(cell.prepared->scene().particles);
}

void Campaign::run_one(Cell& cell, unsigned replica, Progress& progress) {
  progress.replica_started();
  cell.replicas[replica] =
      run_replica(*cell.prepared, study_, *cell.choice, cell.time_step, replica, threads_of_a_run_);
  progress.replica_finished(predicted_cost(cell));
  if (--cell.remaining > 0) return;
  cell.record = cell_record(*cell.prepared, study_, *cell.choice, cell.time_step, cell.replicas);
  cell.replicas = {};
  write_atomically(cell.file, cell.record.dump());
  ++finished_;
  progress.cell_finished(cell.name(), cell.record["status"]);
}

void Campaign::run_cells() {
  std::vector<std::pair<Cell*, unsigned>> runs;
  double cost = 0;
  for (const auto& cell : cells_) {
    if (!cell->record.is_null()) continue;
    cell->replicas.resize(study_.replicas);
    cell->remaining = study_.replicas;
    for (unsigned replica = 0; replica < study_.replicas; ++replica) {
      runs.emplace_back(cell.get(), replica);
      cost += predicted_cost(*cell);
    }
  }
  // The longest first, so that no core waits for a straggler at the end.
  std::stable_sort(runs.begin(), runs.end(), [&](const auto& a, const auto& b) {
    return predicted_cost(*a.first) > predicted_cost(*b.first);
  });
  const auto count = [&](auto&& which) {
    return static_cast<std::size_t>(std::count_if(cells_.begin(), cells_.end(), which));
  };
  const auto refused = count([](const auto& cell) { return cell->is_refused(); });
  const auto finished = count([](const auto& cell) { return !cell->record.is_null(); });
  finished_ = finished - refused;
  planned_ = cells_.size() - refused;
  Progress progress("cells", cells_.size() - refused, cost, options_.quiet);
  progress.cells_resumed(finished - refused);
  // Whole runs side by side come first, as they need not wait for each other.
  const auto at_once = std::clamp<std::size_t>(runs.size(), 1, threads_);
  threads_of_a_run_ = threads_ / static_cast<unsigned>(at_once);
  parallel(runs.size(), threads_,
           [&](std::size_t n) { run_one(*runs[n].first, runs[n].second, progress); });
}

void Campaign::time_all() {
  std::vector<TimedCell> timed;
  std::vector<json*> records;
  std::string keys;
  for (const auto& cell : cells_) {
    if (cell->record["status"] == "not_applicable") continue;
    timed.push_back({cell->prepared, cell->choice, cell->time_step});
    records.push_back(&cell->record);
    keys += cell->file.filename().string();
  }
  // One pass over all cells, or none: times of different passes do not compare.
  const auto file = options_.directory / "timing.json";
  json timing = kept_record(file);
  if (!timing.is_object() || timing.value("cells", "") != fingerprint(keys)) {
    timing = {{"cells", fingerprint(keys)}, {"costs", json::array()}};
    for (const auto& cost : time_cells(timed)) {
      timing["costs"].push_back({cost.seconds, cost.spread});
    }
    write_atomically(file, timing.dump());
  }
  for (std::size_t n = 0; n < timed.size(); ++n) {
    auto& cost = (*records[n])["cost"];
    const double seconds = timing["costs"][n][0], spread = timing["costs"][n][1];
    cost["core_seconds_per_time"] = seconds > 0 ? json(seconds / timed[n].time_step) : json();
    cost["spread"] = spread / timed[n].time_step;
  }
}

json Campaign::scene_records() const {
  json scenes = json::array();
  for (const auto& prepared : prepared_) {
    const double relaxation = prepared->relaxation();
    const double kinetic = prepared->kinetic_relaxation();
    const auto finite = [](double time) { return std::isfinite(time) ? json(time) : json(); };
    json record = {{"name", prepared->scene().name},
                   {"preset", prepared->scene().preset},
                   {"parameters", scene_parameters(prepared->scene())},
                   {"kinetic_relaxation_time", finite(kinetic)},
                   {"resolves_kinetic_energy", resolves(study_, kinetic)},
                   {"energy_per_particle", prepared->energy_per_particle()}};
    if (prepared->fluid().isothermal()) {
      if (!resolves(study_, kinetic)) {
        record["note"] = fmt::format(
            "kinetic energies relax in about {:.3g}: to resolve them takes equilibration of {:.3g} "
            "and measurement of {:.3g}",
            kinetic, 5 * kinetic, 20 * kinetic);
      }
      scenes.push_back(record);
      continue;
    }
    record["relaxation_time"] = finite(relaxation);
    record["resolves_internal_energy"] = resolves(study_, relaxation);
    const double longest = std::max(relaxation, std::isfinite(kinetic) ? kinetic : 0);
    if (std::isfinite(longest) && !resolves(study_, longest)) {
      record["note"] = fmt::format(
          "internal energies relax in about {:.3g}, kinetic energies in about {:.3g}: to resolve "
          "both takes equilibration of {:.3g} and measurement of {:.3g}",
          relaxation, kinetic, 5 * longest, 20 * longest);
    }
    scenes.push_back(record);
  }
  return scenes;
}

json Campaign::method_records() const {
  json records = json::array();
  std::set<std::string> listed;
  for (const auto& choice : study_.methods) {
    if (!listed.insert(choice.name).second) continue;
    const Method& method = *find_method(choice.name);
    records.push_back({{"name", method.name},
                       {"title", method.title},
                       {"reference", method.reference},
                       {"conserves", method.conserves},
                       {"consistent", method.consistent},
                       {"isothermal", method.isothermal},
                       {"galilean", method.galilean}});
  }
  return records;
}

json Campaign::run() {
  make_output_folder(options_.directory, "cells");
  const InterruptNotice notice([this] { return interrupted(); });
  prepare_scenes();
  list_cells();
  const Plan planned = plan();
  tell_of_discarded(planned);
  write_plan(planned, options_.directory);
  run_cells();
  time_all();
  json result = {{"format", "driftless-result/1"},
                 {"name", study_.name},
                 {"provenance", provenance(threads_, study_.seed, options_.command)},
                 {"study", to_json(study_)},
                 {"scenes", scene_records()},
                 {"methods", method_records()},
                 {"cells", json::array()}};
  for (auto& cell : cells_) {
    if (!cell->record["cost"].contains("core_seconds_per_time")) {
      cell->record["cost"]["core_seconds_per_time"] = nullptr;
      cell->record["cost"]["spread"] = 0;
    }
    result["cells"].push_back(std::move(cell->record));
  }
  add_answers(result);
  return result;
}

}  // namespace

json run_campaign(const Study& study, const CampaignOptions& options) {
  return Campaign(study, options).run();
}

}  // namespace driftless
