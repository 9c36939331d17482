#include "model/instruction_set.hpp"

#include <hwy/targets.h>

namespace driftless {

std::string_view instruction_set() { return hwy::TargetName(HWY_TARGET); }

}  // namespace driftless
