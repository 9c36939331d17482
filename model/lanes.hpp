#pragma once

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <cstddef>

namespace driftless {

/// The words beside arithmetic that a pair kernel may use, for one pair and for lanes of pairs
/// alike: sqrt, exp, log, abs, min, max (found by argument, with the ones of std for double in
/// view), comparisons, and `select`, as lanes have no branches.
inline double select(bool condition, double yes, double no) { return condition ? yes : no; }

/// Whether numbers of a type promise to meet no laws but the common ones (PairLaw::is_common):
/// what the others need then stands in no loop.
template <class V>
inline constexpr bool meets_common_laws = false;

// The number of lanes follows the instructions that a file is compiled for. The namespace does too,
// so that files compiled for different ones can be linked together.
namespace HWY_NAMESPACE {

/// Which lanes fulfil a condition.
class LaneMask {
 public:
  using Mask = hwy::HWY_NAMESPACE::Mask<hwy::HWY_NAMESPACE::ScalableTag<double>>;
  LaneMask(Mask mask) : mask_(mask) {}
  Mask raw() const { return mask_; }

  friend LaneMask operator&&(LaneMask a, LaneMask b) {
    return hwy::HWY_NAMESPACE::And(a.mask_, b.mask_);
  }
  friend LaneMask operator||(LaneMask a, LaneMask b) {
    return hwy::HWY_NAMESPACE::Or(a.mask_, b.mask_);
  }
  friend LaneMask operator!(LaneMask a) { return hwy::HWY_NAMESPACE::Not(a.mask_); }

 private:
  Mask mask_;
};

/// As many doubles as one instruction handles, with the arithmetic of one double.
template <bool of_common_laws>
class LanesOf {
 public:
  using Tag = hwy::HWY_NAMESPACE::ScalableTag<double>;
  using Raw = hwy::HWY_NAMESPACE::Vec<Tag>;

  LanesOf() : LanesOf(0.0) {}
  LanesOf(double value) : raw_(hwy::HWY_NAMESPACE::Set(Tag(), value)) {}
  LanesOf(Raw raw) : raw_(raw) {}
  static LanesOf load(const double* from) { return hwy::HWY_NAMESPACE::LoadU(Tag(), from); }
  void store(double* to) const { hwy::HWY_NAMESPACE::StoreU(raw_, Tag(), to); }
  static constexpr std::size_t count() { return hwy::HWY_NAMESPACE::MaxLanes(Tag()); }
  Raw raw() const { return raw_; }

  friend LanesOf operator+(LanesOf a, LanesOf b) { return hwy::HWY_NAMESPACE::Add(a.raw_, b.raw_); }
  friend LanesOf operator-(LanesOf a, LanesOf b) { return hwy::HWY_NAMESPACE::Sub(a.raw_, b.raw_); }
  friend LanesOf operator*(LanesOf a, LanesOf b) { return hwy::HWY_NAMESPACE::Mul(a.raw_, b.raw_); }
  friend LanesOf operator/(LanesOf a, LanesOf b) { return hwy::HWY_NAMESPACE::Div(a.raw_, b.raw_); }
  /// One division for all lanes, and with constants one for all pairs.
  friend LanesOf operator/(LanesOf a, double b) { return a * LanesOf(1 / b); }
  friend LanesOf operator-(LanesOf a) { return hwy::HWY_NAMESPACE::Neg(a.raw_); }
  LanesOf& operator+=(LanesOf other) { return *this = *this + other; }
  LanesOf& operator-=(LanesOf other) { return *this = *this - other; }
  LanesOf& operator*=(LanesOf other) { return *this = *this * other; }
  LanesOf& operator/=(LanesOf other) { return *this = *this / other; }

  friend LaneMask operator<(LanesOf a, LanesOf b) { return hwy::HWY_NAMESPACE::Lt(a.raw_, b.raw_); }
  friend LaneMask operator>(LanesOf a, LanesOf b) { return hwy::HWY_NAMESPACE::Gt(a.raw_, b.raw_); }
  friend LaneMask operator<=(LanesOf a, LanesOf b) {
    return hwy::HWY_NAMESPACE::Le(a.raw_, b.raw_);
  }
  friend LaneMask operator>=(LanesOf a, LanesOf b) {
    return hwy::HWY_NAMESPACE::Ge(a.raw_, b.raw_);
  }

  friend LanesOf sqrt(LanesOf a) { return hwy::HWY_NAMESPACE::Sqrt(a.raw_); }
  friend LanesOf abs(LanesOf a) { return hwy::HWY_NAMESPACE::Abs(a.raw_); }
  friend LanesOf exp(LanesOf a) { return hwy::HWY_NAMESPACE::Exp(Tag(), a.raw_); }
  friend LanesOf log(LanesOf a) { return hwy::HWY_NAMESPACE::Log(Tag(), a.raw_); }
  friend LanesOf min(LanesOf a, LanesOf b) { return hwy::HWY_NAMESPACE::Min(a.raw_, b.raw_); }
  friend LanesOf max(LanesOf a, LanesOf b) { return hwy::HWY_NAMESPACE::Max(a.raw_, b.raw_); }
  friend LanesOf select(LaneMask condition, LanesOf yes, LanesOf no) {
    return hwy::HWY_NAMESPACE::IfThenElse(condition.raw(), yes.raw_, no.raw_);
  }

 private:
  Raw raw_;
};

using Lanes = LanesOf<false>;
using CommonLanes = LanesOf<true>;

}  // namespace HWY_NAMESPACE

using HWY_NAMESPACE::CommonLanes;
using HWY_NAMESPACE::LaneMask;
using HWY_NAMESPACE::Lanes;

template <>
inline constexpr bool meets_common_laws<CommonLanes> = true;

}  // namespace driftless
