#include <Random123/philox.h>

#include <cmath>
#include <stdexcept>

#include "model/lanes.hpp"
#include "model/noise.hpp"

namespace driftless {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Philox = r123::Philox4x32;
using WordTag = hn::RebindToUnsigned<Lanes::Tag>;
using Words = hn::Vec<WordTag>;  ///< 64 bits for each of the lanes
constexpr Lanes::Tag number_tag;
constexpr WordTag word_tag;

/// Products of the low halves of words, whatever stands in their high halves.
inline Words product(Words a, std::uint32_t factor) {
#if HWY_TARGET == HWY_SCALAR  // has no vectors of halves
  return hn::Set(word_tag, (hn::GetLane(a) & 0xffffffffU) * factor);
#else
  const hn::Repartition<std::uint32_t, WordTag> half_tag;
  return hn::MulEven(hn::BitCast(half_tag, a), hn::Set(half_tag, factor));
#endif
}

/// The 128 random bits of each pair.
struct PairWords {
  Words first, second;
};

/// Philox4x32-10 as in Random123, on counters whose words stand in the low halves of c0 to c3.
inline PairWords philox(Words c0, Words c1, Words c2, Words c3, Philox::key_type key) {
  for (int round = 0; round < 10; ++round) {
    const Words p0 = product(c0, PHILOX_M4x32_0);
    const Words p1 = product(c2, PHILOX_M4x32_1);
    c0 = hn::Xor3(hn::ShiftRight<32>(p1), c1, hn::Set(word_tag, key[0]));
    c1 = p1;
    c2 = hn::Xor3(hn::ShiftRight<32>(p0), c3, hn::Set(word_tag, key[1]));
    c3 = p0;
    key[0] += PHILOX_W32_0;
    key[1] += PHILOX_W32_1;
  }
  const Words low = hn::Set(word_tag, 0xffffffffU);
  return {hn::OrAnd(hn::ShiftLeft<32>(c1), c0, low), hn::OrAnd(hn::ShiftLeft<32>(c3), c2, low)};
}

/// Calls use(place of the first, their words) for as many pairs at a time as there are lanes; of
/// `counter` only what all pairs have in common is read.
template <class Use>
void for_lanes(std::size_t count, const std::uint32_t* id_i, const std::uint32_t* id_j,
               const Philox::ctr_type& counter, const Philox::key_type& key, Use&& use) {
  const hn::Rebind<std::uint32_t, WordTag> id_tag;
  const Words c2 = hn::Set(word_tag, counter[2]), c3 = hn::Set(word_tag, counter[3]);
  for (std::size_t n = 0; n < count; n += Lanes::count()) {
    const Words c0 = hn::PromoteTo(word_tag, hn::LoadU(id_tag, id_i + n));
    const Words c1 = hn::PromoteTo(word_tag, hn::LoadU(id_tag, id_j + n));
    use(n, philox(c0, c1, c2, c3, key));
  }
}

/// Uniform variates of the open interval (0, 1): the middles of 2^52 equal parts.
inline Lanes uniform(Words words) {
  // The upper 52 bits are put behind the point of a number between 1 and 2.
  const Words one = hn::Set(word_tag, 0x3ff0000000000000U);
  return Lanes(hn::BitCast(number_tag, hn::Or(hn::ShiftRight<12>(words), one))) - (1 - 0x1p-53);
}

/// By Horner's rule; the coefficient of the highest power comes first.
template <std::size_t size>
inline Lanes polynomial(const double (&coefficients)[size], Lanes t) {
  Lanes::Raw sum = hn::Set(number_tag, coefficients[0]);
  for (std::size_t n = 1; n < size; ++n) {
    sum = hn::MulAdd(sum, t.raw(), hn::Set(number_tag, coefficients[n]));
  }
  return sum;
}

// sin(pi x) / x and cos(pi x), interpolated in x^2 at Chebyshev's nodes of [0, 1/4]. Apart from
// rounding the sine is right to 2e-16, the cosine to 4e-18.
constexpr double sine_coefficients[] = {
    -2.113362735205297e-05, 0.0004659870158043378, -0.0073703643265304155, 0.08214587881631043,
    -0.599264528825224,     2.5501640398618677,    -5.1677127800497855,    3.1415926535897927};
constexpr double cosine_coefficients[] = {
    4.149564353942586e-06, -0.00010456655338748738, 0.0019295562724817132,
    -0.025806888737002202, 0.23533063012953284,     -1.335262768843447,
    4.058712126416497,     -4.934802200544676,      1.0};

/// What becomes of the numbers that stand in an array.
enum class Before { forgotten, added };

template <Before before>
inline void put(const Lanes& numbers, double* place) {
  if constexpr (before == Before::forgotten) {
    numbers.store(place);
  } else {
    (Lanes::load(place) + numbers).store(place);
  }
}

/// Normals by the method of Box and Muller.
template <Before before>
void draw_normals(std::size_t count, const std::uint32_t* id_i, const std::uint32_t* id_j,
                  const Philox::ctr_type& counter, const Philox::key_type& key, double* friction,
                  double* heat) {
  const auto box_muller = [=](std::size_t n, const PairWords& words) {
    // A direction in the half plane on the right; the last bit, which it does not use, decides
    // whether it is reversed.
    const Lanes half_turns = uniform(words.second) - 0.5;
    const Lanes square = half_turns * half_turns;
    const Lanes sign = hn::BitCast(number_tag, hn::ShiftLeft<63>(words.second));
    const Lanes radius = hn::Xor(sqrt(-2.0 * log(uniform(words.first))).raw(), sign.raw());
    if (friction) put<before>(radius * polynomial(cosine_coefficients, square), friction + n);
    if (heat) put<before>(radius * (half_turns * polynomial(sine_coefficients, square)), heat + n);
  };
  for_lanes(count, id_i, id_j, counter, key, box_muller);
}

void scale(std::size_t count, double factor, double* numbers) {
  for (std::size_t n = 0; numbers && n < count; n += Lanes::count()) {
    (Lanes::load(numbers + n) * factor).store(numbers + n);
  }
}

}  // namespace

void Noise::pair_normals(std::size_t count, const std::uint32_t* id_i, const std::uint32_t* id_j,
                         Stage stage, double* friction, double* heat) const {
  constexpr auto purpose = Purpose::friction;
  if (cells_ == 1) {
    const auto own = counter(0, 0, stage.number, purpose);
    return draw_normals<Before::forgotten>(count, id_i, id_j, own, key_, friction, heat);
  }
  if (cells_ % stage.parts != 0) {
    throw std::invalid_argument("the parts of a step do not divide the cells of its noise");
  }
  const unsigned cells = cells_ / stage.parts, path = stage.number / stage.parts;
  Noise cell = *this;
  cell.step_ = (step_ - 1) * cells_ + stage.number % stage.parts * cells;
  for (unsigned n = 0; n < cells; ++n) {
    ++cell.step_;
    const auto own = cell.counter(0, 0, path, purpose);
    const auto draw = n == 0 ? draw_normals<Before::forgotten> : draw_normals<Before::added>;
    draw(count, id_i, id_j, own, key_, friction, heat);
  }
  scale(count, 1 / std::sqrt(cells), friction);
  scale(count, 1 / std::sqrt(cells), heat);
}

void Noise::pair_uniforms(std::size_t count, const std::uint32_t* id_i, const std::uint32_t* id_j,
                          Stage stage, double* friction, double* heat) const {
  const auto uniforms = [=](std::size_t n, const PairWords& words) {
    if (friction) uniform(words.first).store(friction + n);
    if (heat) uniform(words.second).store(heat + n);
  };
  for_lanes(count, id_i, id_j, counter(0, 0, stage.number, Purpose::pair_uniform), key_, uniforms);
}

// One pair: the first lane.

Noise::PairNormals Noise::pair_normals(std::uint32_t id_i, std::uint32_t id_j, Stage stage,
                                       bool want_friction, bool want_heat) const {
  const std::uint32_t i[Lanes::count()] = {id_i}, j[Lanes::count()] = {id_j};
  double friction[Lanes::count()] = {}, heat[Lanes::count()] = {};
  pair_normals(1, i, j, stage, want_friction ? friction : nullptr, want_heat ? heat : nullptr);
  return {friction[0], heat[0]};
}

Noise::PairUniforms Noise::pair_uniforms(std::uint32_t id_i, std::uint32_t id_j,
                                         Stage stage) const {
  const std::uint32_t i[Lanes::count()] = {id_i}, j[Lanes::count()] = {id_j};
  double friction[Lanes::count()], heat[Lanes::count()];
  pair_uniforms(1, i, j, stage, friction, heat);
  return {friction[0], heat[0]};
}

}  // namespace driftless
