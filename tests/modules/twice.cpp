// A module that gives one name to two methods.

#include "integrators/integrator.hpp"

namespace driftless {
namespace {

Method renamed(std::string_view known) {
  Method method = *find_method(known);
  method.name = "outside-twice";
  return method;
}

const Registration first(renamed("averaged-drift"));
const Registration second(renamed("shardlow-s1"));

}  // namespace
}  // namespace driftless
