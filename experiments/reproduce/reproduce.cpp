#include "experiments/reproduce/reproduce.hpp"

#include <fmt/format.h>

#include <mutex>

#include "experiments/kept_parts.hpp"
#include "experiments/processors.hpp"
#include "experiments/provenance.hpp"
#include "experiments/reproduce/papers.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

/// An experiment under way.
struct Trial {
  const Experiment* experiment;
  std::vector<std::string> parts;
  std::map<std::string, std::string> failures;  ///< by part, whichever thread was first

  /// Of the first part in the experiment's own order, lest the report depend on the threads.
  const std::string* failed_part() const {
    for (const auto& part : parts) {
      if (failures.contains(part)) return &part;
    }
    return nullptr;
  }
};

/// "abcdef0", "abcdef0-dirty".
std::string commit_text(const json& provenance) {
  return provenance["commit"].get<std::string>().substr(0, 7) +
         (provenance["dirty"].get<bool>() ? "-dirty" : "");
}

std::string replacement_remark(const MethodChoice& method) {
  return to_string(method) +
         " runs here at the same steps in the place of the paper's method, or of ours where the "
         "paper names none.";
}

class Reproduction {
 public:
  Reproduction(const std::vector<const Experiment*>& experiments, const ReproduceOptions& options)
      : options_(options), threads_(options.threads > 0 ? options.threads : usable_processors()) {
    for (const auto* experiment : experiments) trials_.push_back({experiment, {}, {}});
    provenance_ = provenance(threads_, options.conditions.seed, options.command);
  }

  json run();

 private:
  /// An experiment's name, with the method that was chosen for it.
  std::string titled(const Experiment& experiment) const;
  KeptPart kept(Trial& trial, Part part);
  json record_of(const Trial& trial, const Records& records) const;

  const ReproduceOptions& options_;
  unsigned threads_;
  json provenance_;
  std::vector<Trial> trials_;
  std::mutex failing_;
};

std::string Reproduction::titled(const Experiment& experiment) const {
  const std::string name(experiment.name);
  return options_.conditions.method ? name + " with " + to_string(*options_.conditions.method)
                                    : name;
}

KeptPart Reproduction::kept(Trial& trial, Part part) {
  trial.parts.push_back(part.name);
  const auto run = [this, &trial, name = part.name,
                    work = std::move(part.run)](const PartPlace& place) -> json {
    try {
      return work(place);
    } catch (const std::exception& failure) {
      const std::lock_guard lock(failing_);
      trial.failures[name] = failure.what();
      return nullptr;
    }
  };
  const auto& conditions = options_.conditions;
  const json method = conditions.method ? driftless::to_json(*conditions.method) : json();
  return {.name = fmt::format("{}, {}", titled(*trial.experiment), part.name),
          .identity = {trial.experiment->name, part.name, conditions.seed,
                       to_string(conditions.effort), method},
          .cost = part.cost,
          .alone = part.wide,
          .run = run};
}

json Reproduction::record_of(const Trial& trial, const Records& records) const {
  const Experiment& experiment = *trial.experiment;
  json record = {{"name", experiment.name},
                 {"source", experiment.source},
                 {"title", experiment.title},
                 {"question", experiment.question},
                 {"effort", to_string(options_.conditions.effort)},
                 {"command", options_.command},
                 {"commit", commit_text(provenance_)}};
  if (options_.conditions.method) record["method"] = to_string(*options_.conditions.method);
  Outcome outcome;
  if (const auto* part = trial.failed_part()) {
    record["failure"] = fmt::format("{}: {}", *part, trial.failures.at(*part));
  } else {
    try {
      outcome = experiment.conclude(options_.conditions, records);
      if (const auto& method = options_.conditions.method) {
        outcome.remarks.insert(outcome.remarks.begin(), replacement_remark(*method));
      }
    } catch (const std::exception& failure) {
      record["failure"] = failure.what();
    }
  }
  record.update(to_json(outcome));
  return record;
}

json Reproduction::run() {
  std::vector<KeptPart> parts;
  for (auto& trial : trials_) {
    for (auto& part : trial.experiment->parts(options_.conditions)) {
      parts.push_back(kept(trial, std::move(part)));
    }
  }
  run_kept_parts(parts, {options_.directory, threads_, options_.command, options_.quiet});
  json papers = {
      {"format", papers_format}, {"provenance", provenance_}, {"experiments", json::array()}};
  auto part = parts.begin();
  for (const auto& trial : trials_) {
    Records records;
    for (const auto& name : trial.parts) records[name] = std::move((part++)->record);
    papers["experiments"].push_back(record_of(trial, records));
  }
  return papers;
}

}  // namespace

json run_experiments(const std::vector<const Experiment*>& experiments,
                     const ReproduceOptions& options) {
  return Reproduction(experiments, options).run();
}

}  // namespace driftless::reproduce
