#pragma once

#include <vector>

#include "experiments/prepared_scene.hpp"
#include "experiments/study.hpp"

namespace driftless {

/// A cell to be timed.
struct TimedCell {
  const PreparedScene* prepared;
  const MethodChoice* choice;
  double time_step;
};

/// Processor seconds of one step, the median over rounds, and half the distance of the quartiles;
/// 0 where no step could be completed.
struct StepCost {
  double seconds = 0;
  double spread = 0;
};

/// Times every cell for a few steps, again and again in turn, on one otherwise idle core, so that a
/// machine that slows down or speeds up does not favour a method.
std::vector<StepCost> time_cells(const std::vector<TimedCell>& cells);

}  // namespace driftless
