#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "model/fluid.hpp"
#include "model/state.hpp"

namespace driftless {

/// A particle as a record: what it is, and what it receives within a step.
struct NaiveParticle {
  Vector position, velocity;
  double internal_energy = 0;
  Vector force = Vector::Zero(), impulse = Vector::Zero();
  double heat = 0;
};

/// The soft fluid of DPDE as careful code writes it without a thought of speed: records of
/// particles, linked cells and a neighbour list, a virtual call per pair, std::mt19937_64 with
/// std::normal_distribution. The measure of how fast the library is, and an independent check of
/// it: of the model it takes the parameters and the layout of a state alone. All 27 cells around a
/// particle are searched and images are found by rounding, as the formulas are written; whoever
/// thinks of speed searches half of the cells and compares instead, in about half of the time.
class NaiveFluid {
 public:
  /// For the closure `noise`, conduction of the form `inverse_temperature`, weights of any exponent
  /// and one range for all terms; the box must be at least three ranges long. Throws
  /// std::invalid_argument otherwise.
  NaiveFluid(const FluidParameters& fluid, const Box& box, const State& start, std::uint64_t seed);

  /// All exchanges from the state at t, then r' = r + v dt: the scheme of averaged-drift.
  void force_parallel_step(double dt);
  /// Pair after pair, then velocity Verlet with the repulsion: the scheme of shardlow-s1, its pairs
  /// in another order.
  void sequential_step(double dt);

  const std::vector<NaiveParticle>& particles() const { return particles_; }
  /// Pairs within the range, at the present positions.
  std::size_t pairs();
  double potential_energy();

  /// Standard normal variates.
  struct Normals {
    std::mt19937_64 engine;
    std::normal_distribution<double> distribution;
    double operator()() { return distribution(engine); }
  };
  /// What two particles do to each other: e points from j to i, r is the distance.
  class PairInteraction;

 private:
  void renew_pairs();
  void sort_into_cells();
  void add_pairs_of(int i);
  std::array<int, 3> cell_of(const NaiveParticle& particle) const;
  int& first_in(int x, int y, int z);  ///< of a cell, from -1 to the number of cells
  void visit(PairInteraction& interaction);
  void renew_forces();
  Vector shortest(Vector difference) const;
  Vector inside(Vector position) const;

  struct Neighbours {
    int i, j;
  };
  FluidParameters fluid_;
  Box box_;
  Normals normals_;
  std::vector<NaiveParticle> particles_;
  std::array<int, 3> cells_;
  std::vector<int> first_in_cell_, next_in_cell_;  ///< linked lists, -1 at the end
  std::vector<Neighbours> pairs_;
  bool pairs_are_current_ = false, forces_are_current_ = false;
};

}  // namespace driftless
