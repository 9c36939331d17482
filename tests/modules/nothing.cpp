// A module with a method that it forgets to register.

#include "integrators/integrator.hpp"

namespace driftless {

extern const Method forgotten;
const Method forgotten = *find_method("averaged-drift");

}  // namespace driftless
