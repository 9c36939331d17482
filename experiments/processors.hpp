#pragma once

namespace driftless {

/// How many processors this process may run on (its affinity), at least 1.
unsigned usable_processors();

}  // namespace driftless
