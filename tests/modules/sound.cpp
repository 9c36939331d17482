// A module with two methods; the second one is made of a method that it asks the registry for.

#include "integrators/integrator.hpp"

namespace driftless {
namespace {

Method renamed(std::string_view known, std::string_view name) {
  Method method = *find_method(known);
  method.name = name;
  return method;
}

const Registration first(renamed("averaged-drift", "outside-first"));
const Registration second(renamed("shardlow-s1", "outside-second"));

}  // namespace
}  // namespace driftless
