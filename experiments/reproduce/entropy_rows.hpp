#pragma once

#include <functional>

#include "experiments/judge/balance.hpp"
#include "experiments/reproduce/experiment.hpp"

/// The course of S[P] or F[P] of ensembles of pairs, by the parts and findings of the examination
/// `balance`.
namespace driftless::reproduce {

/// Which of a candidate's kinds of pairs are followed.
using Wanted = std::function<bool(const judge::PairCase&)>;

/// Appends a part for every wanted kind that relaxes and every step.
void add_entropy_parts(const judge::Candidate& candidate, const Wanted& wanted,
                       const Conditions& conditions, std::vector<Part>& all);

/// Appends a row for every one of the parts and a picture for every kind.
void conclude_entropy(const judge::Candidate& candidate, const Records& records, Outcome& outcome);

}  // namespace driftless::reproduce
