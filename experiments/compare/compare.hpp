#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "experiments/study.hpp"

namespace driftless {

struct CompareOptions {
  double family_level = 1e-5;     ///< chance of one false "better" or "worse" among all tests
  double minimum_effect = 0.001;  ///< smaller differences are "same", however sure
  double wanted_effect = 0.02;    ///< what a test must be able to see, or it has too little data
  double failure_level = 1e-3;    ///< more failures as unlikely as this, alone, leave a doubt
  bool all_cells = false;         ///< all that BASE measured must stand in NEW, as a gate demands
  std::string method = {};        ///< this method alone; all if empty
};

/// Two results that have nothing to be compared; one sentence, exit code 2.
class NotComparable : public InputError {
 public:
  using InputError::InputError;
};

/// Compares two results (driftless-result/1), NEW against BASE, into a record
/// "driftless-comparison/1" (see experiments/schema/comparison.schema.json). A pure function.
///
/// What is compared: every observable of every cell that stands in both results, that is of the
/// same scene, method, options and time step. The durations of the studies and the parameters of
/// scenes of one name must be equal; parameters that BASE does not have are new to the program and
/// are passed over. Seeds and replicas may differ. Equal seeds make the results dependent, which
/// makes a difference smaller than its error says: then fewer differences are found, never more.
/// An observable need not be resolved, or right: with one protocol for both runs, equal methods
/// have one law, in equilibrium or not.
///
/// The tests: each difference over its own standard error (difference.hpp), all of them with
/// Holm's step-down at the family level. The errors are the cells' own: those pooled over cells
/// (pooled_errors.hpp) are made for 95 % intervals. In the tail that m tests at a family level of
/// 1e-5 need, a cell whose variance is twice the others' would be found 5000 times as often as
/// promised. Replicas that fail are compared by Fisher's exact test in the same family.
///
/// A scene with repulsion whose total energy differs between the results (it comes from a Monte
/// Carlo run, which rounding leads elsewhere on another processor) is compared by deviations from
/// its own reference values, whose errors are counted; observables without one are left out.
///
/// Effects are shares of the exact value, or of BASE's where there is none. Skewnesses are numbers
/// of their own. A distance is taken as a distance (the root of its square). Energy drift and walk
/// count with what they change over the measured time, in kT per particle.
///
/// Verdicts, of a test:
/// - "worse": the difference is significant and at least the minimum effect, and the deviation from
///   the exact value is no smaller than before: it grew, or lies as far off on the other side. For
///   drift, walk and distances: the size grew. An observable with nothing exact beside it is worse
///   if it changed at all: what nobody can call right should not have moved.
/// - "better": the same, where the deviation shrank.
/// - "too_little_data": neither, and a difference of the wanted effect would have been missed with
///   more than 5 %; of what is no share of a value (drift, walk, distances, skewness) one of its
///   own size if that is larger. `detectable` is the effect that would not have been missed.
/// - "same": neither, and there was enough data.
/// Total energy and momentum that BASE keeps to rounding (1e-9) and NEW does not (1e-7) are worse
/// without a test, and the other way round better.
/// A cell has the worst verdict of its tests; in the order worse, better, too_little_data, same.
/// The whole is "worse" if a test is; else "too_little_data" if more than half of the tests have
/// too little data, or if in a cell more replicas fail than chance alone would let at the failure
/// level, which is no certainty among many cells but no equality either; else "better" if a test
/// is; else "same".
///
/// Cost is compared between runs on one processor with the same instructions, outside the tests and
/// the verdict: machines are busy at times.
///
/// Throws NotComparable if the durations or the scenes' parameters differ, no cell is common, or
/// with `all_cells` if NEW lacks a cell that BASE has, or an observable of a cell in which not all
/// replicas fail: what vanished is neither better nor worse, and a gate that passed it would guard
/// nothing.
nlohmann::json compare(const nlohmann::json& base, const nlohmann::json& changed,
                       const CompareOptions& options = {});

/// A result without curves, traces, orders and answers: what `compare` needs, small enough to be
/// kept as a reference. It is a result still.
nlohmann::json without_curves(nlohmann::json result);

}  // namespace driftless
