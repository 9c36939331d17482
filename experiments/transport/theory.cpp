#include "experiments/transport/theory.hpp"

#include <cmath>
#include <numbers>

namespace driftless::transport {
namespace {

using std::numbers::pi;

double square(double x) { return x * x; }

double inverse_temperature_conduction(const FluidParameters& fluid) {
  if (!fluid.has_conduction()) return 0;
  return fluid.conduction *
         (fluid.heat_form == HeatForm::temperature ? square(fluid.temperature) : 1);
}

/// Integral of w(r) kernel(r) 4 pi r^2 dr by the midpoint rule.
template <class Kernel>
double integral(double range, double exponent, Kernel&& kernel) {
  constexpr int points = 2000;
  double sum = 0;
  for (int n = 0; n < points; ++n) {
    const double r = (n + 0.5) * range / points;
    sum += 4 * pi * r * r * std::pow(1 - r / range, exponent) * kernel(r) * range / points;
  }
  return sum;
}

/// The mean over directions of 1 - cos(q mu), and of (1 - mu^2)/2 (1 - cos(q mu)).
double scalar_loss(double q) { return q < 1e-2 ? q * q / 6 : 1 - std::sin(q) / q; }
double transverse_loss(double q) {
  if (q < 1e-2) return q * q / 30;
  return 1.0 / 3 - (std::sin(q) - q * std::cos(q)) / (q * q * q);
}

/// k^2 V/(first + 2 k^2 V/(first + w_0 + 3 k^2 V/(first + 2 w_0 + ...))).
double chain(double square_of_kv, double first, double collisions) {
  double tail = 0;
  for (int n = 400; n >= 1; --n) tail = n * square_of_kv / (first + (n - 1) * collisions + tail);
  return tail;
}

}  // namespace

double weight_volume(double range, double exponent) {
  return 8 * pi * std::pow(range, 3) / ((exponent + 1) * (exponent + 2) * (exponent + 3));
}

double collision_rate(const FluidParameters& f, double density) {
  return density * f.friction * weight_volume(f.friction_range, f.weight_exponent) / (3 * f.mass);
}

double heat_rate(const FluidParameters& f, double density) {
  return density * inverse_temperature_conduction(f) *
         weight_volume(f.heat_range, f.weight_exponent) / (f.heat_capacity * square(f.temperature));
}

double diffusion(const FluidParameters& f, double density) {
  return f.boltzmann * f.temperature / (f.mass * collision_rate(f, density));
}

double heat_capacity_at_volume(const FluidParameters& f) {
  return f.heat_capacity + 2.5 * f.boltzmann;
}

double sound_speed(const FluidParameters& f) {
  const double at_pressure = f.heat_capacity + 3.5 * f.boltzmann;
  return std::sqrt(at_pressure / heat_capacity_at_volume(f) * f.boltzmann * f.temperature / f.mass);
}

double dissipative_viscosity(const FluidParameters& f, double density) {
  return density * density / 30 * integral(f.friction_range, f.weight_exponent, [&](double r) {
           return f.friction * r * r;
         });
}

double dissipative_conductivity(const FluidParameters& f, double density) {
  return density * density / 6 * inverse_temperature_conduction(f) / square(f.temperature) *
         integral(f.heat_range, f.weight_exponent, [](double r) { return r * r; });
}

double mean_field_viscosity(const FluidParameters& f, double density, double wavenumber) {
  const double collisions = collision_rate(f, density);
  const double loss = density * f.friction / f.mass *
                      integral(f.friction_range, f.weight_exponent,
                               [&](double r) { return transverse_loss(wavenumber * r); });
  const double kv = square(wavenumber) * f.boltzmann * f.temperature / f.mass;
  const double rate = loss + chain(kv, 2 * collisions, collisions);
  return density * f.mass * rate / square(wavenumber);
}

double mean_field_conductivity(const FluidParameters& f, double density, double wavenumber) {
  const double collisions = collision_rate(f, density), heat = heat_rate(f, density);
  const double loss = density * inverse_temperature_conduction(f) /
                      (f.heat_capacity * square(f.temperature)) *
                      integral(f.heat_range, f.weight_exponent,
                               [&](double r) { return scalar_loss(wavenumber * r); });
  const double kv = square(wavenumber) * f.boltzmann * f.temperature / f.mass;
  const double rate = loss + chain(kv, collisions + heat, collisions);
  return density * f.heat_capacity * rate / square(wavenumber);
}

}  // namespace driftless::transport
