#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "experiments/long_run.hpp"

namespace driftless {

/// Writes frames to an extended XYZ file, which OVITO and ASE read: cell and time in the second
/// line of a frame; for each particle, in the order of storage, species (X where there is one
/// alone; H, He, Li, ... where there are more), position, velocity (`velo`, which OVITO takes),
/// momentum and mass (which ASE takes instead), internal energy and temperature where there are
/// any, and id. Axes with walls are not periodic. Numbers have nine digits.
///
/// The first frame replaces a file that exists. After a restart the file is cut back to what it was
/// at the checkpoint and goes on from there, so that it equals that of an uninterrupted run.
class Trajectory : public Observer {
 public:
  Trajectory(std::filesystem::path path, double time_step);

  /// Throws InputError if the file cannot be written.
  void sample(System& system, std::uint64_t step) override;
  nlohmann::json save() override;
  /// Throws InputError if the file is shorter than it was.
  void load(const nlohmann::json& saved) override;

  std::uint64_t frames() const { return frames_; }

 private:
  void open();
  void write(const std::string& text);

  std::filesystem::path path_;
  double time_step_;
  std::uint64_t frames_ = 0, bytes_ = 0;
  std::ofstream file_;
};

}  // namespace driftless
