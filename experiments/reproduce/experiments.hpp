#pragma once

#include "experiments/reproduce/experiment.hpp"

/// Every experiment, a line each: `name` is defined in a file of this folder.
#define DRIFTLESS_EXPERIMENTS(EXPERIMENT)     \
  EXPERIMENT(avalos_mackie_1999_conductivity) \
  EXPERIMENT(avalos_mackie_1999_viscosity)    \
  EXPERIMENT(coefficient_laws)                \
  EXPERIMENT(mackie_1999_figure_3)            \
  EXPERIMENT(mackie_1999_figures_1_2)         \
  EXPERIMENT(mackie_1999_figures_4_6)         \
  EXPERIMENT(mackie_1999_walls)               \
  EXPERIMENT(marsh_coveney_entropy)           \
  EXPERIMENT(marsh_coveney_species)           \
  EXPERIMENT(methods_transport)               \
  EXPERIMENT(soleymani_2020_figure_1)         \
  EXPERIMENT(soleymani_2020_figure_4)         \
  EXPERIMENT(soleymani_2020_figure_8)         \
  EXPERIMENT(soleymani_2020_figures_2_3)      \
  EXPERIMENT(soleymani_2020_figures_5_6)

namespace driftless::reproduce {

#define DRIFTLESS_DECLARE(name) extern const Experiment name;
DRIFTLESS_EXPERIMENTS(DRIFTLESS_DECLARE)
#undef DRIFTLESS_DECLARE

}  // namespace driftless::reproduce
