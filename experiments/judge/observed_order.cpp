#include "experiments/judge/observed_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/statistics.hpp"

namespace driftless::judge {
namespace {

/// The number and its interval, and a sentence that says them.
Finding measured(const ObservedOrder& observed) {
  Finding finding;
  finding.subject = observed.subject;
  finding.unit = "power of the step";
  const Deviation &largest = observed.deviations.front(), &smallest = observed.deviations.back();
  if (!observed.fit) {
    finding.verdict = Verdict::not_resolved;
    finding.sentence = fmt::format(
        "No order is seen: {} stands out of the noise at fewer than two steps; at the largest one, "
        "{:g}, it is {:.2g} +- {:.2g} (95 %).",
        observed.quantity, largest.time_step, largest.value, interval_quantile * largest.error);
    return finding;
  }
  const double order = observed.fit->order, width = interval_quantile * observed.fit->error;
  finding.value = order;
  finding.lower = order - width;
  finding.upper = order + width;
  finding.sentence = fmt::format(
      "Between steps {:g} and {:g} {} goes with the power {:.2f} of the step (95 % interval {:.2f} "
      "to {:.2f})",
      smallest.time_step, largest.time_step, observed.quantity, order, order - width,
      order + width);
  return finding;
}

Verdict verdict(const OrderFit& fit, int claimed) {
  const double lowest = claimed - order_tolerance, width = interval_quantile * fit.error;
  if (fit.order + certain * fit.error < lowest) return Verdict::fails;
  return fit.order - width >= lowest || (width <= order_tolerance && fit.order + width >= claimed)
             ? Verdict::holds
             : Verdict::not_resolved;
}

/// What no deviation is larger than, for certain.
double bound(const std::vector<Deviation>& deviations) {
  double largest = 0;
  for (const auto& one : deviations) {
    largest = std::max(largest, std::abs(one.value) + certain * one.error);
  }
  return largest;
}

Finding negligible(const ObservedOrder& observed) {
  Finding finding{observed.subject, Verdict::holds, ""};
  finding.resolution = bound(observed.deviations);
  finding.unit = "1";
  finding.sentence = fmt::format(
      "At the step {:g} and below {} is less than {:.2g}: too little for an order, right or wrong.",
      observed.deviations.front().time_step, observed.quantity, *finding.resolution);
  return finding;
}

}  // namespace

Finding claimed_order(const ObservedOrder& observed, int claimed) {
  Finding finding = measured(observed);
  finding.claimed = true;
  const bool open = !observed.fit || verdict(*observed.fit, claimed) == Verdict::not_resolved;
  if (open && bound(observed.deviations) < negligible_deviation) {
    finding = negligible(observed);
    finding.claimed = true;
    return finding;
  }
  if (!observed.fit) return finding;
  const auto& fit = *observed.fit;
  finding.verdict = verdict(fit, claimed);
  finding.resolution = order_tolerance + certain * fit.error;
  const char* beside = "";
  if (finding.verdict == Verdict::fails) beside = ", and it is lower";
  if (finding.verdict == Verdict::not_resolved) beside = ", which is not decided";
  if (fit.order - interval_quantile * fit.error > claimed + order_tolerance) {
    beside = ", and it is higher";
  }
  finding.sentence += fmt::format("; claimed is {}{}.", claimed, beside);
  return finding;
}

Finding reported_order(const ObservedOrder& observed) {
  Finding finding = measured(observed);
  finding.verdict = Verdict::reported;
  if (observed.fit) finding.sentence += ".";
  return finding;
}

Series order_series(std::string name, const std::vector<Deviation>& deviations) {
  Series series{std::move(name), {}};
  for (const auto& deviation : deviations) {
    const double size = std::abs(deviation.value), width = interval_quantile * deviation.error;
    if (!(size > 0)) continue;
    series.points.push_back(
        {deviation.time_step, size, std::max(size - width, 1e-3 * size), size + width});
  }
  return series;
}

}  // namespace driftless::judge
