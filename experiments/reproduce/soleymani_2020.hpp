#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/flux/equilibrium_run.hpp"
#include "experiments/flux/slab_run.hpp"
#include "experiments/reproduce/experiment.hpp"
#include "experiments/reproduce/interval_arithmetic.hpp"

/// What the experiments of Soleymani, Ripoll, Gompper and Fedosov, J. Chem. Phys. 152, 064112
/// (2020), [So20], share. The paper's parameters are not known to us: these are ours.
namespace driftless::reproduce::so20 {

inline const MethodChoice published{"isoenergetic-verlet", {}};
inline const MethodChoice contrast{"shardlow-s1", {}};

/// The paper's method, or the one in its place.
MethodChoice leading_method(const Conditions& conditions);
/// That one and, if it is another, the contrast.
std::vector<MethodChoice> methods(const Conditions& conditions);

/// Repulsion and heat form, of which the paper combines several.
struct Combination {
  double repulsion;
  HeatForm heat_form;
  double thermal_repulsion = 0;  ///< in proportion to the temperature, this at T = 1
  std::string name() const;
};
/// Without repulsion and with a constant one, each with both heat forms.
const std::vector<Combination>& combinations();
/// These and a repulsion in proportion to the temperature, with both heat forms. The paper's scheme
/// does not run it.
const std::vector<Combination>& all_combinations();

/// Why a method cannot run one of the combinations without a repulsion that follows the
/// temperature, nothing if it runs them all.
std::optional<std::string> unsuited(const MethodChoice& method);
bool runs(const MethodChoice& method, const Combination& combination);
/// Those of methods() that run a combination, which the contrast always does.
std::vector<MethodChoice> methods_for(const Combination& combination, const Conditions& conditions);

/// The fluid of a combination: m = k = r_c = 1, friction 4.5 at T = 1 with the noise closure, heat
/// capacity 60, conduction 300, weights (1 - r)^2.
FluidParameters fluid_of(const Combination& combination);

/// That fluid in a box along z, at density 3 and T = 1, with a time step of 0.01.
flux::PeriodicFluid box_of(const Combination& combination, const MethodChoice& method,
                           const Conditions& conditions);

/// Between slabs, long enough for the temperatures to have followed, measured for longer if `full`.
flux::SlabRun slabs_of(const flux::PeriodicFluid& fluid, double heat_flux, Effort effort);

/// How long an equilibrium run is.
double equilibrium_duration(Effort effort);

/// Seconds that a run of so many units of time takes, about.
double cost_of(const flux::PeriodicFluid& fluid, double duration);

/// `work`'s record, or {"failure"} if the method fails.
nlohmann::json or_failure(const std::function<nlohmann::json()>& work);
bool failed(const nlohmann::json& record);
/// The record of a part; nothing if its method failed, which a remark then says.
const nlohmann::json* record_or_remark(const Records& records, const std::string& part,
                                       Outcome& outcome);

/// Of an estimate {"mean", "error"}.
Interval interval_of(const nlohmann::json& estimate);
judge::Point point_of(double x, const Interval& interval);
/// An exact value.
Interval exactly(double value);

/// What the setting of a row says of the fluid's run.
std::string setting_of(const std::string& name, const MethodChoice& method,
                       const std::string& more = "");

/// How the paper's formulas are named where theory stands beside ours: no number of them is known
/// to us, so that they are evaluated here.
inline constexpr const char* analytic_name = "analytic (eq. 17-26)";

/// A ratio to what it should be about, and where it was measured.
struct RatioAt {
  std::string where;
  Interval ratio;
};
/// A sentence of the paper, "this is about that": that of the ratios which is farthest from 1,
/// which agrees if it is within 25 %. There must be one.
Row about_row(std::string quantity, std::string setting, std::string words,
              const std::vector<RatioAt>& ratios);

/// What was chosen for all of these experiments.
std::vector<std::string> common_remarks(const Conditions& conditions);

}  // namespace driftless::reproduce::so20
