// Whether Anderson acceleration pays in the implicit methods: their fixed-point iteration as it
// stands against SUNDIALS KINSOL (KIN_FP), which mixes the last `depth` rounds, from the same
// states, with the same kernels and the same criterion: no internal energy changes by more than
// 1e-12 of the mean. One thread. A round is two visits of all pairs.
//
// First what it costs: rounds and time a step, and by how much the solutions differ. Solvers take
// every step in turns and from the same state; times are medians of processor time, "over plain" is
// the median of the ratios within a step, so that a machine that drifts favours none. Then how far
// it goes: the largest step at which the equations are solved for every one of 20 noises, and how
// many are solved beyond it.

#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <sundials/sundials_context.hpp>
#include <vector>

#include "integrators/end_point_iteration.hpp"
#include "integrators/integrator.hpp"
#include "model/initial.hpp"
#include "model/instruction_set.hpp"

namespace driftless {
namespace {

constexpr double tolerance = 1e-12;
constexpr int most_rounds = 100;

/// The equations of a method: a round with its kernels. They are compared with the registered
/// method.
enum class Scheme { implicit, midpoint };

std::string name_of(Scheme scheme) {
  return scheme == Scheme::implicit ? "avalos-mackie-implicit" : "avalos-mackie-midpoint";
}

template <class V>
Transfer<V> implicit_energy(const Fluid& fluid, const Pair<V>& start, const TrialPair<V>& end,
                            double dt) {
  using std::sqrt;
  auto total = end_point_conduction(fluid, start, end, dt);
  if (!fluid.has_friction()) return total;
  const V kick = sqrt(fluid.friction(end).noise_squared * dt) * start.noise;
  const V dissipated = 0.5 * fluid.friction(start).friction * start.v * start.v * dt;
  total += {V(0), dissipated - 0.5 * kick * (start.v - end.dv_j),
            dissipated - 0.5 * kick * (start.v + end.dv_i)};
  return total;
}

template <class V>
Transfer<V> midpoint_energy(const Fluid& fluid, const Pair<V>& start, const TrialPair<V>& end,
                            const V& momentum, double dt) {
  auto total = end_point_conduction(fluid, start, end, dt);
  return total += midpoint_work(momentum - fluid.repulsive_force(start.r) * dt, start, end);
}

/// solve(momentum, energy) with the kernels of a scheme.
template <class Solve>
void with_kernels(Scheme scheme, const Fluid& fluid, double dt, Solve&& solve) {
  const auto momentum = [&fluid, dt](const auto& start, const auto& end) {
    return end_point_momentum(fluid, start, end, dt);
  };
  if (scheme == Scheme::implicit) {
    solve(momentum, [&fluid, dt](const auto& start, const auto& end, const auto&) {
      return implicit_energy(fluid, start, end, dt);
    });
  } else {
    solve(momentum, [&fluid, dt](const auto& start, const auto& end, const auto& f) {
      return midpoint_energy(fluid, start, end, f, dt);
    });
  }
}

/// The iteration of the registered methods.
class Plain : public Integrator {
 public:
  explicit Plain(Scheme scheme) : scheme_(scheme) {}

  void step(System& system, double dt) override {
    with_kernels(scheme_, system.fluid(), dt, [&](const auto& momentum, const auto& energy) {
      iteration_.step(system, dt, tolerance, momentum, energy);
    });
  }

 private:
  Scheme scheme_;
  EndPointIteration iteration_;
};

void check(bool sound, const char* what) {
  if (!sound) throw std::runtime_error(what);
}

/// A step solved by KINSOL. Its criterion is the largest change from one iterate to the next,
/// scaled by the mean internal energy: that of the plain iteration, but for the mixing.
class Accelerated : public Integrator {
 public:
  Accelerated(Scheme scheme, int depth) : scheme_(scheme), depth_(depth) {}
  ~Accelerated() override { release(); }
  Accelerated(const Accelerated&) = delete;
  Accelerated& operator=(const Accelerated&) = delete;

  void step(System& system, double dt) override {
    prepare(system.size());
    system_ = &system;
    dt_ = dt;
    cause_.reset();
    round_.start(system);
    const auto& start = system.motion().internal_energy;
    std::copy(start.begin(), start.end(), N_VGetArrayPointer(solution_));
    N_VConst(static_cast<double>(system.size()) / system.internal_energy(), scale_);
    if (KINSol(memory_, solution_, KIN_FP, scale_, scale_) < 0) {
      throw StepFailure(cause_.value_or(FailureCause::not_converged), {});
    }
    // What the last round made of its start conserves what a round conserves; the mixture does not.
    auto& motion = round_.trial();
    for (std::size_t i = 0; i < system.size(); ++i) {
      motion.internal_energy[i] = round_.next(system, i);
    }
    system.move(dt);
    system.set_motion(motion);
  }

 private:
  void prepare(std::size_t particles) {
    if (memory_ && static_cast<std::size_t>(N_VGetLength(solution_)) == particles) return;
    release();
    solution_ = N_VNew_Serial(static_cast<sunindextype>(particles), context_);
    scale_ = N_VNew_Serial(static_cast<sunindextype>(particles), context_);
    memory_ = KINCreate(context_);
    check(solution_ && scale_ && memory_, "KINSOL has no memory");
    check(KINSetNumMaxIters(memory_, most_rounds) == 0 && KINSetMAA(memory_, depth_) == 0 &&
              KINInit(memory_, &Accelerated::next, solution_) == 0 &&
              KINSetUserData(memory_, this) == 0 && KINSetFuncNormTol(memory_, tolerance) == 0 &&
              KINSetErrHandlerFn(memory_, &Accelerated::ignore, nullptr) == 0,
          "KINSOL refuses a setting");
  }

  void release() {
    if (memory_) KINFree(&memory_);
    if (solution_) N_VDestroy(solution_);
    if (scale_) N_VDestroy(scale_);
  }

  static int next(N_Vector from, N_Vector to, void* self) {
    return static_cast<Accelerated*>(self)->next(N_VGetArrayPointer(from), N_VGetArrayPointer(to));
  }
  static void ignore(int, const char*, const char*, char*, void*) {}

  int next(const double* from, double* to) {
    const std::size_t particles = system_->size();
    for (std::size_t i = 0; i < particles; ++i) {
      if (!is_energy(from[i])) return failed(from[i]);
    }
    std::copy(from, from + particles, round_.trial().internal_energy.begin());
    with_kernels(scheme_, system_->fluid(), dt_, [&](const auto& momentum, const auto& energy) {
      round_.evaluate(*system_, momentum, energy);
    });
    for (std::size_t i = 0; i < particles; ++i) {
      to[i] = round_.next(*system_, i);
      if (!is_energy(to[i])) return failed(to[i]);
    }
    return 0;
  }

  static bool is_energy(double u) { return std::isfinite(u) && u > 0; }
  int failed(double u) {
    cause_ = std::isfinite(u) ? FailureCause::negative_internal_energy : FailureCause::non_finite;
    return -1;
  }

  Scheme scheme_;
  int depth_;
  sundials::Context context_;
  void* memory_ = nullptr;
  N_Vector solution_ = nullptr, scale_ = nullptr;
  EndPointRound round_;
  System* system_ = nullptr;
  double dt_ = 0;
  std::optional<FailureCause> cause_;
};

constexpr int registered = -2, plain = -1;  ///< instead of a depth

std::unique_ptr<Integrator> make_solver(Scheme scheme, int depth) {
  if (depth == registered) {
    return find_method(name_of(scheme))->make({{"tolerance", tolerance}});
  }
  if (depth == plain) return std::make_unique<Plain>(scheme);
  return std::make_unique<Accelerated>(scheme, depth);
}

std::string solver_name(int depth) {
  if (depth == registered) return "registered";
  return depth == plain ? "plain" : "KINSOL " + std::to_string(depth);
}

struct Scene {
  std::string name;
  FluidParameters fluid;
  double density;
  double time_step;
};

/// From a soft fluid whose amplitudes do not follow the energies to those where they do most.
std::vector<Scene> scenes() {
  const FluidParameters soft{.heat_capacity = 60,
                             .repulsion = 25,
                             .friction = 4.5,
                             .friction_closure = FrictionClosure::friction,
                             .conduction = 1,
                             .heat_form = HeatForm::temperature};
  auto constant = soft;
  constant.friction_closure = FrictionClosure::noise;
  constant.heat_form = HeatForm::inverse_temperature;
  const FluidParameters mackie{.boltzmann = 0.5,
                               .temperature = 1.1,
                               .heat_capacity = 50,
                               .friction = 1,
                               .friction_closure = FrictionClosure::friction,
                               .friction_range = 1.24,
                               .conduction = 850,
                               .heat_form = HeatForm::inverse_temperature,
                               .heat_range = 1.24};
  const auto ideal = [&](double heat_capacity, double friction, double conduction) {
    auto f = soft;
    f.repulsion = 0;
    f.heat_capacity = heat_capacity;
    f.friction = friction;
    f.conduction = conduction;
    return f;
  };
  return {{"soft fluid, constant amplitudes", constant, 3, 0.01},
          {"soft fluid", soft, 3, 0.01},
          {"soft fluid", soft, 3, 0.04},
          {"Mackie et al. 1999", mackie, 1, 0.01},
          {"ideal, phi/k 60, friction 45", ideal(60, 45, 1), 3, 0.005},
          {"ideal, phi/k 60, conduction 300", ideal(60, 4.5, 300), 3, 0.005},
          {"ideal, phi/k 20", ideal(20, 4.5, 1), 3, 0.01},
          {"ideal, phi/k 10", ideal(10, 4.5, 1), 3, 0.01},
          {"ideal, phi/k 3", ideal(3, 4.5, 1), 3, 0.001}};
}

System make_system(const Scene& scene, std::size_t particles, std::uint64_t seed) {
  const Fluid fluid(scene.fluid);
  const Noise noise(seed, 0);
  const Box box = make_box(fluid, Layout::fluid, particles, scene.density, 0);
  State state =
      place(box, Layout::fluid, scene.fluid.repulsion > 0 ? Placement::lattice : Placement::random,
            particles, 0, noise);
  const auto law = microcanonical_law(fluid, Layout::fluid, particles);
  draw_microcanonical(fluid, Layout::fluid, law.energy_at(scene.fluid.temperature), noise, state);
  return System(fluid, box, std::move(state), noise);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Takes a step; what kept it from that.
std::optional<FailureCause> attempt(System& system, Integrator& integrator, const State& start,
                                    std::uint64_t step, double dt) {
  system.set_state(start);
  system.set_step(step);
  try {
    integrator.step(system, dt);
  } catch (const StepFailure& failure) {
    return failure.cause();
  }
  return std::nullopt;
}

/// A solver with a system of its own.
struct Runner {
  int depth;
  System system;
  std::unique_ptr<Integrator> integrator;
  std::vector<double> seconds = {};
  std::uint64_t steps = 0;
  double difference = 0;  ///< largest, from the plain solution, as a share of the mean energy

  void advance(const State& start, std::uint64_t step, double dt) {
    const std::clock_t begin = std::clock();
    if (attempt(system, *integrator, start, step, dt)) {
      throw std::runtime_error(solver_name(depth) + " does not solve a step that is timed");
    }
    const auto ticks = static_cast<double>(std::clock() - begin);
    if (++steps > 1) seconds.push_back(ticks / CLOCKS_PER_SEC);  // in the first, memory is new
  }

  double rounds() const {
    return static_cast<double>(system.counters().solver_iterations) / static_cast<double>(steps);
  }

  void compare(const State& with) {
    const auto& u = system.motion().internal_energy;
    const double mean = system.internal_energy() / static_cast<double>(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
      difference = std::max(difference, std::abs(u[i] - with.internal_energy[i]) / mean);
    }
    check(difference < 10 * tolerance, "two solvers do not find the same solution");
  }

  double over(const Runner& other) const {
    std::vector<double> ratios;
    for (std::size_t n = 0; n < seconds.size(); ++n) {
      ratios.push_back(seconds[n] / other.seconds[n]);
    }
    return median(ratios);
  }
};

/// Every solver takes every step from the plain solution of the last one.
void time_scene(const Scene& scene, Scheme scheme, std::size_t particles, std::uint64_t steps) {
  const System start = make_system(scene, particles, 1);
  std::vector<Runner> runners;
  for (const int depth : {plain, registered, 0, 1, 2, 3, 4, 5}) {
    runners.push_back({depth, start, make_solver(scheme, depth)});
  }
  State state = start.state();
  for (std::uint64_t step = 1; step <= steps; ++step) {
    for (std::size_t n = 0; n < runners.size(); ++n) {
      runners[(n + step) % runners.size()].advance(state, step, scene.time_step);
    }
    state = runners[0].system.state();
    for (auto& runner : runners) runner.compare(state);
  }
  for (const auto& runner : runners) {
    if (runner.depth == registered) continue;
    std::printf("%-32s %-23s %6zu %6g  %-9s %6.2f %9.1f %7.3f %11.1e\n", scene.name.c_str(),
                name_of(scheme).c_str(), particles, scene.time_step,
                solver_name(runner.depth).c_str(), runner.rounds(),
                1e9 * median(runner.seconds) / static_cast<double>(particles),
                runner.over(runners[0]), runner.difference);
  }
  std::fflush(stdout);
}

constexpr std::uint64_t noises = 20;

bool solves_all(System& system, Integrator& integrator, const State& start, double dt) {
  for (std::uint64_t step = 1; step <= noises; ++step) {
    if (attempt(system, integrator, start, step, dt)) return false;
  }
  return true;
}

/// The largest step at which all noises are solved, by bisection to 2^{1/16}.
double reach(System& system, Integrator& integrator, const State& start, double small_step) {
  double low = std::log2(small_step), high = low + 16;
  while (high - low > 1.0 / 16) {
    const double middle = 0.5 * (low + high);
    (solves_all(system, integrator, start, std::exp2(middle)) ? low : high) = middle;
  }
  return std::exp2(low);
}

/// How many of the noises are solved, and why the others are not.
void print_solved(System& system, Integrator& integrator, const State& start, double dt) {
  int solved = 0, negative = 0, not_converged = 0;
  for (std::uint64_t step = 1; step <= noises; ++step) {
    const auto cause = attempt(system, integrator, start, step, dt);
    ++(!cause ? solved : *cause == FailureCause::not_converged ? not_converged : negative);
  }
  std::printf("   %3d %3d %3d", solved, negative, not_converged);
}

void reach_of_scene(const Scene& scene, Scheme scheme) {
  System system = make_system(scene, 1000, 1);
  const State start = system.state();
  double of_plain = 0;
  for (const int depth : {plain, 1, 3, 5}) {
    const auto solver = make_solver(scheme, depth);
    const double largest = reach(system, *solver, start, scene.time_step / 8);
    if (depth == plain) of_plain = largest;
    std::printf("%-32s %-23s %-9s %8.4f", scene.name.c_str(), name_of(scheme).c_str(),
                solver_name(depth).c_str(), largest);
    for (const double factor : {1.1, 1.4, 2.0}) {
      print_solved(system, *solver, start, factor * of_plain);
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

void run() {
  std::printf(
      "Fixed-point iteration of the implicit methods, to %g of the mean internal energy; one "
      "thread, %s\n\n",
      tolerance, std::string(instruction_set()).c_str());
  std::printf("%-32s %-23s %6s %6s  %-9s %6s %9s %7s %11s\n", "scene", "method", "N", "step",
              "solver", "rounds", "ns a", "over", "difference");
  std::printf("%-32s %-23s %6s %6s  %-9s %6s %9s %7s %11s\n", "", "", "", "", "", "a step",
              "particle", "plain", "from plain");
  for (const auto& scene : scenes()) {
    for (const auto scheme : {Scheme::implicit, Scheme::midpoint}) {
      time_scene(scene, scheme, 1000, 41);
      time_scene(scene, scheme, 24000, 6);
    }
  }
  std::printf(
      "\nLargest step at which 20 of 20 noises are solved, 1000 particles; of 20 at 1.1, "
      "1.4 and 2 times that of plain:\n"
      "solved, ended in a negative or non-finite energy, not converged in 100 rounds\n\n");
  std::printf("%-32s %-23s %-9s %8s   %11s   %11s   %11s\n", "scene", "method", "solver", "largest",
              "1.1", "1.4", "2");
  for (const auto& scene : scenes()) {
    if (scene.name == "soft fluid" && scene.time_step > 0.01) continue;  // the same fluid
    for (const auto scheme : {Scheme::implicit, Scheme::midpoint}) reach_of_scene(scene, scheme);
  }
}

}  // namespace
}  // namespace driftless

int main() {
  driftless::run();
  return 0;
}
