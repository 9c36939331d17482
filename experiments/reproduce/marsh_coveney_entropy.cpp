#include "experiments/reproduce/entropy_rows.hpp"
#include "experiments/reproduce/experiments.hpp"

namespace driftless::reproduce {
namespace {

/// The papers' own integrators, or the one in their place.
std::vector<judge::Candidate> candidates(const Conditions& conditions) {
  if (conditions.method) return {{*conditions.method}};
  return {{{"marsh-coveney", {}}}, {{"avalos-mackie-explicit", {}}}};
}

bool is_of_one_species(const judge::PairCase& asked) { return asked.bench.fluid.species() == 1; }

/// The model that a method is not built for is left out, as the isothermal one is of most.
std::optional<std::string> unsuited(const MethodChoice& method) {
  if (!judge::pair_cases({method}).empty()) return std::nullopt;
  return method.name + " is built for neither isothermal pairs nor pairs that keep the energy";
}

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  for (const auto& candidate : candidates(conditions)) {
    add_entropy_parts(candidate, is_of_one_species, conditions, all);
  }
  return all;
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  for (const auto& candidate : candidates(conditions)) {
    conclude_entropy(candidate, records, outcome);
  }
  outcome.remarks = {
      "The functionals are those of the exact process: at a finite step a method has a stationary "
      "law of its own, and what must be monotone is the distance from that one. A fall of S[P] "
      "close to the plateau is the difference of the two laws, not an instability.",
      "What is given is the largest of many differences, and so above zero by chance; it is "
      "negative where the distance shrinks between any two times."};
  return outcome;
}

}  // namespace

const Experiment marsh_coveney_entropy{
    .name = "marsh-coveney-1998-entropy",
    .source = "MC98 VI, MAN 3.15-3.17",
    .title = "Free energy and entropy of an ensemble change one way only",
    .question =
        "The H-theorems of the models: the free energy F[P] = <H> + k T <ln P> of the isothermal "
        "model may only fall [MC98 7, 8], the entropy S[P] = <sum s/k> - <ln P> of the isolated "
        "energy-conserving one only rise [MC98 31, 32; MAN 3.15-3.17]; a change the other way is "
        "proposed there as the sign of a numerical instability. Isolated pairs at a fixed "
        "distance, phi/k = 10, friction and conduction relaxing alike, and isothermal pairs start "
        "in a narrow smooth cloud far from equilibrium with several times its kinetic energy. P(t) "
        "is a histogram of many copies, of (v, u_i - u_j) or of v alone, followed for 8 relaxation "
        "times of the relative velocity at steps of 0.1, 0.2, 0.4 and 0.8 of it. The clearest "
        "change the wrong way between any two times is given; it counts as one where chance alone "
        "would bring it about, among all pairs of times, less than once in a million times.",
    .parts = parts,
    .conclude = conclude,
    .unsuited = unsuited};

}  // namespace driftless::reproduce
