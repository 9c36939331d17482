#pragma once

#include "integrators/integrator.hpp"

/// Every method of this library, a line each: `name` is defined in name.cpp.
#define DRIFTLESS_METHODS(METHOD) \
  METHOD(averaged_drift)          \
  METHOD(avalos_mackie_implicit)  \
  METHOD(avalos_mackie_midpoint)  \
  METHOD(espanol)                 \
  METHOD(marsh_coveney)           \
  METHOD(shardlow_s1)             \
  METHOD(shardlow_s2)             \
  METHOD(isoenergetic_verlet)

namespace driftless {

#define DRIFTLESS_DECLARE(name) extern const Method name;
DRIFTLESS_METHODS(DRIFTLESS_DECLARE)
#undef DRIFTLESS_DECLARE

}  // namespace driftless
