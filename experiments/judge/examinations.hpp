#pragma once

#include "experiments/judge/examination.hpp"

/// Every examination, a line each: `name` is defined in name.cpp.
#define DRIFTLESS_EXAMINATIONS(EXAMINATION) \
  EXAMINATION(invariants)                   \
  EXAMINATION(galilean)                     \
  EXAMINATION(limits)                       \
  EXAMINATION(orders)                       \
  EXAMINATION(common_noise)                 \
  EXAMINATION(deterministic)                \
  EXAMINATION(balance)                      \
  EXAMINATION(stability)                    \
  EXAMINATION(drift)

namespace driftless::judge {

#define DRIFTLESS_DECLARE(name) extern const Examination name;
DRIFTLESS_EXAMINATIONS(DRIFTLESS_DECLARE)
#undef DRIFTLESS_DECLARE

}  // namespace driftless::judge
