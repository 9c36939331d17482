#pragma once

#include "experiments/reproduce/experiment.hpp"
#include "experiments/statistics.hpp"

/// Estimates in the records of parts, and what rows and charts make of them.
namespace driftless::reproduce {

/// {"value", "error", "degrees_of_freedom"}; without a number where there is none.
nlohmann::json to_json(const Estimate& estimate);
/// The estimate of a record; nothing if it has no value or no error.
std::optional<Estimate> read_estimate(const nlohmann::json& record);

/// With the 95 % interval.
judge::Point point(double x, const Estimate& estimate);

/// The same of a quantity that is `factor` times as large.
Estimate scaled(Estimate estimate, double factor);

/// A line of theory on a logarithmic axis.
judge::Series line(const std::string& name, double from, double to,
                   const std::function<double(double)>& value);

}  // namespace driftless::reproduce
