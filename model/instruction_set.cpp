#include "model/instruction_set.hpp"

#include "model/lanes.hpp"

namespace driftless {

std::string_view instruction_set() { return hwy::TargetName(HWY_TARGET); }

std::size_t lanes_of_library() { return Lanes::count(); }

}  // namespace driftless
