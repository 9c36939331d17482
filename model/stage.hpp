#pragma once

namespace driftless {

/// One of a step's independent noises, numbered from 0 to 255. A method that cuts its step into
/// equal parts says into how many: stage 0 of 2 belongs to the first half of the step, stage 1 of 2
/// to the second. Where noise is not refined (Noise::set_refinement) that changes nothing.
struct Stage {
  unsigned number = 0;
  unsigned parts = 1;

  constexpr Stage(unsigned stage = 0, unsigned parts_of_step = 1)
      : number(stage), parts(parts_of_step) {}
};

}  // namespace driftless
