#include "integrators/integrator.hpp"

namespace driftless {
namespace {

// Fewer particles lie in the cache of one core in any order; more are far apart again after a
// hundred steps, and every thread then reads what others have written.
constexpr std::size_t most_in_any_order = 1000;
constexpr std::uint64_t steps_in_order = 25;

}  // namespace

void begin_step(System& system, Integrator& integrator, std::uint64_t step) {
  system.set_step(step);
  const bool is_due = step % steps_in_order == 1 && system.size() > most_in_any_order;
  if (!is_due || system.frozen() || !integrator.may_reorder_storage()) return;
  integrator.follow_storage(system.order_storage());
}

}  // namespace driftless
