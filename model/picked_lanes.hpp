#pragma once

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstdint>

namespace driftless {
// For the instructions that a file is compiled for, as in lanes.hpp.
namespace HWY_NAMESPACE {

/// Numbers of 32 bits, as many as one instruction handles.
using Indices = hwy::HWY_NAMESPACE::ScalableTag<std::uint32_t>;

/// 0, 1, 2, ...: loaded, as Highway's Iota is put together number by number at every use.
inline constexpr auto counting = [] {
  std::array<std::uint32_t, hwy::HWY_NAMESPACE::MaxLanes(Indices())> numbers{};
  for (std::uint32_t n = 0; n < numbers.size(); ++n) numbers[n] = n;
  return numbers;
}();

/// first, first + 1, first + 2, ...
HWY_INLINE hwy::HWY_NAMESPACE::Vec<Indices> counting_from(std::uint32_t first) {
  namespace hn = hwy::HWY_NAMESPACE;
  return hn::Add(hn::LoadU(Indices(), counting.data()), hn::Set(Indices(), first));
}

/// The numbers of the bits that are set, for every eight bits: what Compress takes from a table
/// where processors have no instruction for it. Some compilers copy Highway's own at every use.
inline constexpr auto bits_set = [] {
  std::array<std::array<std::uint8_t, 8>, 256> numbers{};
  for (std::size_t bits = 0; bits < 256; ++bits) {
    std::size_t count = 0;
    for (std::uint8_t n = 0; n < 8; ++n) {
      if (bits >> n & 1) numbers[bits][count++] = n;
    }
  }
  return numbers;
}();

/// Stores those of the numbers that are picked, and a rest up to a whole vector. Returns how many.
HWY_INLINE std::size_t store_picked(hwy::HWY_NAMESPACE::Vec<Indices> numbers,
                                    hwy::HWY_NAMESPACE::Mask<Indices> picked, std::uint32_t* to) {
  namespace hn = hwy::HWY_NAMESPACE;
  const Indices indices;
  // Compressed in the register: storing a part of a vector takes longer than all of it.
  if constexpr (hn::MaxLanes(Indices()) <= 8) {
    std::uint8_t bits[8];
    hn::StoreMaskBits(indices, picked, bits);
    const hn::Rebind<std::uint8_t, Indices> bytes;
    const auto lanes = hn::PromoteTo(indices, hn::LoadU(bytes, bits_set[bits[0]].data()));
    hn::StoreU(hn::TableLookupLanes(numbers, hn::IndicesFromVec(indices, lanes)), indices, to);
    return static_cast<std::size_t>(std::popcount(bits[0]));
  } else {
    hn::StoreU(hn::Compress(numbers, picked), indices, to);
    return hn::CountTrue(indices, picked);
  }
}

}  // namespace HWY_NAMESPACE

using HWY_NAMESPACE::counting_from;
using HWY_NAMESPACE::Indices;
using HWY_NAMESPACE::store_picked;

}  // namespace driftless
