#include "experiments/judge/examinations.hpp"

#include "experiments/study_parts.hpp"

namespace driftless::judge {

const std::vector<const Examination*>& examinations() {
#define DRIFTLESS_ADDRESS(name) &name,
  static const std::vector<const Examination*> all = {DRIFTLESS_EXAMINATIONS(DRIFTLESS_ADDRESS)};
#undef DRIFTLESS_ADDRESS
  return all;
}

std::string to_string(Depth depth) { return depth == Depth::quick ? "quick" : "full"; }

std::string Candidate::name() const { return driftless::to_string(choice); }

}  // namespace driftless::judge
