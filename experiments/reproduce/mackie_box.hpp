#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/long_run.hpp"
#include "experiments/reproduce/experiment.hpp"
#include "experiments/study.hpp"

/// The boxes of [MAN], Mackie, Bonet Avalos, Navas, PCCP 1, 2039 (1999), in its own units: lengths
/// in sqrt(2 m k T_R)/zeta_0, times in m/zeta_0. In program units m = zeta_0 = T_R = 1 and k = 1/2.
namespace driftless::reproduce {

/// The paper's dimensionless numbers of a fluid; its density is 1, it has no repulsion.
struct MackieFluid {
  double B;      ///< k/phi
  double C;      ///< L_0/phi
  double range;  ///< r*
};

/// Of the equilibrium runs [MAN Fig. 1-3].
inline constexpr MackieFluid mackie_liquid{0.01, 17, 1.24};
inline constexpr double mackie_temperature = 1.1;  ///< of its walls

FluidParameters mackie_parameters(const MackieFluid& fluid);

/// The repulsion of a wall: psi(x) = (a r_w/2)(1 - x/r_w)^2; a = 0: a hard wall.
struct WallRepulsion {
  double strength = 0;  ///< a
  double range = 1;     ///< r_w
};

/// What an ideal gas of boltzmann k and a temperature makes of a wall.
struct WallLayer {
  double excluded;   ///< int (1 - exp(-psi/kT)) dx: by how much the wall shortens the box
  double potential;  ///< int psi exp(-psi/kT) dx: potential energy per area and bulk density
};
WallLayer wall_layer(const WallRepulsion& repulsion, double boltzmann, double temperature);

/// Of the walls of the equilibrium runs, as far as their friction reaches.
inline constexpr WallRepulsion mackie_repulsion{1.8, 1.24};

/// A box of mean density 1 as its particles see it.
struct MackieBulk {
  double side;     ///< between the layers that the walls exclude
  double density;  ///< in the middle
};
MackieBulk mackie_bulk(std::size_t particles, const WallRepulsion& repulsion, int walled_axes = 3);

/// Conductivity of the liquid at a density [MAN 3.28], at the walls' temperature.
double mackie_conductivity(double density);

/// A reservoir with the friction, conduction and range that two particles have.
Wall mackie_reservoir(const FluidParameters& fluid, double temperature,
                      const WallRepulsion& repulsion);

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
