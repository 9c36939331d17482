#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace driftless {

/// Bytes a second that a[n] = b[n] + s c[n] moves on some threads, the best of a few passes over
/// three arrays of so many bytes each; counted are two numbers read and one written.
double triad_bandwidth(std::size_t bytes, unsigned threads);

/// Bytes for the triad's arrays that no cache of this machine holds.
std::size_t beyond_the_cache();

/// A part of what a step moves between memory and cores, per particle.
struct Traffic {
  const char* part;
  double in_order;  ///< bytes of arrays read or written one after the other
  double per_pair;  ///< bytes for each pair of a particle
};

/// An estimate for a system beyond the cache, from the sizes of what is stored: every array counts
/// once for each loop over it, read or written. Particles lie nearly in the order of cells in which
/// they are worked on (begin_step). Tiles of 2 x 2 x 2 cells see 43 cells, their neighbours', and
/// the eight colours pass one after the other, so that what a tile sees is fetched 43/8 times.
std::vector<Traffic> step_traffic(const std::string& kernel);
/// Sum over the parts.
double bytes_per_step(const std::string& kernel, double pairs_per_particle);

}  // namespace driftless
