#pragma once

#include "experiments/judge/limit_findings.hpp"

namespace driftless::judge {

/// Deviations by time step of what tells methods apart best: the variance of u by heat capacity and
/// closure for the ideal systems, every average for the soft fluid.
class LimitCharts {
 public:
  void add(const LimitCase& asked);
  std::vector<Chart> take() && { return std::move(charts_); }

 private:
  std::vector<Chart> charts_;
};

/// Adds a case's rows to the table of errors and costs (trade.hpp): its cells without a failed run.
void add_trade(const LimitCase& asked, const Records& records, Table& table);

}  // namespace driftless::judge
