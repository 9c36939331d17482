#pragma once

#include <string>
#include <vector>

#include "experiments/long_run.hpp"

namespace driftless {

/// Time series of what a whole system has: energies, temperatures, momentum. Where there are more
/// than `most_rows` of them every second row is dropped, so that rows stay equally far apart.
class Monitor : public Observer {
 public:
  static constexpr std::size_t most_rows = 4096;

  /// `kinetic_degrees`: of the kinetic energy about the centre of mass.
  Monitor(const System& system, double time_step, double kinetic_degrees);

  void sample(System& system, std::uint64_t step) override;
  nlohmann::json save() override;
  void load(const nlohmann::json& saved) override;

  struct Column {
    std::string name;
    std::vector<double> values;
  };
  /// time; kinetic_, internal_, potential_ and total_energy; kinetic_temperature (about the centre
  /// of mass) and internal_temperature, N/sum(1/theta), where they exist; momentum_x, _y and _z;
  /// surroundings_energy, what walls, field and driver have received in all since the start: its
  /// sum with total_energy is conserved; for each wall, as lower_x_wall_, the _energy and the
  /// _momentum along its axis that it has received.
  const std::vector<Column>& columns() const { return columns_; }
  std::size_t rows() const { return columns_.front().values.size(); }

  /// {"columns": {name: [...]}}.
  nlohmann::json to_json() const;

 private:
  std::vector<double> row(System& system, std::uint64_t step) const;

  double time_step_, kinetic_degrees_;
  std::uint64_t seen_ = 0, stride_ = 1;
  std::vector<Column> columns_;
};

}  // namespace driftless
