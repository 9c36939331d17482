#pragma once

#include <string>
#include <vector>

#include "experiments/judge/examination.hpp"
#include "experiments/judge/two_body/bench.hpp"

/// The cases of the examination `balance` and what their records say.
namespace driftless::judge {

/// Isolated pairs of one kind.
struct PairCase {
  std::string name;  ///< "pairs with friction alone, closure noise"
  two_body::Bench bench;
  bool relaxes;  ///< to the exact law, by friction and conduction or a bath
};

/// Small fluids of one kind.
struct FluidCase {
  std::string name;
  FluidParameters fluid;
};

/// For every closure that the method is built for, with friction and conduction; with friction
/// alone where it claims to keep the energy; isothermal ones if it runs such fluids.
std::vector<PairCase> pair_cases(const Candidate& candidate);
/// Whether stationary pairs are looked at forwards and backwards: all but isothermal ones.
bool is_reversed(const PairCase& asked);
/// For the last closure; none if there is none.
std::vector<FluidCase> fluid_cases(const Candidate& candidate);

/// The steps at which S[P](t) is followed, in relaxation times of a pair, and those of the two
/// looks at reversed motion, the largest first and each half of the one before.
const std::vector<double>& entropy_steps();
const std::vector<double>& pair_steps();
const std::vector<double>& fluid_steps();

/// The names of a case's parts, "entropy of ..." or "free energy of ..." and "reversal of ...".
std::string entropy_part(const PairCase& asked, double step);
std::string reversal_part(const std::string& case_name, double step);

/// Appends what the records say of the course of the entropy.
void conclude_entropy(const Candidate& candidate, const Records& records, Conclusion& conclusion);
/// Appends what they say of reversed motion.
void conclude_reversal(const Candidate& candidate, const Records& records, Conclusion& conclusion);

}  // namespace driftless::judge
