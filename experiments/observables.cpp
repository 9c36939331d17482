#include "experiments/observables.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <stdexcept>

#include "experiments/primary_quantities.hpp"

namespace driftless {
namespace {

using Means = Eigen::VectorXd;

/// An observable that follows from the means of primary quantities.
struct Derivation {
  std::string_view name;
  std::function<bool(const PreparedScene&)> applies;
  std::vector<int> columns;
  /// value(prepared, means of the columns)
  double (*value)(const PreparedScene&, const Means&);
};

bool always(const PreparedScene& prepared) { return prepared.fluid().fluctuates(); }
bool has_internal_energies(const PreparedScene& prepared) {
  return prepared.fluid().fluctuates() && !prepared.fluid().isothermal();
}
bool has_kinetic_law(const PreparedScene& prepared) {
  return prepared.law() && prepared.law()->degrees > 0;
}
bool has_potential(const PreparedScene& prepared) {
  return prepared.fluid().has_repulsion() && prepared.fluid().fluctuates();
}
bool is_fluid(const PreparedScene& prepared) {
  return prepared.scene().layout == Layout::fluid && !prepared.scene().frozen &&
         prepared.fluid().fluctuates();
}

double kinetic_temperature(const PreparedScene& prepared, const Means& m) {
  return 2 * m[0] / (prepared.kinetic_degrees() * prepared.fluid().boltzmann());
}

double variance(const Means& m) { return m[1] - m[0] * m[0]; }

const std::vector<Derivation>& derivations() {
  using P = PreparedScene;
  static const std::vector<Derivation> all = {
      {"kinetic_temperature", always, {Primary::kinetic}, kinetic_temperature},
      {"internal_temperature",
       has_internal_energies,
       {Primary::inverse_temperature},
       [](const P&, const Means& m) { return 1 / m[0]; }},
      {"configurational_temperature",
       has_potential,
       {Primary::squared_force, Primary::laplacian},
       [](const P& p, const Means& m) { return m[0] / (p.fluid().boltzmann() * m[1]); }},
      {"internal_energy_mean",
       has_internal_energies,
       {Primary::energy_1},
       [](const P&, const Means& m) { return m[0]; }},  // the offset is added in evaluate
      {"internal_energy_variance",
       has_internal_energies,
       {Primary::energy_1, Primary::energy_2},
       [](const P&, const Means& m) { return variance(m); }},
      {"internal_energy_skewness",
       has_internal_energies,
       {Primary::energy_1, Primary::energy_2, Primary::energy_3},
       [](const P&, const Means& m) {
         // Energies all alike but for rounding have no skewness: not a number, so left out.
         if (variance(m) <= 1e-20 * m[1] || variance(m) <= 0) return std::nan("");
         const double third = m[2] - 3 * m[0] * m[1] + 2 * m[0] * m[0] * m[0];
         return third / std::pow(variance(m), 1.5);
       }},
      {"kinetic_share",
       has_kinetic_law,
       {Primary::kinetic_share},
       [](const P& p, const Means& m) {
         return m[0] * p.law()->total_shape() / (0.5 * p.law()->degrees);
       }},
      {"pressure",
       is_fluid,
       {Primary::kinetic, Primary::virial},
       [](const P& p, const Means& m) {
         const double density = static_cast<double>(p.scene().particles) / p.box().volume();
         return density * p.fluid().boltzmann() * kinetic_temperature(p, m) +
                m[1] / (3 * p.box().volume());
       }},
      {"potential_energy",
       has_potential,
       {Primary::potential},
       [](const P&, const Means& m) { return m[0]; }},
  };
  return all;
}

std::vector<Eigen::MatrixXd> columns_of(const std::vector<Record>& records,
                                        const std::vector<int>& columns) {
  std::vector<Eigen::MatrixXd> replicas;
  for (const auto& record : records) replicas.push_back(record.samples(Eigen::all, columns));
  return replicas;
}

/// The mean of u about which its powers were taken; one number for all records of a scene.
double energy_offset(const PreparedScene& prepared) {
  const auto exact = prepared.reference("internal_energy_mean");
  return exact ? exact->value : 0;
}

template <class Select>
std::vector<Block> gather(const std::vector<Record>& records, Select&& select) {
  std::vector<Block> all;
  for (const auto& record : records) {
    const auto& blocks = select(record);
    all.insert(all.end(), blocks.begin(), blocks.end());
  }
  return all;
}

Histogram rescaled(Histogram histogram, double factor) {
  for (auto& x : histogram.x) x *= factor;
  for (auto* values : {&histogram.density, &histogram.error, &histogram.exact}) {
    for (auto& value : *values) value /= factor;
  }
  return histogram;
}

void add_distributions(const PreparedScene& prepared, const std::vector<Record>& records,
                       CellObservables& cell) {
  if (!prepared.distributions()) return;
  const auto& exact = *prepared.distributions();
  const double unit = prepared.energy_unit(), e = prepared.island_energy();
  if (exact.internal_energy) {
    const auto energies = gather(records, [](const Record& r) { return r.internal_energy_blocks; });
    cell.observed.push_back({"internal_energy_distance", distribution_distance(energies),
                             prepared.reference("internal_energy_distance")});
    cell.internal_energy = rescaled(display_histogram(*exact.internal_energy, energies), e / unit);
  }
  const bool isothermal = prepared.fluid().isothermal();
  if (!isothermal && prepared.law()->degrees == 0) return;
  const auto momenta = gather(records, [](const Record& r) { return r.momentum_blocks; });
  cell.observed.push_back({"momentum_distance", distribution_distance(momenta),
                           prepared.reference("momentum_distance")});
  const double islanders = static_cast<double>(prepared.island_size());
  const double spread = isothermal ? 1 - 1 / islanders : 2 * e * (1 - 1 / islanders) / unit;
  cell.momentum = rescaled(display_histogram(exact.momentum, momenta), std::sqrt(spread));
}

Histogram radial_distribution(const PreparedScene& prepared, const std::vector<Record>& records) {
  Histogram g;
  std::vector<std::vector<double>> blocks;  // pairs per snapshot
  for (const auto& record : records) {
    for (std::size_t n = 0; n < record.distance_blocks.size(); ++n) {
      if (record.distance_snapshots[n] == 0) continue;
      const auto& counts = record.distance_blocks[n].counts;
      blocks.emplace_back(counts.begin(), counts.end());
      for (auto& count : blocks.back()) count /= record.distance_snapshots[n];
    }
  }
  if (blocks.empty()) return g;
  const double n = static_cast<double>(prepared.scene().particles);
  const double pairs_per_volume = 0.5 * n * (n - 1) / prepared.box().volume();
  const double width = Sampler::distance_range(prepared) / Sampler::distance_bins;
  for (std::size_t bin = 0; bin < Sampler::distance_bins; ++bin) {
    const double inner = width * static_cast<double>(bin), outer = inner + width;
    const double shell = 4.0 / 3.0 * std::numbers::pi * (std::pow(outer, 3) - std::pow(inner, 3));
    double sum = 0, squares = 0;
    for (const auto& block : blocks) {
      const double value = block[bin] / (pairs_per_volume * shell);
      sum += value;
      squares += value * value;
    }
    const double count = static_cast<double>(blocks.size()), mean = sum / count;
    g.x.push_back(0.5 * (inner + outer));
    g.density.push_back(mean);
    g.error.push_back(
        std::sqrt(std::max(0.0, squares / count - mean * mean) / std::max(1.0, count - 1)));
    if (!prepared.fluid().has_repulsion()) g.exact.push_back(1);
  }
  return g;
}

/// The replica that started off equilibrium against all the others, by the observables that relax
/// slowly or fast but surely.
void compare_off_equilibrium(const PreparedScene& prepared, const std::vector<Record>& records,
                             const std::vector<unsigned>& replicas, CellObservables& cell) {
  static const std::set<std::string_view> compared = {"kinetic_temperature", "internal_temperature",
                                                      "internal_energy_variance", "kinetic_share",
                                                      "potential_energy"};
  std::vector<Record> off, others;
  for (std::size_t n = 0; n < records.size(); ++n) {
    (prepared.starts_off_equilibrium(replicas[n]) ? off : others).push_back(records[n]);
  }
  if (off.empty() || others.empty()) return;
  cell.has_off_equilibrium = true;
  for (const auto& derivation : derivations()) {
    if (!compared.contains(derivation.name) || !derivation.applies(prepared)) continue;
    const auto derived = [&](const Means& m) { return derivation.value(prepared, m); };
    const auto one = estimate(columns_of(off, derivation.columns), derived);
    const auto many = estimate(columns_of(others, derivation.columns), derived);
    // One replica's error is taken from the others: its own grows with the very trend to be seen.
    const double count = static_cast<double>(others.size());
    const double z =
        agreement_z({one.mean, many.error * std::sqrt(count), one.effective_samples, false}, many);
    if (observable_spec(derivation.name).relaxation == Relaxation::kinetic_energy) {
      cell.kinetic_z = std::max(cell.kinetic_z, z);
    }
    if (z < cell.largest_z) continue;
    cell.largest_z = z;
    cell.disagreeing = derivation.name;
  }
}

Estimate largest_momentum_error(const std::vector<Record>& records) {
  Estimate largest;
  for (const auto& record : records) {
    largest.mean = std::max(largest.mean, record.momentum_error);
    largest.effective_samples += static_cast<double>(record.samples.rows());
  }
  return largest;
}

}  // namespace

const std::vector<ObservableSpec>& observable_specs() {
  constexpr auto none = Relaxation::none, kinetic = Relaxation::kinetic_energy,
                 internal = Relaxation::internal_energy;
  static const std::vector<ObservableSpec> specs = {
      {"kinetic_temperature", "temperature", "2K/(degrees k), centre of mass at rest", kinetic},
      {"internal_temperature", "temperature", "1/<1/theta>, unbiased at any heat capacity",
       internal},
      {"configurational_temperature", "temperature", "<|grad Psi|^2>/(k <lap Psi>)", kinetic},
      {"internal_energy_mean", "energy", "<u> per particle", internal},
      {"internal_energy_variance", "energy^2", "variance of u over particles and time", internal},
      {"internal_energy_skewness", "1", "skewness of u over particles and time", internal},
      {"momentum_distance", "1",
       "squared distance of the momenta's distribution from the exact law: unbiased "
       "Cramer-von Mises statistic, int (F - F0)^2 dF0, from independent blocks; 0 if exact",
       kinetic},
      {"internal_energy_distance", "1", "the same for the internal energies", internal},
      {"kinetic_share", "1", "kinetic over kinetic plus internal energy, over its exact mean",
       kinetic},
      {"pressure", "energy/length^3", "rho k T_kin plus the virial of the repulsion", kinetic},
      {"potential_energy", "energy", "potential energy per particle", kinetic},
      {"energy_drift", "kT/time", "systematic slope of the total energy per particle", none},
      {"energy_walk", "(kT)^2/time",
       "growth of the variance of the total energy by its random walk, per particle", none},
      {"momentum_error", "sqrt(m kT)", "largest change of total momentum, per particle", none},
  };
  return specs;
}

const ObservableSpec& observable_spec(std::string_view name) {
  const auto& specs = observable_specs();
  return *std::find_if(specs.begin(), specs.end(), [&](const auto& s) { return s.name == name; });
}

namespace {

void add_energy_drift(const PreparedScene& prepared, const std::vector<Record>& records,
                      CellObservables& cell) {
  std::vector<EnergyTrace> traces;
  for (const auto& record : records) traces.push_back(record.energy);
  cell.drift = energy_drift(traces);
  cell.observed.push_back({"energy_drift", cell.drift.slope, Reference{0, 0}});
  // Energies are per particle: their walk's variance is N times smaller than that of a particle.
  const double n = static_cast<double>(prepared.scene().particles);
  const auto& walk = cell.drift.walk;
  cell.observed.push_back({"energy_walk",
                           {walk.value * n, walk.error * n, walk.effective_increments, false},
                           std::nullopt,
                           {{walk.lower * n, walk.upper * n}}});
}

}  // namespace

CellObservables evaluate(const PreparedScene& prepared, const std::vector<Record>& records,
                         const std::vector<unsigned>& replicas) {
  CellObservables cell;
  if (records.empty()) return cell;
  for (const auto& derivation : derivations()) {
    if (!derivation.applies(prepared)) continue;
    Observed observed{derivation.name, {}, prepared.reference(derivation.name)};
    try {
      observed.value = estimate(columns_of(records, derivation.columns),
                                [&](const Means& m) { return derivation.value(prepared, m); });
    } catch (const std::domain_error&) {
      continue;  // not defined at these means, as a skewness without variance
    }
    if (derivation.name == "internal_energy_mean") observed.value.mean += energy_offset(prepared);
    cell.observed.push_back(observed);
  }
  if (prepared.fluid().fluctuates()) add_distributions(prepared, records, cell);
  if (!prepared.fluid().isothermal()) add_energy_drift(prepared, records, cell);
  cell.observed.push_back({"momentum_error", largest_momentum_error(records), std::nullopt});
  cell.radial_distribution = radial_distribution(prepared, records);
  compare_off_equilibrium(prepared, records, replicas, cell);
  return cell;
}

}  // namespace driftless
