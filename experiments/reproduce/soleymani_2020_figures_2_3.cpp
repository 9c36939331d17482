#include <fmt/format.h>

#include <cmath>

#include "experiments/reproduce/experiments.hpp"
#include "experiments/reproduce/soleymani_2020.hpp"

namespace driftless::reproduce {
namespace {

using namespace so20;
using nlohmann::json;

constexpr double heat_flux = 10;

std::string part_name(const Combination& combination, const MethodChoice& method) {
  return combination.name() + ", " + to_string(method);
}

std::vector<Part> parts(const Conditions& conditions) {
  std::vector<Part> all;
  for (const auto& combination : all_combinations()) {
    for (const auto& method : methods_for(combination, conditions)) {
      const auto run =
          slabs_of(box_of(combination, method, conditions), heat_flux, conditions.effort);
      all.push_back({part_name(combination, method), cost_of(run.fluid, run.settle + run.duration),
                     false, [run](const Workplace&) {
                       return or_failure([&] { return flux::run_between_slabs(run); });
                     }});
    }
  }
  return all;
}

/// The bin whose centre is nearest to a position.
std::size_t bin_at(const json& profile, double z) {
  std::size_t best = 0;
  for (std::size_t n = 0; n < profile["z"].size(); ++n) {
    const auto away = [&](std::size_t bin) {
      return std::abs(profile["z"][bin].get<double>() - z);
    };
    if (away(n) < away(best)) best = n;
  }
  return best;
}

/// Hot over cold, one and a half thicknesses from the slabs' middles.
Interval hot_over_cold(const json& record, const char* key, double length) {
  const json& profile = record["profile"];
  const auto at = [&](double z) { return interval_of(profile[key][bin_at(profile, z)]); };
  return ratio(at(length / 4 + 1.5), at(3 * length / 4 - 1.5));
}

/// What the conductivities of the two halves of the way should be to each other, without structure:
/// at the temperatures and densities measured there.
double expected_halves(const Combination& combination, const json& lines) {
  const auto conductivity = [&](const char* half) {
    const double density = lines[half]["density"]["mean"], t = lines[half]["middle"]["mean"];
    const auto fluid = fluid_of(combination);
    return flux::predicted_conductivity(fluid, density, t,
                                        flux::without_structure(fluid, density, t))
        .total();
  };
  return conductivity("hot") / conductivity("cold");
}

/// By the equation of state p = rho k T + 0.101 a rho^2 r_c^4 of the soft fluid [GW97], whose
/// strength a is here in proportion to the temperature.
Row whole_pressure(const Combination& combination, const std::string& setting, const json& record,
                   double length) {
  constexpr double groot_warren = 0.101;
  const Interval t = hot_over_cold(record, "kinetic", length),
                 rho = hot_over_cold(record, "density", length);
  const double strength = groot_warren * combination.thermal_repulsion;
  const double cold =
      interval_of(record["profile"]["density"][bin_at(record["profile"], 3 * length / 4 - 1.5)])
          .value;
  const double factor = (1 + strength * cold * rho.value) / (1 + strength * cold);
  Row row{
      "p hot/cold: rho k T + 0.101 a rho^2",
      setting,
      "1",
      {},
      "",
      scaled(product(t, rho), factor),
      Verdict::ours_alone,
      "The strength follows T, so that the fluid has one structure at all temperatures and the "
      "density at hot places lies between that without repulsion and that with a constant one."};
  put_theory(row, 1,
             "equal pressure everywhere, by the equation of state of Groot and Warren (1997)", 0.1);
  return row;
}

std::string about_density(const Combination& combination) {
  if (combination.thermal_repulsion != 0) {
    return "A repulsion that grows with T leaves about T^-1/2.";
  }
  return combination.repulsion == 0 ? "Without repulsion the density goes as 1/T."
                                    : "A repulsion that is stronger than k T all but evens it out.";
}

void add_rows(const Combination& combination, const MethodChoice& method, const json& record,
              double length, Outcome& outcome) {
  const auto setting =
      setting_of(combination.name(), method, fmt::format("heat flux {:g}", heat_flux));
  const Interval temperatures = hot_over_cold(record, "kinetic", length);
  const Interval densities = hot_over_cold(record, "density", length);
  Row balance{"p_ideal hot/cold: density x kinetic temperature",
              setting,
              "1",
              {},
              "",
              product(temperatures, densities),
              Verdict::ours_alone,
              "One unit of length beside the hot slab, over the same beside the cold one."};
  if (combination.thermal_repulsion != 0) {
    balance.explanation += " Repulsion has its part of the pressure: see the next row.";
  } else if (combination.repulsion == 0) {
    put_theory(balance, 1, "equal pressure, rho k T, everywhere (exact)", 0.1);
  } else {
    balance.explanation +=
        " Repulsion keeps the density, so that the ideal part of the pressure is not uniform.";
  }
  outcome.rows.push_back(balance);
  if (combination.thermal_repulsion != 0) {
    outcome.rows.push_back(whole_pressure(combination, setting, record, length));
  }
  outcome.rows.push_back({"density hot/cold",
                          setting,
                          "1",
                          {},
                          "",
                          densities,
                          Verdict::ours_alone,
                          about_density(combination)});
  const json& lines = record["lines"];
  const Interval halves =
      ratio(interval_of(lines["hot"]["conductivity"]), interval_of(lines["cold"]["conductivity"]));
  Row curvature{"conductivity of the hot half / of the cold half",
                setting,
                "1",
                {},
                "",
                halves,
                Verdict::ours_alone,
                "Slope of the cold half over that of the hot half: the profile's curvature. Theory "
                "has a particle in the mean of the others; what it leaves out is largest where "
                "there are few neighbours, which without repulsion is the hot half."};
  put_theory(curvature, expected_halves(combination, lines),
             "theory without structure at the local density and temperature", 0.2);
  outcome.rows.push_back(curvature);
}

Picture picture(const Records& records, const MethodChoice& method,
                const std::vector<const char*>& keys, const std::string& title,
                const std::string& unit) {
  judge::Chart chart{title, {"z"}, {unit}, {}};
  for (const auto& combination : all_combinations()) {
    if (!runs(method, combination)) continue;
    const json& record = records.at(part_name(combination, method));
    if (failed(record)) continue;
    for (const char* key : keys) {
      const bool several = keys.size() > 1;
      judge::Series series{combination.name() + (several ? std::string(", ") + key : ""), {}};
      for (std::size_t n = 0; n < record["profile"]["z"].size(); ++n) {
        series.points.push_back(
            point_of(record["profile"]["z"][n], interval_of(record["profile"][key][n])));
      }
      chart.series.push_back(std::move(series));
    }
  }
  return {title,
          fmt::format("{}, heat flux {:g} each way from the hot slab, at a quarter of the box, to "
                      "the cold one, at three quarters.",
                      to_string(method), heat_flux),
          std::move(chart),
          {}};
}

Outcome conclude(const Conditions& conditions, const Records& records) {
  Outcome outcome;
  outcome.remarks = common_remarks(conditions);
  for (const auto& combination : all_combinations()) {
    for (const auto& method : methods_for(combination, conditions)) {
      const auto* record = record_or_remark(records, part_name(combination, method), outcome);
      if (!record) continue;
      const double length = box_of(combination, method, conditions).lengths[2];
      add_rows(combination, method, *record, length, outcome);
    }
  }
  for (const auto& method : methods(conditions)) {
    const auto name = to_string(method);
    outcome.pictures.push_back(picture(records, method, {"density"},
                                       fmt::format("So20 Fig. 2: density profiles, {}", name),
                                       "number density"));
    outcome.pictures.push_back(picture(records, method, {"internal", "kinetic"},
                                       fmt::format("So20 Fig. 3: temperature profiles, {}", name),
                                       "temperature"));
  }
  outcome.remarks.push_back(
      "The repulsion in proportion to the temperature is a = 25 (theta_i + theta_j)/2 with the "
      "equations of motion that conservation of energy and entropy demands "
      "(results/temperature_dependent_repulsion.md); the paper's scheme charges it in another way "
      "and is not run with it.");
  if (conditions.method) {
    const auto reason = first_refusal(*conditions.method, {fluid_of(all_combinations().back())});
    if (reason) outcome.remarks.push_back(*reason + ".");
  }
  outcome.remarks.push_back(
      "Temperatures are 1/<1/theta> of the internal energies and that of the kinetic energy. They "
      "part inside the slabs, where heat goes into internal energies and kinetic ones follow.");
  return outcome;
}

}  // namespace

const Experiment soleymani_2020_figures_2_3{
    .name = "soleymani-2020-figures-2-3",
    .source = "So20 Fig. 2, 3",
    .title = "Density and temperature between a hot and a cold slab",
    .question =
        "Soleymani et al. drive heat through a periodic box between two slabs and show the "
        "profiles of density and temperature for several repulsions and forms of conduction. Here "
        "without repulsion, with a constant one and with one in proportion to the temperature, "
        "each "
        "with conduction driven by differences of inverse temperatures and of temperatures, by the "
        "paper's scheme (but for the last) and by a sequential splitting (shardlow-s1).",
    .parts = parts,
    .conclude = conclude,
    .unsuited = unsuited};

}  // namespace driftless::reproduce
