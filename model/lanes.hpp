#pragma once

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <cstddef>

namespace driftless {

/// The words beside arithmetic that a pair kernel may use, for one pair and for lanes of pairs
/// alike: sqrt, exp, log, abs, min, max (found by argument, with the ones of std for double in
/// view), comparisons, and `select`, as lanes have no branches.
inline double select(bool condition, double yes, double no) { return condition ? yes : no; }

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
class Lanes {
 public:
  using Tag = hwy::HWY_NAMESPACE::ScalableTag<double>;
  using Raw = hwy::HWY_NAMESPACE::Vec<Tag>;

  Lanes() : Lanes(0.0) {}
  Lanes(double value) : raw_(hwy::HWY_NAMESPACE::Set(Tag(), value)) {}
  Lanes(Raw raw) : raw_(raw) {}
  static Lanes load(const double* from) { return hwy::HWY_NAMESPACE::LoadU(Tag(), from); }
  void store(double* to) const { hwy::HWY_NAMESPACE::StoreU(raw_, Tag(), to); }
  static constexpr std::size_t count() { return hwy::HWY_NAMESPACE::MaxLanes(Tag()); }
  Raw raw() const { return raw_; }

  friend Lanes operator+(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Add(a.raw_, b.raw_); }
  friend Lanes operator-(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Sub(a.raw_, b.raw_); }
  friend Lanes operator*(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Mul(a.raw_, b.raw_); }
  friend Lanes operator/(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Div(a.raw_, b.raw_); }
  /// One division for all lanes, and with constants one for all pairs.
  friend Lanes operator/(Lanes a, double b) { return a * Lanes(1 / b); }
  friend Lanes operator-(Lanes a) { return hwy::HWY_NAMESPACE::Neg(a.raw_); }
  Lanes& operator+=(Lanes other) { return *this = *this + other; }
  Lanes& operator-=(Lanes other) { return *this = *this - other; }
  Lanes& operator*=(Lanes other) { return *this = *this * other; }
  Lanes& operator/=(Lanes other) { return *this = *this / other; }

  friend LaneMask operator<(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Lt(a.raw_, b.raw_); }
  friend LaneMask operator>(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Gt(a.raw_, b.raw_); }
  friend LaneMask operator<=(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Le(a.raw_, b.raw_); }
  friend LaneMask operator>=(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Ge(a.raw_, b.raw_); }

  friend Lanes sqrt(Lanes a) { return hwy::HWY_NAMESPACE::Sqrt(a.raw_); }
  friend Lanes abs(Lanes a) { return hwy::HWY_NAMESPACE::Abs(a.raw_); }
  friend Lanes exp(Lanes a) { return hwy::HWY_NAMESPACE::Exp(Tag(), a.raw_); }
  friend Lanes log(Lanes a) { return hwy::HWY_NAMESPACE::Log(Tag(), a.raw_); }
  friend Lanes min(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Min(a.raw_, b.raw_); }
  friend Lanes max(Lanes a, Lanes b) { return hwy::HWY_NAMESPACE::Max(a.raw_, b.raw_); }
  friend Lanes select(LaneMask condition, Lanes yes, Lanes no) {
    return hwy::HWY_NAMESPACE::IfThenElse(condition.raw(), yes.raw_, no.raw_);
  }

 private:
  Raw raw_;
};

}  // namespace HWY_NAMESPACE

using HWY_NAMESPACE::LaneMask;
using HWY_NAMESPACE::Lanes;

}  // namespace driftless
