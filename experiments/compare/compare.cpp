#include "experiments/compare/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/compare/common_cells.hpp"
#include "experiments/compare/cost_change.hpp"
#include "experiments/compare/observable_change.hpp"

namespace driftless {
namespace {

using nlohmann::json;

/// A test of the family before its verdict: what it says in the record and how to judge it.
struct Test {
  std::size_t cell;  ///< in the record
  json record;
  double probability;
  std::optional<ObservableChange> change;  ///< nothing for a test of failures
};

json side(const json& result) {
  const auto& provenance = result["provenance"];
  json record = {{"name", result["name"]}};
  for (const char* key :
       {"version", "commit", "seed", "cpu", "instructions", "compiler", "date", "command"}) {
    if (provenance.contains(key)) record[key] = provenance[key];
  }
  return record;
}

json identities(const std::vector<const json*>& cells) {
  json all = json::array();
  for (const json* cell : cells) all.push_back(cell_identity(*cell));
  return all;
}

Run run_of(const json& base, const CommonCell& cell) {
  const json none = json::object();
  return {base["study"].value("duration", none).value("measure", 1.0),
          cell.base_scene->value("parameters", none).value("particles", 1.0)};
}

bool is_worse_than_before(const ObservableChange& change) {
  return !change.growth || *change.growth >= 0;
}

class Comparison {
 public:
  Comparison(const json& base, const json& changed, const CompareOptions& options)
      : base_(base),
        changed_(changed),
        options_(options),
        cells_(common_cells(base, changed, options.method)) {}

  json record();

 private:
  void require_all() const;
  void add_cell(const CommonCell& cell);
  void add_observable(const std::string& observable, const CommonCell& cell, const Run& run);
  void add_failures(const CommonCell& cell);
  void judge(Test& test, double adjusted);
  void judge_change(Test& test, bool significant);
  void judge_failures(Test& test, bool significant);
  double level_of_one() const {
    return options_.family_level / static_cast<double>(std::max<std::size_t>(1, tests_.size()));
  }
  void conclude(json& record) const;
  std::string verdict(const json& counts) const;

  const json &base_, &changed_;
  const CompareOptions& options_;
  CommonCells cells_;
  json records_ = json::array();
  std::vector<Test> tests_;
  bool may_fail_more_ = false;  ///< somewhere replicas fail that did not, without certainty
};

/// An observable of BASE that NEW should have and lacks; empty if there is none.
std::string missing_observable(const CommonCell& cell) {
  if ((*cell.changed)["failed_replicas"] == (*cell.changed)["replicas"]) return "";
  for (const auto& [observable, entry] : (*cell.base)["observables"].items()) {
    if (!(*cell.changed)["observables"].contains(observable)) return observable;
  }
  return "";
}

void Comparison::require_all() const {
  if (!options_.all_cells) return;
  if (const auto count = cells_.missing.size(); count > 0) {
    throw NotComparable(fmt::format(
        "NEW lacks {} of the {} cells of BASE{}: {}", count, count + cells_.common.size(),
        count > 1 ? ", the first of them" : "", cell_name(*cells_.missing.front())));
  }
  for (const auto& cell : cells_.common) {
    if (const auto observable = missing_observable(cell); !observable.empty()) {
      throw NotComparable(
          fmt::format("NEW lacks {} in the cell {}", observable, cell_name(*cell.changed)));
    }
  }
}

void Comparison::add_observable(const std::string& observable, const CommonCell& cell,
                                const Run& run) {
  if (const auto verdict = conservation_verdict(observable, cell, run)) {
    json test = {{"observable", observable},
                 {"kind", "conserved"},
                 {"base", (*cell.base)["observables"][observable]["mean"]},
                 {"new", (*cell.changed)["observables"][observable]["mean"]},
                 {"verdict", *verdict}};
    if (*verdict == "worse") test["reason"] = "no longer conserved to rounding";
    if (*verdict == "better") test["reason"] = "now conserved to rounding";
    records_.back()["tests"].push_back(test);
    return;
  }
  const auto change = observable_change(observable, cell, run);
  if (!change) return;
  tests_.push_back({records_.size() - 1,
                    {{"observable", observable},
                     {"kind", "mean"},
                     {"base", change->base},
                     {"new", change->changed},
                     {"difference", change->difference.value},
                     {"error", change->difference.error},
                     {"degrees_of_freedom", std::min(change->difference.degrees_of_freedom, 1e6)},
                     {"effect", change->effect()},
                     {"share", change->is_share},
                     {"probability", change->difference.probability}},
                    change->difference.probability,
                    change});
}

void Comparison::add_failures(const CommonCell& cell) {
  const unsigned base = (*cell.base)["failed_replicas"],
                 changed = (*cell.changed)["failed_replicas"];
  const unsigned of_base = (*cell.base)["replicas"], of_new = (*cell.changed)["replicas"];
  if (base == 0 && changed == 0) return;
  const double probability = fisher_probability(base, of_base, changed, of_new);
  tests_.push_back({records_.size() - 1,
                    {{"observable", "failures"},
                     {"kind", "failures"},
                     {"base", base},
                     {"new", changed},
                     {"base_replicas", of_base},
                     {"new_replicas", of_new},
                     {"probability", probability}},
                    probability,
                    std::nullopt});
}

void Comparison::add_cell(const CommonCell& cell) {
  records_.push_back(cell_identity(*cell.base));
  json& record = records_.back();
  record["tests"] = json::array();
  const Run run = run_of(base_, cell);
  for (const auto& [observable, entry] : (*cell.base)["observables"].items()) {
    if ((*cell.changed)["observables"].contains(observable)) add_observable(observable, cell, run);
  }
  add_failures(cell);
}

void Comparison::judge_change(Test& test, bool significant) {
  const auto& change = *test.change;
  const double detectable =
      change.effect_of(detectable_difference(change.difference, level_of_one()));
  test.record["detectable"] = detectable;
  const bool is_large = change.effect() >= options_.minimum_effect;
  const double wanted = change.is_share ? options_.wanted_effect
                                        : std::max(options_.wanted_effect, change.base_effect());
  std::string verdict = "same";
  if (significant && is_large) {
    const bool worse = is_worse_than_before(change);
    verdict = worse ? "worse" : "better";
    test.record["reason"] =
        change.growth ? fmt::format("the {} {}", change.grows(), worse ? "grew" : "shrank")
                      : "changed, and nothing exact says that it may";
  } else if (significant) {
    test.record["reason"] = "significant, but below the minimum effect";
  } else if (detectable > wanted) {
    verdict = "too_little_data";
  }
  test.record["verdict"] = verdict;
}

void Comparison::judge_failures(Test& test, bool significant) {
  const unsigned base = test.record["base"], changed = test.record["new"];
  const unsigned of_base = test.record["base_replicas"], of_new = test.record["new_replicas"];
  const double surest = std::min(fisher_probability(0, of_base, of_new, of_new),
                                 fisher_probability(of_base, of_base, 0, of_new));
  const bool more = changed * of_base > base * of_new, fewer = changed * of_base < base * of_new;
  std::string verdict = "same";
  if (significant && (more || fewer)) {
    verdict = more ? "worse" : "better";
    test.record["reason"] = more ? "more replicas fail" : "fewer replicas fail";
  } else if (more && test.probability <= options_.failure_level) {
    verdict = "too_little_data";
    test.record["reason"] = "more replicas fail, too few to be certain";
    may_fail_more_ = true;
  } else if ((more || fewer) && surest > level_of_one()) {
    verdict = "too_little_data";
    test.record["reason"] = "too few replicas to tell how many fail";
  }
  test.record["verdict"] = verdict;
}

void Comparison::judge(Test& test, double adjusted) {
  test.record["adjusted_probability"] = adjusted;
  const bool significant = adjusted <= options_.family_level;
  test.change ? judge_change(test, significant) : judge_failures(test, significant);
  records_[test.cell]["tests"].push_back(std::move(test.record));
}

std::string worst_of(const json& tests) {
  for (const char* verdict : {"worse", "better", "too_little_data"}) {
    for (const auto& test : tests) {
      if (test["verdict"] == verdict) return verdict;
    }
  }
  return "same";
}

/// Of the whole, from the counts of tests.
std::string Comparison::verdict(const json& counts) const {
  const auto of = [&](const char* verdict) { return counts[verdict].get<std::size_t>(); };
  const auto blind = of("too_little_data");
  const auto sighted = of("same") + of("better") + of("worse");
  if (of("worse") > 0) return "worse";
  if (blind > sighted || may_fail_more_) return "too_little_data";
  return of("better") > 0 ? "better" : "same";
}

/// Counts of verdicts and the verdict of the whole.
void Comparison::conclude(json& record) const {
  std::map<std::string, int> tests = {
      {"same", 0}, {"better", 0}, {"worse", 0}, {"too_little_data", 0}};
  auto cells = tests;
  for (const auto& cell : record["cells"]) {
    ++cells[cell["verdict"]];
    for (const auto& test : cell["tests"]) ++tests[test["verdict"]];
  }
  record["counts"] = {{"tests", tests}, {"cells", cells}};
  record["verdict"] = verdict(record["counts"]["tests"]);
}

json Comparison::record() {
  require_all();
  for (const auto& cell : cells_.common) add_cell(cell);
  std::vector<double> probabilities;
  for (const auto& test : tests_) probabilities.push_back(test.probability);
  const auto adjusted = holm_adjusted(probabilities);
  const auto count = tests_.size();
  for (std::size_t n = 0; n < count; ++n) judge(tests_[n], adjusted[n]);
  for (auto& cell : records_) cell["verdict"] = worst_of(cell["tests"]);
  json record = {{"format", "driftless-comparison/1"},
                 {"base", side(base_)},
                 {"new", side(changed_)},
                 {"family_level", options_.family_level},
                 {"minimum_effect", options_.minimum_effect},
                 {"wanted_effect", options_.wanted_effect},
                 {"method", options_.method.empty() ? json() : json(options_.method)},
                 {"tests", count},
                 {"cells", std::move(records_)},
                 {"missing", identities(cells_.missing)},
                 {"added", identities(cells_.added)},
                 {"cost", cost_changes(base_, changed_, cells_.common)}};
  conclude(record);
  return record;
}

}  // namespace

json compare(const json& base, const json& changed, const CompareOptions& options) {
  return Comparison(base, changed, options).record();
}

json without_curves(json result) {
  for (auto& cell : result["cells"]) {
    cell.erase("curves");
    cell.erase("energy_trace");
  }
  result["orders"] = json::array();
  result["answers"] = json::array();
  return result;
}

}  // namespace driftless
