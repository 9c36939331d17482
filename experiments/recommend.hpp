#pragma once

#include <string>
#include <vector>

namespace driftless {

/// What `driftless recommend` is asked, as on its command line; what is not given is empty.
struct Question {
  std::vector<std::string> results;  ///< result.json or judgement.json files or their folders
  std::string tolerance;             ///< "0.5%" or "0.005"
  std::string observable;            ///< `equilibrium` if empty
  std::string budget;                ///< core-seconds per unit of simulated time
  std::string scene;                 ///< all scenes if empty
};

/// For every scene one sentence, a line each: the cheapest method and step whose bound is within
/// the tolerance or, with a budget, the most accurate one within that cost; the next; the least
/// error that could have been shown; what failed and what is not resolved. By the same rule as the
/// answers of a result; of a judgement, from its trade of error against cost. Throws InputError in
/// one sentence.
std::string recommend(const Question& question);

}  // namespace driftless
