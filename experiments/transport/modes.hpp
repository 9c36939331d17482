#pragma once

#include <complex>
#include <vector>

#include "model/system.hpp"

/// Transport coefficients of any fluid under any method: diffusion, viscosity, conductivity, sound.
namespace driftless::transport {

using Complex = std::complex<double>;

/// The wave vector with `number` >= 1 wavelengths along an axis (0, 1, 2) of the box.
Vector wave_vector(const Box& box, int axis, int number);

/// Amplitudes of one wave, sums over particles of a_i exp(-i k.r_i); energies are taken from their
/// mean over all particles, so that a wave of density alone has none.
struct Modes {
  Complex density;
  Complex longitudinal;     ///< of velocity, along k
  Complex transverse[2];    ///< of velocity, across k
  Complex internal_energy;  ///< of u: the wave of temperature, times phi
  Complex energy;           ///< of kinetic + internal energy + half of the pair potentials
};

/// The modes of a wave vector along an axis; the transverse ones are along the axis + 1, axis + 2.
Modes modes(System& system, int axis, int number);

/// The autocorrelation Re <a(t) a*(0)> of a stationary series of amplitudes up to `lags` - 1
/// sampling intervals, averaged over all pairs of samples. Throws std::invalid_argument if the
/// series is no longer than that.
std::vector<double> autocorrelation(const std::vector<Complex>& series, std::size_t lags);

/// `series` without what is proportional to `other`: the amplitudes orthogonal to it in the mean.
std::vector<Complex> orthogonal_part(const std::vector<Complex>& series,
                                     const std::vector<Complex>& other);

}  // namespace driftless::transport
