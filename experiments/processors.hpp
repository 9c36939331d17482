#pragma once

#include <cstddef>

namespace driftless {

/// How many processors this process may run on (its affinity), at least 1.
unsigned usable_processors();

/// As many threads for one system as may run and have something to do: with fewer than some hundred
/// particles each they would wait for each other longer than they work.
unsigned useful_threads(std::size_t particles);

}  // namespace driftless
