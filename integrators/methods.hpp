#pragma once

#include "integrators/integrator.hpp"

/// Every method of this library, a line each: `name` is defined in name.cpp.
#define DRIFTLESS_METHODS(METHOD)      \
  METHOD(averaged_drift)               \
  METHOD(avalos_mackie_explicit)       \
  METHOD(avalos_mackie_implicit)       \
  METHOD(avalos_mackie_midpoint)       \
  METHOD(espanol)                      \
  METHOD(marsh_coveney)                \
  METHOD(velocity_verlet_dpde)         \
  METHOD(groot_warren)                 \
  METHOD(isoenergetic_verlet)          \
  METHOD(splitting_energy_reinjection) \
  METHOD(shardlow_s1)                  \
  METHOD(shardlow_s2)                  \
  METHOD(shardlow_aboba)               \
  METHOD(trotter)                      \
  METHOD(metropolized_splitting)       \
  METHOD(peters)                       \
  METHOD(lowe_andersen)

namespace driftless {

// Hidden: what is outside of the library finds methods by their names.
#define DRIFTLESS_DECLARE(name) [[gnu::visibility("hidden")]] extern const Method name;
DRIFTLESS_METHODS(DRIFTLESS_DECLARE)
#undef DRIFTLESS_DECLARE

}  // namespace driftless
