#pragma once

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "model/system.hpp"

namespace driftless {

inline constexpr const char* checkpoint_format = "driftless-checkpoint/1";

/// All that a run needs to go on as if it had never stopped.
struct Checkpoint {
  nlohmann::json identity;  ///< what makes it this run: scene, method, time step, seed, observers
  std::uint64_t step = 0;   ///< steps done
  State state;
  std::vector<double> integrator;  ///< what Integrator::save() gave
  Counters counters;               ///< what has been done so far, restarts included
  nlohmann::json observers = nlohmann::json::object();  ///< what each observer saved, by its name
};

/// Writes a checkpoint (CBOR) so that a reader finds the old one or the new one. Throws InputError.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Reads a checkpoint; nothing if there is no such file. Throws InputError in one sentence if the
/// file is none, of another version, or of another run than `identity` says.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& path,
                                          const nlohmann::json& identity);

/// Numbers as the bytes that they are in memory: the same bits when they come back. T holds numbers
/// alone.
template <class T>
nlohmann::json to_bytes(const std::vector<T>& values) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
  return nlohmann::json::binary(
      std::vector<std::uint8_t>(first, first + values.size() * sizeof(T)));
}

/// The numbers again; throws std::invalid_argument if the bytes are no whole number of them.
template <class T>
std::vector<T> from_bytes(const nlohmann::json& bytes) {
  const auto& binary = bytes.get_binary();
  if (binary.size() % sizeof(T) != 0) throw std::invalid_argument("bytes are missing");
  std::vector<T> values(binary.size() / sizeof(T));
  if (!values.empty()) {
    std::memcpy(static_cast<void*>(values.data()), binary.data(), binary.size());
  }
  return values;
}

}  // namespace driftless
