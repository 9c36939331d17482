#include "experiments/reproduce/experiment.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/reproduce/papers.hpp"

namespace driftless::reproduce {
namespace {

using nlohmann::json;

/// Without the parts that are no numbers: nothing is left of an interval that has no value.
json to_json(const Interval& interval) {
  json record = json::object();
  const auto put = [&](const char* key, double value) {
    if (std::isfinite(value)) record[key] = value;
  };
  put("value", interval.value);
  put("low", interval.low);
  put("high", interval.high);
  return record;
}

json to_json(const Row& row) {
  json record = {{"quantity", row.quantity},
                 {"setting", row.setting},
                 {"unit", row.unit},
                 {"ours", to_json(row.ours)},
                 {"verdict", to_string(row.verdict)},
                 {"explanation", row.explanation}};
  if (row.paper) record["paper"] = to_json(*row.paper);
  if (!row.paper_text.empty()) record["paper_text"] = row.paper_text;
  if (row.theory) record["theory"] = to_json(*row.theory);
  if (!row.theory_text.empty()) record["theory_text"] = row.theory_text;
  return record;
}

/// A number that is none becomes null.
json numbers(const std::vector<double>& values) {
  json list = json::array();
  for (const double value : values) list.push_back(std::isfinite(value) ? json(value) : json());
  return list;
}

json to_json(const Field& field) {
  return {{"x", judge::to_json(field.x)},
          {"y", judge::to_json(field.y)},
          {"x_from", field.x_from},
          {"x_to", field.x_to},
          {"y_from", field.y_from},
          {"y_to", field.y_to},
          {"columns", field.columns},
          {"rows", field.rows},
          {"quantity", field.quantity},
          {"values", numbers(field.values)},
          {"contours", numbers(field.contours)},
          {"arrow_x", numbers(field.arrow_x)},
          {"arrow_y", numbers(field.arrow_y)}};
}

json to_json(const Picture& picture) {
  json record = {{"title", picture.title}, {"caption", picture.caption}};
  if (picture.chart) record["chart"] = judge::to_json(*picture.chart);
  if (picture.field) record["field"] = to_json(*picture.field);
  return record;
}

template <class Element>
json list(const std::vector<Element>& elements) {
  json all = json::array();
  for (const auto& element : elements) all.push_back(to_json(element));
  return all;
}

}  // namespace

std::vector<MethodChoice> Conditions::methods_or(const MethodChoice& published,
                                                 const std::vector<MethodChoice>& contrasts) const {
  std::vector<MethodChoice> all = {method_or(published)};
  for (const auto& contrast : contrasts) {
    const auto is_contrast = [&](const MethodChoice& one) { return same(one, contrast); };
    if (std::none_of(all.begin(), all.end(), is_contrast)) all.push_back(contrast);
  }
  return all;
}

std::optional<std::string> first_refusal(const MethodChoice& choice,
                                         const std::vector<FluidParameters>& fluids) {
  for (const auto& fluid : fluids) {
    if (auto reason = refusal(*find_method(choice.name), Fluid(fluid), choice.options)) {
      return reason;
    }
  }
  return std::nullopt;
}

std::string to_string(Effort effort) { return effort == Effort::quick ? "quick" : "full"; }

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::agrees:
      return "agrees";
    case Verdict::differs:
      return "differs";
    case Verdict::not_resolved:
      return "not resolved";
    case Verdict::ours_alone:
      break;
  }
  return "ours alone";
}

Interval interval_of(const Estimate& estimate) {
  const double reach = interval_quantile * estimate.error;
  return {estimate.mean, estimate.mean - reach, estimate.mean + reach};
}

Verdict compare(const Interval& ours, const Interval& paper, double resolution) {
  if (!std::isfinite(ours.value) || !std::isfinite(ours.low) || !std::isfinite(ours.high)) {
    return Verdict::not_resolved;
  }
  if (ours.low > paper.high || ours.high < paper.low) return Verdict::differs;
  const double scale = paper.value == 0 ? 1 : std::abs(paper.value);
  const double reach = std::max(ours.value - ours.low, ours.high - ours.value);
  return reach > resolution * scale ? Verdict::not_resolved : Verdict::agrees;
}

void put_theory(Row& row, const Interval& theory, std::string text, double resolution) {
  row.theory = theory;
  row.theory_text = std::move(text);
  row.verdict = compare(row.ours, theory, resolution);
}

void put_theory(Row& row, double theory, std::string text, double resolution) {
  put_theory(row, Interval{theory, theory, theory}, std::move(text), resolution);
}

json to_json(const Outcome& outcome) {
  return {{"rows", list(outcome.rows)},
          {"pictures", list(outcome.pictures)},
          {"remarks", outcome.remarks}};
}

}  // namespace driftless::reproduce
