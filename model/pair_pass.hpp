#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "model/cell_grid.hpp"
#include "model/fluid.hpp"
#include "model/kernel.hpp"
#include "model/noise.hpp"
#include "model/pairs.hpp"

namespace driftless {

/// How many pairs a pass takes at most: what it reads and writes then stays in the cache.
inline constexpr std::size_t pairs_a_chunk = 512;

/// What a pass over pairs reads and writes, in the order of cells.
struct PassParticles {
  const Quadruple* motion = nullptr;  ///< velocities and energies that the pairs see
  const Quadruple* trial = nullptr;   ///< at the trial end of the step
  const Quadruple* energy = nullptr;  ///< whose energies the pairs see, if others than those
  Quadruple* result = nullptr;        ///< sums of what is exchanged, or the motion itself
  Quadruple* received = nullptr;      ///< what walls receive, by their numbers
};

/// Seconds that went into each part of the passes over pairs, where they are measured.
struct PassSeconds {
  double search = 0;      ///< sorting particles into cells, finding pairs and putting them in order
  double noise = 0;       ///< random numbers
  double arithmetic = 0;  ///< geometry, weights, what kernels see and what they answer
  double scatter = 0;     ///< from pairs to particles

  PassSeconds& operator+=(const PassSeconds& other);
};

/// Adds the time until its end to a part; does nothing without one.
class PassClock {
 public:
  explicit PassClock(double* part) : part_(part) {
    if (part_) start_ = std::chrono::steady_clock::now();
  }
  ~PassClock() {
    if (!part_) return;
    *part_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  PassClock(const PassClock&) = delete;
  PassClock& operator=(const PassClock&) = delete;

 private:
  double* part_;
  std::chrono::steady_clock::time_point start_;
};

/// One thread's way over pairs, a short pass for each thing to be done: geometry and weights from
/// positions, noise from ids, motion of the particles, the kernel, and back to the particles.
class PairPass {
 public:
  PairPass() = default;
  /// A copy has memory of its own, with nothing in it yet.
  PairPass(const PairPass& other) : measured_(other.measured_) {}
  PairPass& operator=(const PairPass& other) { return *this = PairPass(other); }
  PairPass(PairPass&&) = default;
  PairPass& operator=(PairPass&&) = default;

  /// What the passes below speak of: these pairs of this fluid from `first` on.
  void take(const Fluid& fluid, const CellGrid& cells, const PairIndices& pairs, std::size_t first,
            std::size_t count);
  /// The same in the order of groups.
  void take(const Fluid& fluid, const CellGrid& cells, const GroupedPairs& grouped,
            std::size_t first, std::size_t count);
  /// The laws of those that the next passes treat.
  void set_law(const PairLaw& law) { arrays_.law = &law; }

  /// Has the normals, and the geometry where it is kept too, written to and read from memory that
  /// stays, instead of the pass's own, until pairs are taken anew: `columns` arrays that begin
  /// `apart` from each other and have room for lanes beyond the last pair.
  void work_in(double* kept, std::size_t apart, bool with_geometry);
  static std::size_t columns(const Fluid& fluid, bool with_geometry);

  void geometry(std::size_t from, std::size_t to);
  /// The geometry of contacts with a boundary, all that have been taken.
  void contact_geometry(std::size_t boundary);
  void draw_normals(const Noise& noise, Stage stage);
  void draw_uniforms(const Noise& noise, Stage stage);
  void draw_no_uniforms();
  /// The noise of contacts with a boundary.
  void draw_contact_normals(const Noise& noise, Stage stage, std::uint32_t boundary_id);
  void draw_contact_uniforms(const Noise& noise, Stage stage, std::uint32_t boundary_id);
  void motion(const PassParticles& particles, std::size_t from, std::size_t to);
  void trial(const PassParticles& particles);
  void run(const PairKernel& kernel, std::size_t from, std::size_t to) {
    const PassClock clock(part(&PassSeconds::arithmetic));
    arrays_.common_laws = arrays_.law->is_common() && fluid_->law(0, 0).is_common();
    kernel.run(arrays_, from, to);
  }
  /// Adds what the pairs exchange to the particles' sums, one pair after the other.
  void add(Quadruple* sums);
  /// Changes velocities and energies by what pairs exchange, no particle twice among them; false if
  /// an energy is then not above zero. In an isothermal fluid energies stay as they are.
  bool apply(const PassParticles& particles, std::size_t from, std::size_t to);
  /// The same of contacts with a boundary.
  bool apply_contacts(const PassParticles& particles, std::size_t from, std::size_t to);

  const PairArrays& arrays() const { return arrays_; }
  /// The particles of the n-th pair, in the order of cells.
  std::uint32_t i(std::size_t n) const { return i_[n]; }
  std::uint32_t j(std::size_t n) const { return j_[n]; }

  void measure(bool on) { measured_ = on; }
  const PassSeconds& seconds() const { return seconds_; }
  /// Where the time of a part is kept; null if it is not measured.
  double* part(double PassSeconds::*which) { return measured_ ? &(seconds_.*which) : nullptr; }

 private:
  void reserve(std::size_t pairs);
  void look_up_ids();
  void look_up_contact_ids(std::uint32_t boundary_id);
  void draw_normals_of_ids(const Noise& noise, Stage stage);
  void draw_uniforms_of_ids(const Noise& noise, Stage stage);

  const Fluid* fluid_ = nullptr;
  const CellGrid* cells_ = nullptr;
  const std::uint32_t *i_ = nullptr, *j_ = nullptr;
  std::size_t count_ = 0;
  std::size_t capacity_ = 0;
  bool has_uniforms_ = false;
  bool measured_ = false;
  PassSeconds seconds_;
  std::vector<double> memory_;
  PairArrays own_{};     ///< in that memory
  PairArrays arrays_{};  ///< in use
  std::vector<std::uint32_t> id_i_, id_j_;
  std::vector<std::uint32_t> ordered_i_, ordered_j_;
};

}  // namespace driftless
