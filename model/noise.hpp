#pragma once

#include <Random123/philox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "model/stage.hpp"

namespace driftless {

/// What a random number is for; numbers of different purposes are independent.
enum class Purpose : std::uint8_t {
  friction = 0,
  heat = 1,
  initial_velocity = 2,
  initial_energy = 3,
  initial_position = 4,
  monte_carlo = 5,
  pair_uniform = 6,
  slab_energy = 7,
};

/// A uniform random bit generator (64 bits a call) over one key and one counter of Philox4x32-10
/// (Salmon et al., SC11, 2011): any distribution of Boost.Random or <random> accepts it. Copies are
/// independent readers of the same numbers. Good for 500 words; no distribution here draws more
/// than a few.
class NoiseStream {
 public:
  using result_type = std::uint64_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  result_type operator()() {
    if (next_ == 2) refill();
    return words_[next_++];
  }

 private:
  friend class Noise;
  using Philox = r123::Philox4x32;

  /// Starts with `first`, a word that the purpose owns, and goes on with blocks of its own.
  NoiseStream(Philox::key_type key, Philox::ctr_type counter, result_type first)
      : key_(key), counter_(counter), words_{0, first} {}
  void refill();

  Philox::key_type key_;
  Philox::ctr_type counter_;
  std::array<result_type, 2> words_;
  unsigned next_ = 1;
};

/// Counter-based noise: every number is a pure function of (seed, replica, step, stage, ids,
/// purpose), whatever the order of visits, the number of threads, or a restart in between.
class Noise {
 public:
  Noise(std::uint64_t seed, std::uint64_t replica);

  /// Names the present step (below 2^40); numbers of different steps are independent.
  void set_step(std::uint64_t step) { step_ = step; }
  std::uint64_t step() const { return step_; }

  /// Cuts every step, counted from 1, into `cells` cells of one Wiener path: the normals of step n
  /// are the sum of those of steps (n - 1) `cells` + 1 to n `cells`, divided by the root of
  /// `cells`. Runs of the same duration then see the same path, with steps of however many cells,
  /// by whatever method. A stage that is a part of its step (stage.hpp) has the cells of that part
  /// alone, so the parts must divide `cells`, else normals throw std::invalid_argument; stages that
  /// are no parts have paths of their own. Uniform variates stay as they are. 1 is the noise
  /// without refinement, where parts have nothing in common with a path; any other number costs so
  /// many draws. Throws std::invalid_argument at 0.
  void set_refinement(unsigned cells);

  /// Independent standard normal variates of the pairs (id_i[n], id_j[n]), n < `count`, in a stage
  /// of the present step, by the method of Box and Muller (Ann. Math. Stat. 29, 610,
  /// 1958); none is larger than 8.6. A purpose that is a null pointer is not wanted, which changes
  /// nothing for the other one; nor does the place of a pair in the arrays. Lanes know no
  /// remainder: all arrays are read and written up to the next multiple of the library's
  /// (lanes_of_library()). Machines with and without fused multiply-add differ in rounding.
  void pair_normals(std::size_t count, const std::uint32_t* id_i, const std::uint32_t* id_j,
                    Stage stage, double* friction, double* heat) const;

  /// Uniform variates of pairs in (0, 1), independent of each other and of the normals; the
  /// arrays are those of pair_normals().
  void pair_uniforms(std::size_t count, const std::uint32_t* id_i, const std::uint32_t* id_j,
                     Stage stage, double* friction, double* heat) const;

  /// Two standard normal variates of a pair, `friction` and `heat`.
  struct PairNormals {
    double friction, heat;
  };
  /// The normals of one pair; a purpose not wanted reads 0.
  PairNormals pair_normals(std::uint32_t id_i, std::uint32_t id_j, Stage stage, bool want_friction,
                           bool want_heat) const;

  /// The uniform variates of one pair.
  struct PairUniforms {
    double friction, heat;
  };
  PairUniforms pair_uniforms(std::uint32_t id_i, std::uint32_t id_j, Stage stage) const;

  /// The stream of one particle for a purpose (initial states): step 0 is before the first step.
  NoiseStream particle_stream(std::uint32_t id, Purpose purpose) const;

 private:
  using Philox = NoiseStream::Philox;
  Philox::ctr_type counter(std::uint32_t id_i, std::uint32_t id_j, unsigned stage,
                           Purpose purpose) const;

  Philox::key_type key_;
  std::uint64_t step_ = 0;
  unsigned cells_ = 1;  ///< of a step
};

}  // namespace driftless
