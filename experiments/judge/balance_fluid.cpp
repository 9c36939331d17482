#include <cmath>

#include "experiments/judge/balance_runs.hpp"
#include "model/initial.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

constexpr std::size_t particles = 32;
constexpr double density = 3;
constexpr double settle = 4, period = 0.1;
constexpr int samples = 61;
const std::vector<int> lags = {1, 4};  // in periods

/// Moments of one particle: energies, n = sum w(r) over its neighbours, its rate of change, and
/// vectors along p, of which the three components follow each other.
enum Moment { K, u, u2, Ku, n, rate, p, pu = p + 3, pK = pu + 3, fluid_moments = pK + 3 };

const std::vector<MomentPair>& scalar_pairs() {
  static const std::vector<MomentPair> pairs = {
      {"K, u", K, u},           {"K, u^2", K, u2},         {"K, K u", K, Ku},
      {"K, n", K, n},           {"u, u^2", u, u2},         {"u, K u", u, Ku},
      {"u, n", u, n},           {"u^2, K u", u2, Ku},      {"u^2, n", u2, n},
      {"K u, n", Ku, n},        {"n, dn/dt", n, rate, -1}, {"u, dn/dt", u, rate, -1},
      {"K, dn/dt", K, rate, -1}};
  return pairs;
}

std::vector<MomentPair> vector_pairs(int axis) {
  return {{"p, p u", p + axis, pu + axis},
          {"p, p K", p + axis, pK + axis},
          {"p u, p K", pu + axis, pK + axis}};
}

/// One sample of all particles, a row each, with energies as shares of the present total energy:
/// where that drifts, what a method does at one energy is still seen.
Eigen::MatrixXd moments_of(System& system) {
  const auto& motion = system.motion();
  const double unit = (system.kinetic_energy() + system.internal_energy()) / particles;
  const double mass = system.fluid().mass();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(particles, static_cast<int>(fluid_moments));
  system.for_each_pair([&](const System::Geometry& pair) {
    const double closing = pair.e.dot(motion.velocity[pair.i] - motion.velocity[pair.j]);
    for (const auto i : {pair.i, pair.j}) {
      rows(i, n) += pair.w_friction;
      rows(i, rate) -= 2 * (1 - pair.r) * closing / std::sqrt(unit / mass);
    }
  });
  for (std::size_t i = 0; i < particles; ++i) {
    const Vector scaled = motion.velocity[i] * std::sqrt(mass / unit);
    const double kinetic = 0.5 * scaled.squaredNorm(), internal = motion.internal_energy[i] / unit;
    rows.row(i).segment<4>(K) << kinetic, internal, internal * internal, kinetic * internal;
    rows.row(i).segment<3>(p) = scaled;
    rows.row(i).segment<3>(pu) = internal * scaled;
    rows.row(i).segment<3>(pK) = kinetic * scaled;
  }
  return rows;
}

class FluidReplica {
 public:
  FluidReplica(const FluidParameters& parameters, std::uint64_t seed, std::uint64_t replica)
      : system_(start(Fluid(parameters), {seed, replica})) {}

  void advance(Integrator& integrator, double time, double step) {
    for (auto left = std::llround(time / step); left > 0; --left) {
      system_.set_step(++step_);
      integrator.step(system_, step);
    }
  }
  System& system() { return system_; }
  std::uint64_t step() const { return step_; }

 private:
  static System start(const Fluid& fluid, const Noise& noise) {
    const Box box = make_box(fluid, Layout::fluid, particles, density, 0);
    State state = place(box, Layout::fluid, Placement::random, particles, 0, noise);
    const auto law = microcanonical_law(fluid, Layout::fluid, particles);
    const double energy = law.energy_at(fluid.parameters().temperature);
    draw_microcanonical(fluid, Layout::fluid, energy, noise, state);
    return {fluid, box, std::move(state), noise};
  }

  System system_;
  std::uint64_t step_ = 0;
};

/// Centres and scales as the exact law has it, odd moments about 0.
struct Standard {
  Eigen::RowVectorXd mean, scale;

  explicit Standard(const FluidParameters& parameters) {
    constexpr int starts = 100;
    Eigen::MatrixXd rows(starts * particles, static_cast<int>(fluid_moments));
    for (int k = 0; k < starts; ++k) {
      FluidReplica replica(parameters, 1, k);
      rows.middleRows<particles>(k * static_cast<int>(particles)) = moments_of(replica.system());
    }
    mean = rows.colwise().mean();
    mean.tail(fluid_moments - rate).setZero();
    scale = (rows.rowwise() - mean).colwise().norm() / std::sqrt(double(rows.rows()));
  }
};

/// The differences of one replica: scalars, then vectors averaged over their components.
Eigen::VectorXd differences(const std::vector<Eigen::MatrixXd>& history, const Standard& standard) {
  const auto times = static_cast<Eigen::Index>(history.size());
  Eigen::VectorXd scalars, vectors;
  for (std::size_t i = 0; i < particles; ++i) {
    Eigen::MatrixXd series(times, static_cast<int>(fluid_moments));
    for (Eigen::Index t = 0; t < times; ++t) {
      series.row(t) = (history[t].row(i) - standard.mean).array() / standard.scale.array();
    }
    const auto add = [](Eigen::VectorXd& sum, const Eigen::VectorXd& more) {
      sum = sum.size() == 0 ? more : Eigen::VectorXd(sum + more);
    };
    add(scalars, reversal_differences(series, scalar_pairs(), lags));
    for (int axis = 0; axis < 3; ++axis) {
      add(vectors, reversal_differences(series, vector_pairs(axis), lags));
    }
  }
  Eigen::VectorXd all(scalars.size() + vectors.size());
  all << scalars / particles, vectors / (3 * particles);
  return all;
}

}  // namespace

std::vector<std::string> fluid_reversal_columns() {
  std::vector<std::string> names;
  for (const auto& pairs : {scalar_pairs(), vector_pairs(0)}) {
    for (const int lag : lags) {
      for (const auto& pair : pairs) {
        names.push_back(pair.name + (lag == 1 ? " after 0.1" : " after 0.4"));
      }
    }
  }
  return names;
}

json run_fluid_reversal(const Candidate& candidate, const FluidParameters& parameters,
                        double time_step, std::size_t replicas, std::uint64_t seed) {
  const Standard standard(parameters);
  Scatter scatter;
  json first;
  std::size_t failed = 0;
  for (std::size_t k = 0; k < replicas; ++k) {
    FluidReplica replica(parameters, seed, k);
    const auto integrator = candidate.make();
    std::vector<Eigen::MatrixXd> history;
    try {
      replica.advance(*integrator, settle, time_step);
      for (int sample = 0; sample < samples; ++sample) {
        if (sample > 0) replica.advance(*integrator, period, time_step);
        history.push_back(moments_of(replica.system()));
      }
      scatter.add(differences(history, standard));
    } catch (const StepFailure& failure) {
      ++failed;
      if (!first.is_null()) continue;
      first = {{"cause", to_string(failure.cause())},
               {"step", replica.step()},
               {"time", static_cast<double>(replica.step()) * time_step}};
    }
  }
  const double share = static_cast<double>(failed) / static_cast<double>(replicas);
  json record = {{"failed", share}};
  if (!first.is_null()) record["failure"] = first;
  if (share <= 0.2) record["reversal"] = scatter.record();
  return record;
}

}  // namespace driftless::judge
