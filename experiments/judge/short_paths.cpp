#include "experiments/judge/short_paths.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace driftless::judge {
namespace {

using nlohmann::json;

bool sound(Alike alike, double difference) {
  switch (alike) {
    case Alike::in_bits:
      return difference == 0;
    case Alike::to_rounding:
      return difference < rounding;
    case Alike::not_at_all:
      break;
  }
  return difference > visible;
}

/// Between rounding and what is visible nothing is said.
bool unclear(Alike alike, double difference) {
  return alike == Alike::to_rounding && difference >= rounding && difference <= visible;
}

json as_json(double difference, const Terms& terms) {
  const bool finite = std::isfinite(difference);
  return {{"difference", finite ? difference : std::numeric_limits<double>::max()},
          {"terms", terms.name()}};
}

std::string words(const ShortCheck& check, bool well, double difference, const std::string& terms) {
  if (check.alike == Alike::not_at_all) {
    return fmt::format("{}: the paths are {:.2g} apart or more ({}).",
                       well ? check.sound : check.wrong, difference, terms);
  }
  if (difference == 0) return check.sound + ": not a bit differs.";
  return fmt::format("{}: the largest difference is {:.2g} ({}).", well ? check.sound : check.wrong,
                     difference, terms);
}

}  // namespace

const ShortCheck& short_check(std::string_view name) {
  for (const auto& check : short_checks()) {
    if (check.name == name) return check;
  }
  throw std::out_of_range("no such check: " + std::string(name));
}

std::vector<Terms> all_terms(const Method& method) {
  std::vector<Terms> all;
  for (const auto closure : method.closures) {
    for (const auto heat : all_heat_forms()) {
      for (const bool potential : {false, true}) all.push_back({closure, heat, potential});
    }
  }
  for (const bool potential : {false, true}) {
    if (method.isothermal) {
      all.push_back({FrictionClosure::noise, HeatForm::none, potential, true});
    }
  }
  return all;
}

json short_record(const ShortCheck& check, const Trial& trial) {
  json record = json::object();
  for (const auto& terms : all_terms(trial.method)) {
    std::optional<double> difference;
    try {
      difference = check.difference(trial, terms);
    } catch (const StepFailure& failure) {
      return {{"failure",
               fmt::format("a step failed ({}; {})", to_string(failure.cause()), terms.name())}};
    }
    if (!difference) continue;
    const auto found = as_json(*difference, terms);
    const bool first = !record.contains("largest");
    if (first || found["difference"] > record["largest"]["difference"]) record["largest"] = found;
    if (first || found["difference"] < record["smallest"]["difference"]) {
      record["smallest"] = found;
    }
  }
  return record;
}

Finding short_finding(const ShortCheck& check, const Method& method, const json& record) {
  Finding finding;
  finding.subject = check.name;
  finding.claimed = check.claimed(method);
  if (record.contains("failure")) {
    finding.verdict = Verdict::fails;
    finding.sentence = fmt::format("{}: {}.", check.wrong, record["failure"].get<std::string>());
    return finding;
  }
  if (!record.contains("largest")) {
    finding.verdict = Verdict::not_applicable;
    finding.claimed = {};
    finding.sentence = "There is nothing of the kind in this method.";
    return finding;
  }
  const auto& worst = record[check.alike == Alike::not_at_all ? "smallest" : "largest"];
  const double difference = worst["difference"];
  const bool well = sound(check.alike, difference);
  finding.value = difference;
  if (check.alike == Alike::to_rounding) finding.resolution = visible;
  if (well) {
    finding.verdict = Verdict::holds;
  } else {
    const bool fault = check.demanded || *finding.claimed;
    finding.verdict = unclear(check.alike, difference) ? Verdict::not_resolved
                      : fault                          ? Verdict::fails
                                                       : Verdict::reported;
  }
  finding.sentence = words(check, well, difference, worst["terms"]);
  return finding;
}

}  // namespace driftless::judge
