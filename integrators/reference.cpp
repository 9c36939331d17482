#include "integrators/reference.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cmath>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <sundials/sundials_context.hpp>
#include <type_traits>

namespace driftless {
namespace {

using Unknowns = Eigen::Map<Eigen::VectorXd>;

/// The right-hand side over the unknowns (r, v, u): 3N positions, 3N velocities, N energies.
struct Equations {
  const Fluid& fluid;
  const Box& box;
  bool frozen;
  Eigen::Index particles;
  std::exception_ptr failure = nullptr;  ///< carried past the solver, which is written in C

  void rates(const Unknowns& y, Unknowns& dy) const {
    const Eigen::Index n = particles;
    dy.setZero();
    if (!frozen) dy.head(3 * n) = y.segment(3 * n, 3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = i + 1; j < n; ++j) add_pair(y, i, j, dy);
    }
  }

  void add_pair(const Unknowns& y, Eigen::Index i, Eigen::Index j, Unknowns& dy) const {
    const Vector r_i = y.segment<3>(3 * i), r_j = y.segment<3>(3 * j);
    const Vector difference = box.minimum_image(r_i - r_j);
    const double r = difference.norm();
    if (r >= fluid.range() || r == 0) return;
    const Vector e = difference / r;
    auto v_dot = dy.segment(3 * particles, 3 * particles);
    auto u_dot = dy.tail(particles);
    const auto velocity = y.segment(3 * particles, 3 * particles);
    const double v = (velocity.segment<3>(3 * i) - velocity.segment<3>(3 * j)).dot(e);
    const double u_i = y[6 * particles + i], u_j = y[6 * particles + j];
    const Pair<double> pair{r, fluid.friction_weight(r), fluid.heat_weight(r), v, u_i, u_j, 0, 0};
    double force = fluid.has_repulsion() ? fluid.repulsive_force(r) : 0;
    if (fluid.has_friction()) {
      const double drag = fluid.friction(pair).friction * v;
      force -= drag;
      u_dot[i] += 0.5 * drag * v;
      u_dot[j] += 0.5 * drag * v;
    }
    if (fluid.has_conduction()) {
      const double rate = fluid.conduction(pair).rate;
      u_dot[i] += rate;
      u_dot[j] -= rate;
    }
    v_dot.segment<3>(3 * i) += force / fluid.mass() * e;
    v_dot.segment<3>(3 * j) -= force / fluid.mass() * e;
  }
};

int right_hand_side(sunrealtype, N_Vector y, N_Vector dy, void* data) {
  auto& equations = *static_cast<Equations*>(data);
  try {
    const Eigen::Index size = 7 * equations.particles;
    Unknowns to(N_VGetArrayPointer(dy), size);
    equations.rates(Unknowns(N_VGetArrayPointer(y), size), to);
    return 0;
  } catch (...) {
    equations.failure = std::current_exception();
    return -1;
  }
}

/// Keeps the solver's last complaint, which it would print otherwise.
void keep_message(int, const char*, const char*, char* message, void* kept) {
  *static_cast<std::string*>(kept) = message;
}

template <class T>
T* made_by(T* made, const char* call) {
  if (made == nullptr) throw std::runtime_error(std::string(call) + " has failed");
  return made;
}

struct FreeVector {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
struct FreeNonlinearSolver {
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};
struct FreeMemory {
  void operator()(void* memory) const { CVodeFree(&memory); }
};

/// CVODE with everything that it needs, each freed in reverse order.
class Solver {
 public:
  Solver(Equations& equations, const ReferenceTolerance& tolerance)
      : size_(7 * equations.particles),
        y_(made_by(N_VNew_Serial(size_, context_), "N_VNew_Serial")),
        nonlinear_(made_by(SUNNonlinSol_FixedPoint(y_.get(), acceleration, context_),
                           "SUNNonlinSol_FixedPoint")),
        memory_(made_by(CVodeCreate(CV_ADAMS, context_), "CVodeCreate")),
        equations_(equations),
        tolerance_(tolerance) {}

  Unknowns unknowns() { return {N_VGetArrayPointer(y_.get()), size_}; }

  void advance(double duration) {
    void* memory = memory_.get();
    require(CVodeSetErrHandlerFn(memory, keep_message, &message_), "CVodeSetErrHandlerFn");
    require(CVodeInit(memory, right_hand_side, 0, y_.get()), "CVodeInit");
    require(CVodeSStolerances(memory, tolerance_.relative, tolerance_.absolute),
            "CVodeSStolerances");
    require(CVodeSetUserData(memory, &equations_), "CVodeSetUserData");
    require(CVodeSetNonlinearSolver(memory, nonlinear_.get()), "CVodeSetNonlinearSolver");
    require(CVodeSetMaxNumSteps(memory, most_steps), "CVodeSetMaxNumSteps");
    // The solver must not look beyond the end: nothing says that the state exists there.
    require(CVodeSetStopTime(memory, duration), "CVodeSetStopTime");
    sunrealtype reached = 0;
    const int flag = CVode(memory, duration, y_.get(), &reached, CV_NORMAL);
    if (equations_.failure) std::rethrow_exception(equations_.failure);
    require(flag, "CVode");
  }

 private:
  void require(int flag, const char* call) const {
    if (flag >= 0) return;
    throw std::runtime_error("the reference solver stopped in " + std::string(call) + ": " +
                             message_);
  }

  static constexpr int acceleration = 3;  ///< vectors of Anderson's acceleration
  static constexpr long most_steps = 10'000'000;

  std::string message_;
  sundials::Context context_;
  Eigen::Index size_;
  std::unique_ptr<std::remove_pointer_t<N_Vector>, FreeVector> y_;
  std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, FreeNonlinearSolver> nonlinear_;
  std::unique_ptr<void, FreeMemory> memory_;
  Equations& equations_;
  ReferenceTolerance tolerance_;
};

void require_solvable(const Fluid& fluid, const Box& box, double duration) {
  if (fluid.fluctuates()) {
    throw std::invalid_argument("the reference solution is of a fluid with boltzmann = 0");
  }
  if (!(duration >= 0) || !std::isfinite(duration)) {
    throw std::invalid_argument("the duration of a reference solution is at least 0");
  }
  if (box.lengths.minCoeff() < 2 * fluid.range()) {
    throw std::invalid_argument("the box is shorter than twice the range of the interaction");
  }
}

}  // namespace

State reference_solution(const Fluid& fluid, const Box& box, const State& start, bool frozen,
                         double duration, const ReferenceTolerance& tolerance) {
  require_solvable(fluid, box, duration);
  if (duration == 0 || start.size() == 0) return start;
  const auto n = static_cast<Eigen::Index>(start.size());
  Equations equations{fluid, box, frozen, n};
  Solver solver(equations, tolerance);
  Unknowns y = solver.unknowns();
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto place = static_cast<std::size_t>(i);
    y.segment<3>(3 * i) = start.position[place];
    y.segment<3>(3 * (n + i)) = start.velocity[place];
    y[6 * n + i] = start.internal_energy[place];
  }
  solver.advance(duration);
  State end = start;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto place = static_cast<std::size_t>(i);
    end.position[place] = box.wrap(y.segment<3>(3 * i));
    end.velocity[place] = y.segment<3>(3 * (n + i));
    end.internal_energy[place] = y[6 * n + i];
  }
  return end;
}

}  // namespace driftless
