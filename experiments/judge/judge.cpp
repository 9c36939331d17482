#include "experiments/judge/judge.hpp"

#include <fmt/format.h>

#include <map>
#include <set>

#include "experiments/judge/trade.hpp"
#include "experiments/kept_parts.hpp"
#include "experiments/named_list.hpp"
#include "experiments/processors.hpp"
#include "experiments/provenance.hpp"
#include "experiments/study_parts.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

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
  void run_parts();
  json method_record(const Candidate& candidate) const;
  Conclusion conclude(const Candidate& candidate, const Examination& examination) const;

  const std::vector<Candidate>& candidates_;
  const std::vector<const Examination*>& examinations_;
  const JudgeOptions& options_;
  unsigned threads_;
  std::map<std::pair<const Candidate*, const Examination*>, Records> records_;
};

void Judgement::run_parts() {
  const auto& conditions = options_.conditions;
  std::vector<KeptPart> kept;
  std::vector<std::pair<Records*, std::string>> places;
  for (const auto& candidate : candidates_) {
    for (const auto* examination : examinations_) {
      Records& records = records_[{&candidate, examination}];
      for (auto& part : examination->parts(candidate, conditions)) {
        kept.push_back(
            {.name = fmt::format("{}, {}, {}", candidate.name(), examination->name, part.name),
             .identity = {driftless::to_json(candidate.choice), examination->name, part.name,
                          conditions.seed, to_string(conditions.depth)},
             .cost = part.cost,
             .run = [run = std::move(part.run)](const PartPlace&) { return run(); }});
        places.emplace_back(&records, part.name);
      }
    }
  }
  run_kept_parts(kept, {options_.directory, threads_, options_.command, options_.quiet});
  for (std::size_t n = 0; n < kept.size(); ++n) {
    (*places[n].first)[places[n].second] = std::move(kept[n].record);
  }
}

Conclusion Judgement::conclude(const Candidate& candidate, const Examination& examination) const {
  return examination.conclude(candidate, options_.conditions,
                              records_.at({&candidate, &examination}));
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
  run_parts();
  const auto depth = to_string(options_.conditions.depth);
  json judgement = {
      {"format", judgement_format},
      {"provenance", provenance(threads_, options_.conditions.seed, options_.command)},
      {"depth", depth},
      {"examinations", json::array()},
      {"methods", json::array()}};
  for (const auto* examination : examinations_) {
    judgement["examinations"].push_back({{"name", examination->name},
                                         {"title", examination->title},
                                         {"question", examination->question},
                                         {"depth", depth},
                                         {"commit", judgement["provenance"]["commit"]},
                                         {"command", options_.command}});
  }
  for (const auto& candidate : candidates_) {
    judgement["methods"].push_back(method_record(candidate));
  }
  judgement["trade"] = trade_front(judgement);
  return judgement;
}

std::set<std::string> names_of(const json& list) {
  std::set<std::string> names;
  for (const auto& one : list) names.insert(one["name"]);
  return names;
}

/// "quick", "full", or "full and quick".
std::string depths_of(const json& examinations) {
  std::set<std::string> depths;
  for (const auto& examination : examinations) depths.insert(examination["depth"]);
  return fmt::format("{}", fmt::join(depths, " and "));
}

}  // namespace

json united(const json& earlier, json judgement) {
  if (names_of(earlier["methods"]) != names_of(judgement["methods"])) return judgement;
  const json all =
      united_by_name(examinations(), judgement["examinations"], earlier["examinations"]);
  for (auto& method : judgement["methods"]) {
    const json* before = find_named(earlier["methods"], method["name"]);
    for (const auto& examination : all) {
      const std::string name = examination["name"];
      if (method["conclusions"].contains(name)) continue;
      method["conclusions"][name] = (*before)["conclusions"][name];
    }
  }
  judgement["examinations"] = all;
  judgement["depth"] = depths_of(all);
  judgement["trade"] = trade_front(judgement);
  return judgement;
}

json run_judgement(const std::vector<Candidate>& candidates,
                   const std::vector<const Examination*>& examinations,
                   const JudgeOptions& options) {
  return Judgement(candidates, examinations, options).run();
}

}  // namespace driftless::judge
