#include "experiments/reproduce/estimates.hpp"

#include <cmath>

namespace driftless::reproduce {

nlohmann::json to_json(const Estimate& estimate) {
  nlohmann::json record = nlohmann::json::object();
  if (std::isfinite(estimate.mean)) record["value"] = estimate.mean;
  if (std::isfinite(estimate.error)) record["error"] = estimate.error;
  if (std::isfinite(estimate.degrees_of_freedom)) {
    record["degrees_of_freedom"] = estimate.degrees_of_freedom;
  }
  return record;
}

std::optional<Estimate> read_estimate(const nlohmann::json& record) {
  if (!record.contains("value") || !record.contains("error")) return {};
  Estimate estimate;
  estimate.mean = record["value"];
  estimate.error = record["error"];
  if (record.contains("degrees_of_freedom")) {
    estimate.degrees_of_freedom = record["degrees_of_freedom"];
  }
  return estimate;
}

judge::Point point(double x, const Estimate& estimate) {
  const Interval ours = interval_of(estimate);
  return {x, ours.value, ours.low, ours.high};
}

Estimate scaled(Estimate estimate, double factor) {
  estimate.mean *= factor;
  estimate.error *= std::abs(factor);
  return estimate;
}

judge::Series line(const std::string& name, double from, double to,
                   const std::function<double(double)>& value) {
  judge::Series series{name, {}, judge::Marks::line};
  constexpr int points = 60;
  for (int n = 0; n <= points; ++n) {
    const double x = from * std::pow(to / from, static_cast<double>(n) / points);
    series.points.push_back({x, value(x), {}, {}});
  }
  return series;
}

}  // namespace driftless::reproduce
