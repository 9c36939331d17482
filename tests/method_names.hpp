#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "integrators/integrator.hpp"

namespace driftless::testing {

/// Names a method's tests after it, as ctest -R finds them: averaged_drift.
inline std::string test_name(const ::testing::TestParamInfo<const Method*>& tested) {
  std::string name(tested.param->name);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

}  // namespace driftless::testing
