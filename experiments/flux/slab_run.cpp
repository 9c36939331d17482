#include "experiments/flux/slab_run.hpp"

#include <cmath>

#include "experiments/flux/border_flux.hpp"
#include "experiments/flux/profile.hpp"
#include "model/heat_slabs.hpp"

namespace driftless::flux {
namespace {

using nlohmann::json;

constexpr int z_axis = 2;
constexpr double sample_period = 0.1;  ///< of profiles
constexpr double law_period = 0.05;    ///< of the laws' mean rates
constexpr double block = 0.5;          ///< times that fluxes are summed over

HeatSlabs slabs_of(const SlabRun& run) {
  const double length = run.fluid.lengths[z_axis], half = run.thickness / 2;
  const double area = run.fluid.box().volume() / length;
  return {.drive = SlabDrive::heat_rate,
          .axis = z_axis,
          .hot = {length / 4 - half, length / 4 + half},
          .cold = {3 * length / 4 - half, 3 * length / 4 + half},
          .rate = 2 * area * run.heat_flux};
}

/// Series of the fluxes of crossed_keys().
class PlaneFluxes {
 public:
  PlaneFluxes(const SlabRun& run, System& system)
      : region_{0, run.fluid.lengths[z_axis] / 2},
        reference_(system.internal_energy() / static_cast<double>(system.size())),
        border_(z_axis, region_, reference_),
        both_areas_(2 * system.box().volume() / run.fluid.lengths[z_axis]),
        inside_(border_.energy_inside(system)) {}

  BorderFlux& border() { return border_; }
  void sample_laws(System& system) {
    const PairRates now = pair_rates(system, z_axis, region_);
    laws_.conduction += now.conduction;
    laws_.work_of_friction += now.work_of_friction;
    laws_.work_of_repulsion += now.work_of_repulsion;
    ++sampled_;
  }
  /// Ends a block that took so long.
  void end_block(System& system, double duration) {
    const Crossed crossed = border_.take();
    const double per = 1 / (both_areas_ * duration), law = 1 / (both_areas_ * sampled_);
    const auto& hot = crossed.by_leaving;
    const auto& cold = crossed.by_entering;
    const double inside = border_.energy_inside(system);
    const double stored = (inside_ - inside) * per;
    const double laws = laws_.conduction + laws_.work_of_friction + laws_.work_of_repulsion;
    rows_.push_back(
        {(hot.internal - cold.internal) * per, (hot.kinetic - cold.kinetic) * per,
         (hot.potential - cold.potential) * per, hot.internal * per, hot.kinetic * per,
         hot.potential * per, cold.internal * per, cold.kinetic * per, cold.potential * per,
         crossed.pairs * per, laws_.conduction * law, laws_.work_of_friction * law,
         laws_.work_of_repulsion * law, crossed.created * per, -stored, crossed.total() * per,
         crossed.carried() * per + laws * law, 0.5 * (crossed.leaving + crossed.entering) * per});
    inside_ = inside;
    laws_ = {};
    sampled_ = 0;
  }
  json record() const {
    json all;
    for (std::size_t key = 0; key < crossed_keys().size(); ++key) {
      Eigen::VectorXd series(rows_.size());
      for (std::size_t n = 0; n < rows_.size(); ++n) series[n] = rows_[n][key];
      all[crossed_keys()[key]] = to_record(estimate_mean({series}));
    }
    all["reference"] = reference_;
    return all;
  }

 private:
  Slab region_;
  double reference_;  ///< internal energy that the fluxes are counted from
  BorderFlux border_;
  double both_areas_, inside_;
  PairRates laws_;
  double sampled_ = 0;
  std::vector<std::vector<double>> rows_;
};

json profile_record(const Profile& profile) {
  json record;
  for (std::size_t bin = 0; bin < profile.bins(); ++bin) {
    record["z"].push_back(profile.centre(bin));
    record["density"].push_back(to_record(profile.density(bin)));
    record["internal"].push_back(to_record(profile.internal_temperature(bin)));
    record["kinetic"].push_back(to_record(profile.kinetic_temperature(bin)));
  }
  return record;
}

/// The bins whose distance from the hot slab's middle is in the range.
std::vector<std::size_t> bins_between(const Profile& profile, double length, double from,
                                      double to) {
  std::vector<std::size_t> bins;
  for (std::size_t bin = 0; bin < profile.bins(); ++bin) {
    double away = profile.centre(bin) - length / 4;
    away = std::abs(away - length * std::round(away / length));
    if (away > from && away < to) bins.push_back(bin);
  }
  return bins;
}

json line_record(const SlabRun& run, const Profile& profile, double from, double to) {
  const double length = run.fluid.lengths[z_axis];
  const auto line = profile.line(bins_between(profile, length, from, to), length / 4);
  const double conductivity = -run.heat_flux / line.slope.mean;
  return {{"slope", to_record(line.slope)},
          {"middle", to_record(line.middle)},
          {"density", to_record(line.mean_density)},
          {"conductivity",
           {{"mean", conductivity},
            {"error", std::abs(conductivity * line.slope.error / line.slope.mean)}}}};
}

json lines_record(const SlabRun& run, const Profile& profile) {
  const double half = run.fluid.lengths[z_axis] / 2, clear = 1.5 * run.thickness;
  return {{"whole", line_record(run, profile, clear, half - clear)},
          {"hot", line_record(run, profile, clear, half / 2)},
          {"cold", line_record(run, profile, half / 2, half - clear)}};
}

}  // namespace

const std::vector<std::string>& crossed_keys() {
  static const std::vector<std::string> keys = {
      "internal",           "kinetic",       "potential",      "hot internal",
      "hot kinetic",        "hot potential", "cold internal",  "cold kinetic",
      "cold potential",     "pairs",         "law conduction", "law friction work",
      "law repulsion work", "created",       "stored",         "sum",
      "sum by laws",        "crossings"};
  return keys;
}

json run_between_slabs(const SlabRun& run) {
  Run fluid(run.fluid, 0);
  System& system = fluid.system();
  SlabHeater heater(slabs_of(run), system.fluid(), system.box(), Noise(run.fluid.seed, 1));
  const double start = system.total_energy();
  double worst = 0;
  const auto heat = [&] {
    heater.act(system, run.fluid.step);
    worst = std::max(worst, std::abs(system.total_energy() - start - heater.given()));
  };
  fluid.advance(run.settle, heat);

  Profile profile(system.box(), z_axis, run.bins);
  PlaneFluxes planes(run, system);
  const auto samples = fluid.steps_in(sample_period), blocks = fluid.steps_in(block),
             laws = fluid.steps_in(law_period);
  if (run.planes) planes.border().before(system);
  std::uint64_t step = 0;
  fluid.advance(run.duration, [&] {
    ++step;
    if (run.planes) planes.border().after(system);
    if (step % samples == 0) {
      profile.sample(system);
    }
    if (run.planes && step % laws == 0) planes.sample_laws(system);
    heat();
    if (run.planes && step % blocks == 0) planes.end_block(system, block);
    if (run.planes) planes.border().before(system);
  });
  json record = {{"profile", profile_record(profile)},
                 {"lines", lines_record(run, profile)},
                 {"balance", worst / std::abs(start)},
                 {"heat_flux", run.heat_flux}};
  if (run.planes) record["crossed"] = planes.record();
  return record;
}

}  // namespace driftless::flux
