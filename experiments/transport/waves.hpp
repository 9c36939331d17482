#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "experiments/transport/decay.hpp"
#include "experiments/transport/modes.hpp"
#include "integrators/integrator.hpp"

namespace driftless::transport {

/// Waves of one wavelength along some axes, imposed on a fluid all at once; small ones do not see
/// each other. Amplitudes: of velocities in units of sqrt(kT/m), T being the temperature at which
/// the fluid is quoted; of the temperature, relative.
struct Waves {
  std::vector<int> axes = {0, 1, 2};
  int number = 1;  ///< wavelengths in the box
  double transverse = 0, longitudinal = 0, temperature = 0;
};

/// Adds the waves, of cos(k.r - phase), to velocities and internal energies, then takes the new
/// momentum out and scales the internal energies to the old total energy, so that a fluid can take
/// them again and again. A temperature wave scales a particle's internal energy, and its velocity
/// by the square root: both have the new temperature.
void impose(const Waves& waves, double phase, System& system);

/// How imposed waves decay: sums over all axes and impositions of the amplitude's part along the
/// imposed one, at equally spaced times; empty without such a wave.
struct WaveRecord {
  double interval = 0;
  std::vector<double> transverse, longitudinal, temperature;
};

struct WaveSchedule {
  double step = 0;             ///< of time
  std::uint64_t stride = 1;    ///< steps between samples
  std::uint64_t samples = 50;  ///< after each imposition, beside that at its time
  unsigned impositions = 1;    ///< one after the other, each a quarter of a wave further: what is
                               ///< left of the last is orthogonal to the next
};

/// Steps between samples, of which a window of time has so many; at least one.
std::uint64_t stride_of(double window, std::uint64_t samples, double step);

/// Runs the system, whose steps are counted on from `done`. Throws StepFailure.
WaveRecord relax(const Waves& waves, const WaveSchedule& schedule, Integrator& integrator,
                 System& system, std::uint64_t& done);

/// Viscosity from the decay of a transverse wave: rho m/(k^2 int C dt), C the velocity over its
/// first value. The integral is what a steady force at this wavelength would find, whatever the
/// decay's form; as k -> 0 it is the hydrodynamic one.
double viscosity(const Decay& transverse, double wavenumber, const FluidParameters& fluid,
                 double density);

/// Thermal conductivity from the decay of a temperature wave: its time integral is the injected
/// energy over conductivity k^2, whatever the fluid does meanwhile; so conductivity = rho c/(k^2
/// int T(t)/T(0) dt) with c = phi + 5k/2, what impose() spends per particle and temperature (for a
/// fluid without potential that is c_v). The question of c_p or c_v does not arise: the rate of
/// the last exponential is conductivity k^2/(rho c_p) if sound is faster than conduction, that of
/// the first one conductivity k^2/(rho c_v) [AM99 4.3], and the integral holds both.
double conductivity(const Decay& temperature, double wavenumber, const FluidParameters& fluid,
                    double density);

/// Sound speed from the decay of a longitudinal wave, a damped oscillation: its undamped frequency
/// over k. Throws std::domain_error if it does not oscillate. `guess` in the unit of the result.
double sound_speed(const Decay& longitudinal, double wavenumber, double guess);

}  // namespace driftless::transport
