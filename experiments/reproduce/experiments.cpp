#include "experiments/reproduce/experiments.hpp"

#include <algorithm>

#include "experiments/location.hpp"
#include "experiments/nearest.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/study.hpp"

namespace driftless::reproduce {

const std::vector<const Experiment*>& experiments() {
#define DRIFTLESS_ADDRESS(name) &name,
  static const std::vector<const Experiment*> all = {DRIFTLESS_EXPERIMENTS(DRIFTLESS_ADDRESS)};
#undef DRIFTLESS_ADDRESS
  return all;
}

std::vector<const Experiment*> read_experiments(const std::vector<std::string>& names) {
  std::vector<std::string> known = {"all"};
  for (const auto* experiment : experiments()) known.emplace_back(experiment->name);
  std::vector<const Experiment*> chosen;
  const auto choose = [&](const Experiment* one) {
    if (std::find(chosen.begin(), chosen.end(), one) == chosen.end()) chosen.push_back(one);
  };
  for (const auto& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw InputError("reproduce: \"" + printable(name) + "\" is no experiment" +
                       suggestion(name, known));
    }
    if (found == known.begin()) {
      for (const auto* experiment : experiments()) choose(experiment);
    } else {
      choose(experiments()[static_cast<std::size_t>(found - known.begin()) - 1]);
    }
  }
  return chosen;
}

std::vector<const Experiment*> experiments_run_by(const MethodChoice& method,
                                                  const std::vector<std::string>& names,
                                                  std::vector<std::string>& left_out) {
  std::vector<const Experiment*> runs;
  for (const auto* one : read_experiments(names)) {
    const auto reason = one->unsuited ? one->unsuited(method) : std::nullopt;
    if (!reason) {
      runs.push_back(one);
      continue;
    }
    const std::string sentence =
        "--method: " + to_string(method) + " cannot run " + std::string(one->name) + ": " + *reason;
    if (std::find(names.begin(), names.end(), one->name) != names.end()) throw InputError(sentence);
    left_out.push_back(sentence);
  }
  if (runs.empty()) throw InputError("--method: " + to_string(method) + " runs no experiment");
  return runs;
}

}  // namespace driftless::reproduce
