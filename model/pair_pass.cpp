#include "model/pair_pass.hpp"

#include <algorithm>

namespace driftless {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = Lanes::Tag;
using Signed = hn::RebindToSigned<Doubles>;

// Closer pairs have no direction; they exchange nothing.
constexpr double smallest_distance = 1e-10;

/// As many indices as there are lanes of doubles.
auto load_indices(const std::uint32_t* from) {
  const hn::Rebind<std::int32_t, Doubles> narrow;
  return hn::PromoteTo(Signed(), hn::LoadU(narrow, reinterpret_cast<const std::int32_t*>(from)));
}
using Index = decltype(load_indices(nullptr));

Lanes gather(const double* base, Index index) { return hn::GatherIndex(Doubles(), base, index); }

/// A quantity of a particle's four.
const double* component(const Quadruple* particles, std::size_t n) { return &particles->x + n; }

/// `count` brought up to whole lanes.
std::size_t padded(std::size_t count) {
  return (count + Lanes::count() - 1) / Lanes::count() * Lanes::count();
}

struct Triple {
  Lanes x, y, z;
};

Triple velocity(const Quadruple* particles, Index four_index) {
  return {gather(component(particles, 0), four_index), gather(component(particles, 1), four_index),
          gather(component(particles, 2), four_index)};
}

}  // namespace

void PairPass::reserve(std::size_t pairs) {
  if (pairs <= capacity_) return;
  constexpr std::size_t columns = sizeof(PairArrays) / sizeof(double*);
  static_assert(sizeof(PairArrays) == columns * sizeof(double*));
  capacity_ = (pairs + pairs / 2 + 15) / 8 * 8;
  const std::size_t stride = capacity_ + 2 * 8;  // lanes of any processor, and no two columns alike
  memory_.assign(columns * stride, 0.0);
  double* next = memory_.data();
  for (double** column :
       {&arrays_.r,         &arrays_.w_friction,   &arrays_.w_heat,     &arrays_.v,
        &arrays_.u_i,       &arrays_.u_j,          &arrays_.noise,      &arrays_.heat_noise,
        &arrays_.uniform,   &arrays_.heat_uniform, &arrays_.trial_v,    &arrays_.trial_u_i,
        &arrays_.trial_u_j, &arrays_.trial_dv_i,   &arrays_.trial_dv_j, &arrays_.momentum,
        &arrays_.energy_i,  &arrays_.energy_j,     &arrays_.e_x,        &arrays_.e_y,
        &arrays_.e_z}) {
    *column = next;
    next += stride;
  }
  std::fill_n(arrays_.uniform, stride, 1.0);
  std::fill_n(arrays_.heat_uniform, stride, 1.0);
  id_i_.resize(stride);
  id_j_.resize(stride);
  to_i_.resize(stride);
  to_j_.resize(stride);
}

void PairPass::take(const Fluid& fluid, const CellGrid& cells, const PairIndices& pairs,
                    std::size_t first, std::size_t count) {
  reserve(count);
  fluid_ = &fluid;
  cells_ = &cells;
  i_ = pairs.i.data() + first;
  j_ = pairs.j.data() + first;
  count_ = count;
}

void PairPass::geometry() {
  const auto& position = cells_->position();
  const Vector& length = cells_->box().lengths;
  double* const e[3] = {arrays_.e_x, arrays_.e_y, arrays_.e_z};
  const bool friction = fluid_->has_friction(), heat = fluid_->has_conduction();
  for (std::size_t n = 0; n < count_; n += Lanes::count()) {
    const auto i = load_indices(i_ + n), j = load_indices(j_ + n);
    Lanes difference[3], squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double side = length[static_cast<Eigen::Index>(axis)];
      const Lanes d = gather(position[axis].data(), i) - gather(position[axis].data(), j);
      const Lanes images = hn::Round((d * (1 / side)).raw());
      difference[axis] = d - images * side;
      squared += difference[axis] * difference[axis];
    }
    const Lanes r = sqrt(squared);
    const auto apart = r > smallest_distance;
    const Lanes inverse = select(apart, 1 / r, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      (difference[axis] * inverse).store(e[axis] + n);
    }
    r.store(arrays_.r + n);
    if (friction) select(apart, fluid_->friction_weight(r), 0).store(arrays_.w_friction + n);
    if (heat) select(apart, fluid_->heat_weight(r), 0).store(arrays_.w_heat + n);
  }
}

void PairPass::look_up_ids() {
  const auto& id = cells_->id();
  for (std::size_t n = 0; n < padded(count_); ++n) id_i_[n] = id[i_[n]];
  for (std::size_t n = 0; n < padded(count_); ++n) id_j_[n] = id[j_[n]];
}

void PairPass::draw_normals(const Noise& noise, unsigned stage) {
  if (!fluid_->fluctuates()) {
    std::fill_n(arrays_.noise, padded(count_), 0.0);
    std::fill_n(arrays_.heat_noise, padded(count_), 0.0);
    return;
  }
  look_up_ids();
  noise.pair_normals(count_, id_i_.data(), id_j_.data(), stage,
                     fluid_->has_friction() ? arrays_.noise : nullptr,
                     fluid_->has_conduction() ? arrays_.heat_noise : nullptr);
}

void PairPass::draw_uniforms(const Noise& noise, unsigned stage) {
  look_up_ids();
  noise.pair_uniforms(count_, id_i_.data(), id_j_.data(), stage, arrays_.uniform,
                      arrays_.heat_uniform);
  has_uniforms_ = true;
}

void PairPass::draw_no_uniforms() {
  if (!has_uniforms_) return;
  std::fill_n(arrays_.uniform, capacity_, 1.0);
  std::fill_n(arrays_.heat_uniform, capacity_, 1.0);
  has_uniforms_ = false;
}

void PairPass::recall_normals(const double* kept, std::size_t apart) {
  std::copy_n(kept, count_, arrays_.noise);
  std::copy_n(kept + apart, count_, arrays_.heat_noise);
}

void PairPass::keep_normals(double* kept, std::size_t apart) const {
  std::copy_n(arrays_.noise, count_, kept);
  std::copy_n(arrays_.heat_noise, count_, kept + apart);
}

void PairPass::motion(const PassParticles& particles, std::size_t from, std::size_t to) {
  const double* energy = particles.energy;
  for (std::size_t n = from; n < to; n += Lanes::count()) {
    const auto i = hn::ShiftLeft<2>(load_indices(i_ + n));
    const auto j = hn::ShiftLeft<2>(load_indices(j_ + n));
    const auto v_i = velocity(particles.motion, i), v_j = velocity(particles.motion, j);
    const Lanes v = (v_i.x - v_j.x) * Lanes::load(arrays_.e_x + n) +
                    (v_i.y - v_j.y) * Lanes::load(arrays_.e_y + n) +
                    (v_i.z - v_j.z) * Lanes::load(arrays_.e_z + n);
    v.store(arrays_.v + n);
    gather(energy, i).store(arrays_.u_i + n);
    gather(energy, j).store(arrays_.u_j + n);
  }
}

void PairPass::trial(const PassParticles& particles) {
  for (std::size_t n = 0; n < count_; n += Lanes::count()) {
    const auto i = hn::ShiftLeft<2>(load_indices(i_ + n));
    const auto j = hn::ShiftLeft<2>(load_indices(j_ + n));
    const auto along_e = [&](Index index) {
      const auto before = velocity(particles.motion, index);
      const auto after = velocity(particles.trial, index);
      return (after.x - before.x) * Lanes::load(arrays_.e_x + n) +
             (after.y - before.y) * Lanes::load(arrays_.e_y + n) +
             (after.z - before.z) * Lanes::load(arrays_.e_z + n);
    };
    const Lanes dv_i = along_e(i), dv_j = along_e(j);
    dv_i.store(arrays_.trial_dv_i + n);
    dv_j.store(arrays_.trial_dv_j + n);
    (Lanes::load(arrays_.v + n) + (dv_i - dv_j)).store(arrays_.trial_v + n);
    gather(component(particles.trial, 3), i).store(arrays_.trial_u_i + n);
    gather(component(particles.trial, 3), j).store(arrays_.trial_u_j + n);
  }
}

void PairPass::add(Quadruple* sums) {
  for (std::size_t n = 0; n < count_; n += Lanes::count()) {
    const Lanes momentum = Lanes::load(arrays_.momentum + n);
    const Lanes x = momentum * Lanes::load(arrays_.e_x + n),
                y = momentum * Lanes::load(arrays_.e_y + n),
                z = momentum * Lanes::load(arrays_.e_z + n);
    hn::StoreInterleaved4(x.raw(), y.raw(), z.raw(), Lanes::load(arrays_.energy_i + n).raw(),
                          Doubles(), &to_i_[n].x);
    hn::StoreInterleaved4((-x).raw(), (-y).raw(), (-z).raw(),
                          Lanes::load(arrays_.energy_j + n).raw(), Doubles(), &to_j_[n].x);
  }
  for (std::size_t n = 0; n < count_; ++n) {
    sums[i_[n]] += to_i_[n];
    sums[j_[n]] += to_j_[n];
  }
}

bool PairPass::apply(const PassParticles& particles, std::size_t from, std::size_t to) {
  const Lanes inverse_mass = 1 / fluid_->mass();
  // Lanes beyond the last pair go to a place that is nobody's.
  const auto nobody = hn::Set(Signed(), static_cast<std::int64_t>(cells_->particles()));
  double* const base = &particles.result->x;
  bool positive = true;
  for (std::size_t n = from; n < to; n += Lanes::count()) {
    const auto within = hn::FirstN(Signed(), to - n);
    const auto place = [&](const std::uint32_t* index) {
      return hn::ShiftLeft<2>(hn::IfThenElse(within, load_indices(index), nobody));
    };
    const auto i = place(i_ + n), j = place(j_ + n);
    const Lanes change = Lanes::load(arrays_.momentum + n) * inverse_mass;
    double* const e[3] = {arrays_.e_x, arrays_.e_y, arrays_.e_z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Lanes along = change * Lanes::load(e[axis] + n);
      hn::ScatterIndex((gather(base + axis, i) + along).raw(), Doubles(), base + axis, i);
      hn::ScatterIndex((gather(base + axis, j) - along).raw(), Doubles(), base + axis, j);
    }
    const Lanes u_i = gather(base + 3, i) + Lanes::load(arrays_.energy_i + n);
    const Lanes u_j = gather(base + 3, j) + Lanes::load(arrays_.energy_j + n);
    hn::ScatterIndex(u_i.raw(), Doubles(), base + 3, i);
    hn::ScatterIndex(u_j.raw(), Doubles(), base + 3, j);
    const auto counted = hn::FirstN(Doubles(), to - n);
    positive = positive && hn::AllFalse(Doubles(), hn::And(counted, (u_i <= 0 || u_j <= 0).raw()));
  }
  return positive;
}

}  // namespace driftless
