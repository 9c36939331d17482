// A module with the name of a method that exists already.

#include "integrators/integrator.hpp"

namespace driftless {
namespace {

const Registration registered(*find_method("averaged-drift"));

}  // namespace
}  // namespace driftless
