#include "experiments/cell.hpp"

#include <gtest/gtest.h>

namespace driftless {
namespace {

TEST(CellStatus, IsThatOfTheFirstFailure) {
  std::vector<ReplicaResult> replicas(3);
  EXPECT_EQ(cell_status(replicas), "ok");
  replicas[1].failure = Failure{1, FailureCause::not_converged, 5, 0.5};
  replicas[2].failure = Failure{2, FailureCause::non_finite, 7, 0.7};
  EXPECT_EQ(cell_status(replicas), "not_converged");
}

}  // namespace
}  // namespace driftless
