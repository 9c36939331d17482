#include "experiments/judge/examinations.hpp"
#include "experiments/judge/path_order.hpp"
#include "experiments/judge/stationary_order.hpp"

namespace driftless::judge {
namespace {

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  auto all = stationary_parts(candidate, conditions);
  for (auto& part : path_order_parts(candidate, conditions)) all.push_back(std::move(part));
  return all;
}

Conclusion conclude(const Candidate& candidate, const Conditions& conditions,
                    const Records& records) {
  Conclusion conclusion;
  for (const auto closure : {FrictionClosure::noise, FrictionClosure::friction}) {
    FluidParameters parameters;
    parameters.friction = 1;
    parameters.friction_closure = closure;
    if (const auto reason = refusal(candidate.method(), Fluid(parameters))) {
      conclusion.findings.push_back(
          {"closure " + std::string(to_string(closure)), Verdict::not_applicable, *reason + "."});
    }
  }
  conclude_stationary(candidate, records, conclusion);
  conclude_path_orders(candidate, conditions, records, conclusion);
  return conclusion;
}

}  // namespace

const Examination orders{
    "orders", "Orders of convergence",
    "At which power of the step do errors vanish? Stationary: isolated pairs against their exact "
    "law at a step, its half and its quarter; this is the order that a method claims, and it fails "
    "where it is lower by more than 0.25 and five standard errors. Finite time: 27 particles of an "
    "ideal fluid run for one unit of time from off equilibrium, at steps from 1/8 to 1/64, each "
    "against its half on the same Wiener path - an increment of a step is the scaled sum of those "
    "of finer steps - and what averages at the end change by is fitted. Strong: the root mean "
    "square distance of the particles' momenta and internal energies in the same runs. Orders of a "
    "finite time and strong ones are not claimed by any method and are reported.",
    parts, conclude};

}  // namespace driftless::judge
