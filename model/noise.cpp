#include "model/noise.hpp"

#include <stdexcept>

namespace driftless {
namespace {

std::uint64_t word(const r123::Philox4x32::ctr_type& block, unsigned half) {
  return (std::uint64_t{block[2 * half + 1]} << 32) | block[2 * half];
}

// Counter word 3 is | stage: 8 | block: 8 | purpose: 8 | step: 8 (its highest bits) |. Block 0
// gives a stream its first word, the later blocks give two each; of pairs there is no block but 0.
constexpr std::uint32_t block_unit = 1U << 16;

}  // namespace

void NoiseStream::refill() {
  counter_[3] += block_unit;
  const auto block = Philox{}(counter_, key_);
  words_ = {word(block, 0), word(block, 1)};
  next_ = 0;
}

Noise::Noise(std::uint64_t seed, std::uint64_t replica) {
  // Philox itself mixes seed and replica into the key: two share one with a chance of 2^-64.
  const Philox::ctr_type counter = {
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
       static_cast<std::uint32_t>(replica), static_cast<std::uint32_t>(replica >> 32)}};
  const auto mixed = Philox{}(counter, Philox::key_type{{0x64726966U, 0x746c6573U}});
  key_ = {{mixed[0], mixed[1]}};
}

void Noise::set_refinement(unsigned cells) {
  if (cells == 0) throw std::invalid_argument("a step of noise has no cells");
  cells_ = cells;
}

Noise::Philox::ctr_type Noise::counter(std::uint32_t id_i, std::uint32_t id_j, unsigned stage,
                                       Purpose purpose) const {
  return {{id_i, id_j, static_cast<std::uint32_t>(step_),
           (stage << 24) | (static_cast<std::uint32_t>(purpose) << 8) |
               (static_cast<std::uint32_t>(step_ >> 32) & 0xffU)}};
}

NoiseStream Noise::particle_stream(std::uint32_t id, Purpose purpose) const {
  const auto own = counter(id, id, 0, purpose);
  return {key_, own, word(Philox{}(own, key_), static_cast<unsigned>(purpose) % 2)};
}

}  // namespace driftless
