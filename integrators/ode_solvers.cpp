#include "integrators/ode_solvers.hpp"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <sundials/sundials_context.hpp>
#include <type_traits>

namespace driftless {
namespace {

constexpr long most_steps = 10'000'000;

/// The equations as the solvers, which are written in C, call them.
struct Problem {
  const OdeRates& rates;
  Eigen::Index size;
  std::exception_ptr failure = nullptr;  ///< of the rates, carried past the solver
  std::string message = {};              ///< the solver's last complaint

  void require(int flag, const char* call) const {
    if (failure) std::rethrow_exception(failure);
    if (flag >= 0) return;
    throw std::runtime_error("the reference solver stopped in " + std::string(call) + ": " +
                             message);
  }
};

int right_hand_side(sunrealtype, N_Vector y, N_Vector dy, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  try {
    Eigen::Map<Eigen::VectorXd> to(N_VGetArrayPointer(dy), problem.size);
    problem.rates(Eigen::Map<const Eigen::VectorXd>(N_VGetArrayPointer(y), problem.size), to);
    return 0;
  } catch (...) {
    problem.failure = std::current_exception();
    return -1;
  }
}

/// Keeps what the solver would print otherwise.
void keep_message(int, const char*, const char*, char* message, void* kept) {
  *static_cast<std::string*>(kept) = message;
}

template <class T>
T* made_by(T* made, const char* call) {
  if (made == nullptr) throw std::runtime_error(std::string(call) + " has failed");
  return made;
}

struct Free {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};
struct FreeAdams {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
struct FreeRungeKutta {
  void operator()(void* memory) const { ERKStepFree(&memory); }
};

/// Adams methods of CVODE, their implicit equations solved by fixed-point iteration.
void advance_by_adams(Problem& problem, N_Vector y, SUNContext context, double duration,
                      const ReferenceTolerance& tolerance) {
  constexpr int acceleration = 3;  // vectors of Anderson's acceleration
  const std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, Free> nonlinear(
      made_by(SUNNonlinSol_FixedPoint(y, acceleration, context), "SUNNonlinSol_FixedPoint"));
  const std::unique_ptr<void, FreeAdams> owner(
      made_by(CVodeCreate(CV_ADAMS, context), "CVodeCreate"));
  void* memory = owner.get();
  const auto require = [&](int flag, const char* call) { problem.require(flag, call); };
  require(CVodeSetErrHandlerFn(memory, keep_message, &problem.message), "CVodeSetErrHandlerFn");
  require(CVodeInit(memory, right_hand_side, 0, y), "CVodeInit");
  require(CVodeSStolerances(memory, tolerance.relative, tolerance.absolute), "CVodeSStolerances");
  require(CVodeSetUserData(memory, &problem), "CVodeSetUserData");
  require(CVodeSetNonlinearSolver(memory, nonlinear.get()), "CVodeSetNonlinearSolver");
  require(CVodeSetMaxNumSteps(memory, most_steps), "CVodeSetMaxNumSteps");
  require(CVodeSetMaxStep(memory, tolerance.longest_step * duration), "CVodeSetMaxStep");
  // The solver must not look beyond the end: nothing says that the state exists there.
  require(CVodeSetStopTime(memory, duration), "CVodeSetStopTime");
  sunrealtype reached = 0;
  require(CVode(memory, duration, y, &reached, CV_NORMAL), "CVode");
}

/// The explicit Runge-Kutta pair 5(4) of Dormand and Prince, of ARKODE: its pair 7(8) takes longer
/// steps, but then cannot see the kinks.
void advance_by_runge_kutta(Problem& problem, N_Vector y, SUNContext context, double duration,
                            const ReferenceTolerance& tolerance) {
  const std::unique_ptr<void, FreeRungeKutta> owner(
      made_by(ERKStepCreate(right_hand_side, 0, y, context), "ERKStepCreate"));
  void* memory = owner.get();
  const auto require = [&](int flag, const char* call) { problem.require(flag, call); };
  require(ERKStepSetErrHandlerFn(memory, keep_message, &problem.message), "ERKStepSetErrHandlerFn");
  require(ERKStepSetTableNum(memory, ARKODE_DORMAND_PRINCE_7_4_5), "ERKStepSetTableNum");
  require(ERKStepSStolerances(memory, tolerance.relative, tolerance.absolute),
          "ERKStepSStolerances");
  require(ERKStepSetUserData(memory, &problem), "ERKStepSetUserData");
  require(ERKStepSetMaxNumSteps(memory, most_steps), "ERKStepSetMaxNumSteps");
  // At a kink of the equations the step has to shrink by orders of magnitude.
  require(ERKStepSetMaxErrTestFails(memory, 100), "ERKStepSetMaxErrTestFails");
  require(ERKStepSetMaxStep(memory, tolerance.longest_step * duration), "ERKStepSetMaxStep");
  require(ERKStepSetStopTime(memory, duration), "ERKStepSetStopTime");
  sunrealtype reached = 0;
  require(ERKStepEvolve(memory, duration, y, &reached, ARK_NORMAL), "ERKStepEvolve");
}

}  // namespace

Eigen::VectorXd solve_ode(const OdeRates& rates, const Eigen::VectorXd& start, double duration,
                          ReferenceSolver solver, const ReferenceTolerance& tolerance) {
  sundials::Context context;
  Problem problem{rates, start.size()};
  const std::unique_ptr<std::remove_pointer_t<N_Vector>, Free> y(
      made_by(N_VNew_Serial(start.size(), context), "N_VNew_Serial"));
  Eigen::Map<Eigen::VectorXd> values(N_VGetArrayPointer(y.get()), start.size());
  values = start;
  if (solver == ReferenceSolver::adams) {
    advance_by_adams(problem, y.get(), context, duration, tolerance);
  } else {
    advance_by_runge_kutta(problem, y.get(), context, duration, tolerance);
  }
  return values;
}

}  // namespace driftless
