#pragma once

#include <cstdint>
#include <vector>

#include "model/fluid.hpp"
#include "model/noise.hpp"
#include "model/state.hpp"

namespace driftless {

/// All pairs within a range, in the order of ids (i, then j, id_i < id_j): a linked-cell search,
/// or a plain double loop where the box is shorter than three cells. e points from j to i.
class PairSearch {
 public:
  struct Found {
    std::uint32_t i, j;  ///< places in storage, id[i] < id[j]
    Vector difference;   ///< minimum image of r_i - r_j
    double squared_distance;
  };

  /// `particles` bounds the number of cells. Throws std::invalid_argument if the box is shorter
  /// than twice the range.
  PairSearch(const Box& box, double range, std::size_t particles);

  /// Finds every pair closer than the range; the result is valid until the next call.
  const std::vector<Found>& find(const State& state);

 private:
  void sort_into_cells(const State& state);
  void visit_all(const State& state);
  void visit_cells(const State& state);
  void gather_half_shell(const Eigen::Vector3i& cell);
  void gather(std::size_t begin, std::size_t end, const Vector& shift);
  void visit_candidates(const State& state, std::size_t first);
  void keep(const State& state, std::uint32_t a, std::uint32_t b, const Vector& difference);
  void sort_by_ids(const State& state);
  std::size_t cell_of(const Vector& position) const;
  std::size_t cell_index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * cells_[1] + y) * cells_[0] + x;
  }

  Box box_;
  double range_;
  Eigen::Vector3i cells_;
  bool use_cells_;
  std::vector<std::uint32_t> cell_begin_;
  std::vector<Vector> cell_position_;  ///< particles sorted by cell, x fastest
  std::vector<std::uint32_t> cell_place_;
  /// A cell's particles and then those of half of its neighbours, as seen from the cell.
  struct Candidates {
    std::vector<double> x, y, z;
    std::vector<std::uint32_t> place;
  } candidates_;
  std::vector<double> squared_;        ///< scratch: distances of one particle to the candidates
  std::vector<std::uint32_t> within_;  ///< scratch: candidates within range of one particle
  std::vector<Found> unsorted_;
  std::vector<Found> found_;
};

/// The pairs of a system with what the kernels need of them: geometry and weights, renewed when
/// positions change, and noise, renewed when step or stage change.
class PairList {
 public:
  struct Geometry {
    std::uint32_t i, j;
    Vector e;
    double r, w_friction, w_heat;
  };
  using Normals = Noise::PairNormals;

  PairList(const Box& box, const Fluid& fluid, std::size_t particles);

  /// Brings the geometry up to date with positions of the given version.
  void update(const State& state, const Fluid& fluid, std::uint64_t version);
  /// Brings the noise up to date; returns how many random numbers were drawn.
  std::uint64_t draw(const State& state, const Fluid& fluid, const Noise& noise, unsigned stage);

  std::size_t size() const { return geometry_.size(); }
  const Geometry& geometry(std::size_t pair) const { return geometry_[pair]; }
  const Normals& normals(std::size_t pair) const { return normals_[pair]; }

 private:
  PairSearch search_;
  std::vector<Geometry> geometry_;
  std::vector<Normals> normals_;
  std::uint64_t version_ = 0;  ///< of the positions; 0 is none
  bool drawn_ = false;
  std::uint64_t drawn_step_ = 0;
  unsigned drawn_stage_ = 0;
};

}  // namespace driftless
