#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/judge/conclusion.hpp"
#include "experiments/order_fit.hpp"

namespace driftless::judge {

/// Deviations of which an order is asked, and what they are: "the deviation of the kinetic energy".
/// `fit` is found by fit_order() unless something else is given.
struct ObservedOrder {
  std::string subject;
  std::string quantity;
  std::vector<Deviation> deviations;  ///< the largest step first, at least one
  std::optional<OrderFit> fit;

  ObservedOrder(std::string of, std::string what, std::vector<Deviation> seen)
      : ObservedOrder(std::move(of), std::move(what), seen, fit_order(seen)) {}
  ObservedOrder(std::string of, std::string what, std::vector<Deviation> seen,
                const std::optional<OrderFit>& order)
      : subject(std::move(of)),
        quantity(std::move(what)),
        deviations(std::move(seen)),
        fit(order) {}
};

/// Where the order of a method is not below the claimed one by more than this, it is that one: a
/// few steps show a power law with what the next power adds to it.
inline constexpr double order_tolerance = 0.25;

/// A relative deviation below this, by `certain` errors, at the largest step and at all others is
/// none: it cannot have a wrong order.
inline constexpr double negligible_deviation = 0.02;

/// The order of relative deviations beside the claimed one: fails if it is lower by more than the
/// tolerance and `certain` errors, holds if its 95 % interval says that it is not lower, or if
/// there is no deviation to speak of; that it is higher is said.
Finding claimed_order(const ObservedOrder& observed, int claimed);

/// An order of which nothing is claimed, or that there is none to be seen.
Finding reported_order(const ObservedOrder& observed);

/// Absolute values of the deviations that are not zero, with their intervals, as far as those can
/// be drawn on a logarithmic axis.
Series order_series(std::string name, const std::vector<Deviation>& deviations);

}  // namespace driftless::judge
