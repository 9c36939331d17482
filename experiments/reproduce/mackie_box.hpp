#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/long_run.hpp"
#include "experiments/mackie_fluid.hpp"
#include "experiments/reproduce/experiment.hpp"
#include "experiments/study.hpp"

/// The boxes of [MAN], Mackie, Bonet Avalos, Navas, PCCP 1, 2039 (1999), in its own units.
namespace driftless::reproduce {

/// The paper's explicit scheme, with the coefficients of its 2.32 put right.
inline const MethodChoice mackie_explicit{"avalos-mackie-explicit", {{"own_products", true}}};

/// Why a method cannot run the fluid of the equilibrium runs, nothing if it can.
std::optional<std::string> liquid_unsuited(const MethodChoice& method);

/// What an ideal gas of boltzmann k and a temperature makes of a wall.
struct WallLayer {
  double excluded;   ///< int (1 - exp(-psi/kT)) dx: by how much the wall shortens the box
  double potential;  ///< int psi exp(-psi/kT) dx: potential energy per area and bulk density
};
WallLayer wall_layer(const WallRepulsion& repulsion, double boltzmann, double temperature);

/// A box of mean density 1 as its particles see it.
struct MackieBulk {
  double side;     ///< between the layers that the walls exclude
  double density;  ///< in the middle
};
MackieBulk mackie_bulk(std::size_t particles, const WallRepulsion& repulsion, int walled_axes = 3);

/// Conductivity of the liquid at a density [MAN 3.28], at the walls' temperature.
double mackie_conductivity(double density);

/// A cube of density 1 with the same wall on the faces of so many axes, z first.
Box mackie_cube(std::size_t particles, const Wall& wall, int walled_axes = 3);

/// Particles at random places, no nearer to a wall than `inset`, in Maxwell's law and the law of
/// the internal energies at a temperature, at the mean energy.
State mackie_in_law(const FluidParameters& fluid, const Box& box, std::size_t particles,
                    double temperature, double inset, const Noise& noise);
/// The same places, at rest, all at one particle temperature.
State mackie_at_rest(const FluidParameters& fluid, const Box& box, std::size_t particles,
                     double temperature, double inset, const Noise& noise);

/// What a box and its walls have, as series over time.
class BoxSeries : public Observer {
 public:
  /// `margin`: particles at least so far from every wall count as bulk.
  explicit BoxSeries(double time_step, double margin = 0)
      : time_step_(time_step), margin_(margin) {}

  void sample(System& system, std::uint64_t step) override;
  nlohmann::json settings() const override { return {{"margin", margin_}}; }
  nlohmann::json save() override;
  void load(const nlohmann::json& saved) override;

  /// {name: [...]}: time; kinetic, internal, potential (energies); inverse, the mean of 1/theta;
  /// pushed, what momentum the walls have received along their normals, all added up; bulk, a
  /// number of particles; heat_0 to heat_5, what energy each wall has received.
  nlohmann::json to_json() const;

 private:
  static const std::vector<std::string>& names();

  double time_step_, margin_;
  std::vector<double> values_;  ///< row after row
};

/// Runs a system over a duration from step 0; throws LongRunFailure.
void run_box(System& system, const MethodChoice& method, double time_step, double duration,
             const std::vector<Observation>& observations, const Workplace& workplace,
             const nlohmann::json& identity = nlohmann::json::object());

/// A column of what BoxSeries recorded, from a time on.
Eigen::VectorXd column_from(const nlohmann::json& series, const std::string& name, double time = 0);

/// A row of a report without a paper's value.
Row mackie_row(std::string quantity, std::string setting, std::string unit, const Interval& ours);

}  // namespace driftless::reproduce
