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
  void neighbours(const State& state, std::uint32_t i);
  void visit_row(const State& state, std::uint32_t i, int row, int first, int last,
                 const Vector& shifted);
  std::size_t cell_of(const Vector& position) const;

  Box box_;
  double range_;
  Eigen::Vector3i cells_;
  bool use_cells_;
  std::vector<std::uint32_t> cell_begin_;
  struct Entry {
    Vector position;
    std::uint32_t id, place;
  };
  std::vector<Entry> entries_;  ///< particles sorted by cell, x fastest
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
