#include "experiments/bench/machine.hpp"

#include <hwy/targets.h>

#include <algorithm>
#include <thread>

namespace driftless {

std::string instruction_set() {
  const auto targets = hwy::SupportedTargets();
  return hwy::TargetName(targets & -targets);  // the lowest bit is the best one
}

unsigned usable_cpus() { return std::max(1u, std::thread::hardware_concurrency()); }

}  // namespace driftless
