#include "experiments/judge/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "experiments/files.hpp"
#include "experiments/interrupt.hpp"
#include "experiments/judge/trade.hpp"
#include "experiments/parallel.hpp"
#include "experiments/processors.hpp"
#include "experiments/progress.hpp"
#include "experiments/provenance.hpp"
#include "experiments/study_parts.hpp"
#include "experiments/text_file.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct Job {
  const Examination* examination;
  const Candidate* candidate;
  Part part;
  fs::path file;  ///< where its record is kept once finished
  json record;    ///< null until finished
};

class Judgement {
 public:
  Judgement(const std::vector<Candidate>& candidates,
            const std::vector<const Examination*>& examinations, const JudgeOptions& options)
      : candidates_(candidates),
        examinations_(examinations),
        options_(options),
        threads_(options.threads > 0 ? options.threads : usable_processors()) {}

  json run();

 private:
  void list_jobs();
  void run_jobs();
  json method_record(const Candidate& candidate) const;
  Conclusion conclude(const Candidate& candidate, const Examination& examination) const;
  std::string interrupted() const;

  const std::vector<Candidate>& candidates_;
  const std::vector<const Examination*>& examinations_;
  const JudgeOptions& options_;
  unsigned threads_;
  std::vector<Job> jobs_;
  std::atomic<std::size_t> finished_ = 0;
};

void Judgement::list_jobs() {
  const auto& conditions = options_.conditions;
  for (const auto& candidate : candidates_) {
    for (const auto* examination : examinations_) {
      for (auto& part : examination->parts(candidate, conditions)) {
        const json identity = {program_fingerprint(), driftless::to_json(candidate.choice),
                               examination->name,     part.name,
                               conditions.seed,       to_string(conditions.depth)};
        auto file = options_.directory / "parts" / (fingerprint(identity.dump()) + ".json");
        json record;
        if (fs::exists(file)) {
          record = json::parse(read_text_file(file), nullptr, false);
          if (record.is_discarded()) record = nullptr;
        }
        if (!record.is_null()) ++finished_;
        jobs_.push_back(
            {examination, &candidate, std::move(part), std::move(file), std::move(record)});
      }
    }
  }
}

std::string Judgement::interrupted() const {
  return fmt::format(
      "interrupted; {} of {} parts are finished and kept; the same command goes on: {}",
      finished_.load(), jobs_.size(), options_.command);
}

void Judgement::run_jobs() {
  std::vector<Job*> open;
  double cost = 0;
  for (auto& job : jobs_) {
    if (!job.record.is_null()) continue;
    open.push_back(&job);
    cost += job.part.cost;
  }
  // The longest first, so that no core waits for a straggler at the end.
  std::stable_sort(open.begin(), open.end(),
                   [](const Job* a, const Job* b) { return a->part.cost > b->part.cost; });
  Progress progress("parts", jobs_.size(), cost, options_.quiet);
  progress.cells_resumed(finished_);
  parallel(open.size(), threads_, [&](std::size_t n) {
    Job& job = *open[n];
    progress.replica_started();
    job.record = job.part.run();
    progress.replica_finished(job.part.cost);
    write_atomically(job.file, job.record.dump());
    ++finished_;
    progress.cell_finished(
        fmt::format("{}, {}, {}", job.candidate->name(), job.examination->name, job.part.name),
        "ok");
  });
}

Conclusion Judgement::conclude(const Candidate& candidate, const Examination& examination) const {
  Records records;
  for (const auto& job : jobs_) {
    if (job.candidate == &candidate && job.examination == &examination) {
      records[job.part.name] = job.record;
    }
  }
  return examination.conclude(candidate, options_.conditions, records);
}

json claims(const Method& method) {
  return {{"weak_order", method.weak_order},
          {"noise_free_order", method.noise_free_order},
          {"energy_ideal", method.energy_ideal == EnergyClaim::exact ? "exact" : "drifts"},
          {"energy_with_potential",
           method.energy_with_potential == EnergyClaim::exact ? "exact" : "drifts"},
          {"consistent", method.consistent},
          {"galilean", method.galilean},
          {"order_independent", method.order_independent},
          {"pair_law_exact", method.pair_law_exact}};
}

json Judgement::method_record(const Candidate& candidate) const {
  const Method& method = candidate.method();
  json conclusions = json::object();
  for (const auto* examination : examinations_) {
    conclusions[std::string(examination->name)] = to_json(conclude(candidate, *examination));
  }
  return {{"name", candidate.name()},
          {"method", method.name},
          {"options", driftless::to_json(candidate.choice.options)},
          {"title", method.title},
          {"reference", method.reference},
          {"claims", claims(method)},
          {"conclusions", conclusions}};
}

json Judgement::run() {
  make_output_folder(options_.directory, "parts");
  const InterruptNotice notice([this] { return interrupted(); });
  list_jobs();
  run_jobs();
  json judgement = {
      {"format", "driftless-judgement/1"},
      {"provenance", provenance(threads_, options_.conditions.seed, options_.command)},
      {"depth", to_string(options_.conditions.depth)},
      {"examinations", json::array()},
      {"methods", json::array()}};
  for (const auto* examination : examinations_) {
    judgement["examinations"].push_back({{"name", examination->name},
                                         {"title", examination->title},
                                         {"question", examination->question}});
  }
  for (const auto& candidate : candidates_) {
    judgement["methods"].push_back(method_record(candidate));
  }
  judgement["trade"] = trade_front(judgement);
  return judgement;
}

}  // namespace

json run_judgement(const std::vector<Candidate>& candidates,
                   const std::vector<const Examination*>& examinations,
                   const JudgeOptions& options) {
  return Judgement(candidates, examinations, options).run();
}

}  // namespace driftless::judge
