#include "model/pair_pass.hpp"

#include <algorithm>

namespace driftless {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = Lanes::Tag;
// Closer pairs have no direction; they exchange nothing.
constexpr double smallest_distance = 1e-10;

/// `count` brought up to whole lanes.
std::size_t padded(std::size_t count) {
  return (count + Lanes::count() - 1) / Lanes::count() * Lanes::count();
}

/// The four quantities of as many particles as there are lanes.
struct FourLanes {
  Lanes x, y, z, energy;
};

/// Particles are fetched whole and turned in registers: a particle's four lie side by side.
HWY_INLINE FourLanes fetch(const Quadruple* particles, const std::uint32_t* index) {
  constexpr std::size_t lanes = Lanes::count();
  const Doubles doubles;
  alignas(64) double side_by_side[4 * lanes];
#if HWY_TARGET <= HWY_AVX3
  const hn::Half<Doubles> half;
  for (std::size_t n = 0; n < lanes; n += 2) {
    const auto low = hn::LoadU(half, &particles[index[n]].x);
    const auto high = hn::LoadU(half, &particles[index[n + 1]].x);
    hn::Store(hn::Combine(doubles, high, low), doubles, side_by_side + 4 * n);
  }
#else
  for (std::size_t n = 0; n < lanes; ++n) {
    for (std::size_t part = 0; part < 4; part += lanes) {
      hn::StoreU(hn::LoadU(doubles, &particles[index[n]].x + part), doubles,
                 side_by_side + 4 * n + part);
    }
  }
#endif
  Lanes::Raw x, y, z, energy;
  hn::LoadInterleaved4(doubles, side_by_side, x, y, z, energy);
  return {x, y, z, energy};
}

/// The opposite: the lanes' particles side by side.
HWY_INLINE void turn(const FourLanes& lanes, Quadruple* particles) {
  hn::StoreInterleaved4(lanes.x.raw(), lanes.y.raw(), lanes.z.raw(), lanes.energy.raw(), Doubles(),
                        &particles->x);
}

}  // namespace

PassSeconds& PassSeconds::operator+=(const PassSeconds& other) {
  search += other.search;
  noise += other.noise;
  arithmetic += other.arithmetic;
  scatter += other.scatter;
  return *this;
}

void PairPass::reserve(std::size_t pairs) {
  if (pairs <= capacity_) return;
  // All members but what is known of the law.
  constexpr std::size_t columns = sizeof(PairArrays) / sizeof(double*) - 2;
  static_assert(sizeof(PairArrays) == (columns + 2) * sizeof(double*));
  capacity_ = (pairs + 7) / 8 * 8;
  const std::size_t stride = capacity_ + 2 * 8;  // lanes of any processor, and no two columns alike
  memory_.assign(columns * stride, 0.0);
  double* next = memory_.data();
  for (double** column :
       {&own_.r,        &own_.w_friction, &own_.w_heat,     &own_.v,          &own_.u_i,
        &own_.u_j,      &own_.noise,      &own_.heat_noise, &own_.uniform,    &own_.heat_uniform,
        &own_.trial_v,  &own_.trial_u_i,  &own_.trial_u_j,  &own_.trial_dv_i, &own_.trial_dv_j,
        &own_.momentum, &own_.energy_i,   &own_.energy_j,   &own_.e_x,        &own_.e_y,
        &own_.e_z}) {
    *column = next;
    next += stride;
  }
  std::fill_n(own_.uniform, stride, 1.0);
  std::fill_n(own_.heat_uniform, stride, 1.0);
  id_i_.resize(stride);
  id_j_.resize(stride);
}

void PairPass::take(const Fluid& fluid, const CellGrid& cells, const PairIndices& pairs,
                    std::size_t first, std::size_t count) {
  reserve(count);
  const PairLaw* const law = arrays_.law;
  arrays_ = own_;
  arrays_.law = law;
  fluid_ = &fluid;
  cells_ = &cells;
  i_ = pairs.i.data() + first;
  j_ = pairs.j.data() + first;
  count_ = count;
}

void PairPass::take(const Fluid& fluid, const CellGrid& cells, const GroupedPairs& grouped,
                    std::size_t first, std::size_t count) {
  take(fluid, cells, grouped.pairs, 0, count);
  ordered_i_.resize(capacity_ + 2 * 8);
  ordered_j_.resize(capacity_ + 2 * 8);
  const std::uint32_t* const order = grouped.groups.order.data() + first;
  for (std::size_t n = 0; n < count; ++n) {
    ordered_i_[n] = i_[order[n]];
    ordered_j_[n] = j_[order[n]];
  }
  // Beyond the last pair a particle of this block: another may be at work on any other.
  for (std::size_t n = count; count > 0 && n < count + 2 * Lanes::count(); ++n) {
    ordered_i_[n] = ordered_j_[n] = ordered_i_[count - 1];
  }
  i_ = ordered_i_.data();
  j_ = ordered_j_.data();
}

// The columns of what the fluid does not have stay the pass's own, which are never written.
void PairPass::work_in(double* kept, std::size_t apart, bool with_geometry) {
  const auto put = [&](double*& column) {
    column = kept;
    kept += apart;
  };
  if (fluid_->has_friction()) put(arrays_.noise);
  if (fluid_->has_conduction()) put(arrays_.heat_noise);
  if (!with_geometry) return;
  for (double** column : {&arrays_.e_x, &arrays_.e_y, &arrays_.e_z, &arrays_.r}) put(*column);
  if (fluid_->has_friction()) put(arrays_.w_friction);
  if (fluid_->has_conduction()) put(arrays_.w_heat);
}

std::size_t PairPass::columns(const Fluid& fluid, bool with_geometry) {
  const std::size_t terms =
      static_cast<unsigned>(fluid.has_friction()) + static_cast<unsigned>(fluid.has_conduction());
  return with_geometry ? 2 * terms + 4 : terms;
}

void PairPass::geometry(std::size_t from, std::size_t to) {
  const PassClock clock(part(&PassSeconds::arithmetic));
  const Quadruple* const position = cells_->position().data();
  const Vector& length = cells_->lengths();
  const PairLaw& law = *arrays_.law;
  const bool friction = fluid_->has_friction(), heat = fluid_->has_conduction();
  const auto nearest_image = [](Lanes difference, double side) {
    const Lanes images = hn::Round((difference / side).raw());
    return difference - images * side;
  };
  for (std::size_t n = from; n < to; n += Lanes::count()) {
    const auto i = fetch(position, i_ + n), j = fetch(position, j_ + n);
    const Lanes x = nearest_image(i.x - j.x, length[0]), y = nearest_image(i.y - j.y, length[1]),
                z = nearest_image(i.z - j.z, length[2]);
    const Lanes r = sqrt(x * x + y * y + z * z);
    const auto apart = r > smallest_distance;
    const Lanes inverse = select(apart, 1.0 / r, 0.0);
    (x * inverse).store(arrays_.e_x + n);
    (y * inverse).store(arrays_.e_y + n);
    (z * inverse).store(arrays_.e_z + n);
    r.store(arrays_.r + n);
    if (friction) select(apart, law.friction_weight(r), 0.0).store(arrays_.w_friction + n);
    if (heat) select(apart, law.heat_weight(r), 0.0).store(arrays_.w_heat + n);
  }
}

void PairPass::contact_geometry(std::size_t boundary) {
  const PassClock clock(part(&PassSeconds::arithmetic));
  const bool field = boundary == field_place, upper = boundary % 2 == 1;
  const PairLaw& law = *arrays_.law;
  Eigen::Index axis = static_cast<Eigen::Index>(boundary / 2);
  if (field) cells_->box().gravity.cwiseAbs().maxCoeff(&axis);
  double* const e[] = {arrays_.e_x, arrays_.e_y, arrays_.e_z};
  for (Eigen::Index n = 0; n < 3; ++n) {
    std::fill_n(e[n], padded(count_), n != axis ? 0.0 : !field && upper ? -1.0 : 1.0);
  }
  const double length = cells_->box().lengths[axis];
  for (std::size_t n = 0; n < padded(count_); n += Lanes::count()) {
    const auto at = fetch(cells_->position().data(), i_ + n);
    const Lanes x = axis == 0 ? at.x : axis == 1 ? at.y : at.z;
    const Lanes r = !field && upper ? length - x : x;
    r.store(arrays_.r + n);
    (field ? Lanes(0.0) : law.friction_weight(r)).store(arrays_.w_friction + n);
    (field ? Lanes(0.0) : law.heat_weight(r)).store(arrays_.w_heat + n);
  }
}

void PairPass::look_up_ids() {
  for (std::size_t n = 0; n < padded(count_); ++n) id_i_[n] = cells_->id(i_[n]);
  for (std::size_t n = 0; n < padded(count_); ++n) id_j_[n] = cells_->id(j_[n]);
}

void PairPass::look_up_contact_ids(std::uint32_t boundary_id) {
  for (std::size_t n = 0; n < padded(count_); ++n) id_i_[n] = cells_->id(i_[n]);
  std::fill_n(id_j_.begin(), padded(count_), boundary_id);
}

void PairPass::draw_normals_of_ids(const Noise& noise, Stage stage) {
  noise.pair_normals(count_, id_i_.data(), id_j_.data(), stage,
                     fluid_->has_friction() ? arrays_.noise : nullptr,
                     fluid_->has_conduction() ? arrays_.heat_noise : nullptr);
}

void PairPass::draw_normals(const Noise& noise, Stage stage) {
  const PassClock clock(part(&PassSeconds::noise));
  if (!fluid_->fluctuates()) {
    std::fill_n(arrays_.noise, padded(count_), 0.0);
    std::fill_n(arrays_.heat_noise, padded(count_), 0.0);
    return;
  }
  look_up_ids();
  draw_normals_of_ids(noise, stage);
}

void PairPass::draw_contact_normals(const Noise& noise, Stage stage, std::uint32_t boundary_id) {
  const PassClock clock(part(&PassSeconds::noise));
  if (!fluid_->fluctuates() || arrays_.law->range() == 0) {
    std::fill_n(arrays_.noise, padded(count_), 0.0);
    std::fill_n(arrays_.heat_noise, padded(count_), 0.0);
    return;
  }
  look_up_contact_ids(boundary_id);
  draw_normals_of_ids(noise, stage);
}

void PairPass::draw_uniforms_of_ids(const Noise& noise, Stage stage) {
  noise.pair_uniforms(count_, id_i_.data(), id_j_.data(), stage, arrays_.uniform,
                      arrays_.heat_uniform);
  has_uniforms_ = true;
}

void PairPass::draw_uniforms(const Noise& noise, Stage stage) {
  const PassClock clock(part(&PassSeconds::noise));
  look_up_ids();
  draw_uniforms_of_ids(noise, stage);
}

void PairPass::draw_contact_uniforms(const Noise& noise, Stage stage, std::uint32_t boundary_id) {
  const PassClock clock(part(&PassSeconds::noise));
  look_up_contact_ids(boundary_id);
  draw_uniforms_of_ids(noise, stage);
}

void PairPass::draw_no_uniforms() {
  if (!has_uniforms_) return;
  std::fill_n(arrays_.uniform, capacity_, 1.0);
  std::fill_n(arrays_.heat_uniform, capacity_, 1.0);
  has_uniforms_ = false;
}

void PairPass::motion(const PassParticles& particles, std::size_t from, std::size_t to) {
  const PassClock clock(part(&PassSeconds::arithmetic));
  for (std::size_t n = from; n < to; n += Lanes::count()) {
    const auto of_i = fetch(particles.motion, i_ + n), of_j = fetch(particles.motion, j_ + n);
    const Lanes v = (of_i.x - of_j.x) * Lanes::load(arrays_.e_x + n) +
                    (of_i.y - of_j.y) * Lanes::load(arrays_.e_y + n) +
                    (of_i.z - of_j.z) * Lanes::load(arrays_.e_z + n);
    v.store(arrays_.v + n);
    of_i.energy.store(arrays_.u_i + n);
    of_j.energy.store(arrays_.u_j + n);
  }
  if (!particles.energy) return;
  for (std::size_t n = from; n < to; n += Lanes::count()) {
    fetch(particles.energy, i_ + n).energy.store(arrays_.u_i + n);
    fetch(particles.energy, j_ + n).energy.store(arrays_.u_j + n);
  }
}

void PairPass::trial(const PassParticles& particles) {
  const PassClock clock(part(&PassSeconds::arithmetic));
  for (std::size_t n = 0; n < count_; n += Lanes::count()) {
    const auto change_along_e = [&](const FourLanes& before, const FourLanes& after) {
      return (after.x - before.x) * Lanes::load(arrays_.e_x + n) +
             (after.y - before.y) * Lanes::load(arrays_.e_y + n) +
             (after.z - before.z) * Lanes::load(arrays_.e_z + n);
    };
    const auto i = fetch(particles.trial, i_ + n), j = fetch(particles.trial, j_ + n);
    const Lanes dv_i = change_along_e(fetch(particles.motion, i_ + n), i);
    const Lanes dv_j = change_along_e(fetch(particles.motion, j_ + n), j);
    dv_i.store(arrays_.trial_dv_i + n);
    dv_j.store(arrays_.trial_dv_j + n);
    (Lanes::load(arrays_.v + n) + (dv_i - dv_j)).store(arrays_.trial_v + n);
    i.energy.store(arrays_.trial_u_i + n);
    j.energy.store(arrays_.trial_u_j + n);
  }
}

void PairPass::add(Quadruple* sums) {
  const PassClock clock(part(&PassSeconds::scatter));
  constexpr std::size_t at_once = 64;
  Quadruple to_i[at_once], to_j[at_once];
  for (std::size_t first = 0; first < count_; first += at_once) {
    const std::size_t end = std::min(first + at_once, count_);
    for (std::size_t n = first; n < end; n += Lanes::count()) {
      const Lanes momentum = Lanes::load(arrays_.momentum + n);
      const Lanes x = momentum * Lanes::load(arrays_.e_x + n),
                  y = momentum * Lanes::load(arrays_.e_y + n),
                  z = momentum * Lanes::load(arrays_.e_z + n);
      turn({x, y, z, Lanes::load(arrays_.energy_i + n)}, &to_i[n - first]);
      turn({-x, -y, -z, Lanes::load(arrays_.energy_j + n)}, &to_j[n - first]);
    }
    for (std::size_t n = first; n < end; ++n) {
      sums[i_[n]] += to_i[n - first];
      sums[j_[n]] += to_j[n - first];
    }
  }
}

bool PairPass::apply(const PassParticles& particles, std::size_t from, std::size_t to) {
  const PassClock clock(part(&PassSeconds::scatter));
  const double inverse_mass_i = arrays_.law->inverse_mass_i(),
               inverse_mass_j = arrays_.law->inverse_mass_j();
  Quadruple* const result = particles.result;
  const bool isothermal = fluid_->isothermal();
  Quadruple to_i[Lanes::count()], to_j[Lanes::count()];
  bool positive = true;
  for (std::size_t n = from; n < to; n += Lanes::count()) {
    const Lanes momentum = Lanes::load(arrays_.momentum + n);
    const Lanes e_x = Lanes::load(arrays_.e_x + n), e_y = Lanes::load(arrays_.e_y + n),
                e_z = Lanes::load(arrays_.e_z + n);
    const Lanes by_i = momentum * inverse_mass_i, by_j = momentum * inverse_mass_j;
    const auto i = fetch(result, i_ + n), j = fetch(result, j_ + n);
    const Lanes u_i = isothermal ? i.energy : i.energy + Lanes::load(arrays_.energy_i + n);
    const Lanes u_j = isothermal ? j.energy : j.energy + Lanes::load(arrays_.energy_j + n);
    turn({i.x + by_i * e_x, i.y + by_i * e_y, i.z + by_i * e_z, u_i}, to_i);
    turn({j.x - by_j * e_x, j.y - by_j * e_y, j.z - by_j * e_z, u_j}, to_j);
    const std::size_t count = std::min(Lanes::count(), to - n);
    for (std::size_t lane = 0; lane < count; ++lane) {
      result[i_[n + lane]] = to_i[lane];
      result[j_[n + lane]] = to_j[lane];
    }
    if (isothermal) continue;
    const auto counted = hn::FirstN(Doubles(), count);
    const auto spent = (u_i <= 0.0 || u_j <= 0.0).raw();
    positive = positive && hn::AllFalse(Doubles(), hn::And(counted, spent));
  }
  return positive;
}

bool PairPass::apply_contacts(const PassParticles& particles, std::size_t from, std::size_t to) {
  const PassClock clock(part(&PassSeconds::scatter));
  const double inverse_mass = arrays_.law->inverse_mass_i();
  const bool isothermal = fluid_->isothermal();
  bool positive = true;
  for (std::size_t n = from; n < to; ++n) {
    const double f = arrays_.momentum[n];
    const Vector momentum(f * arrays_.e_x[n], f * arrays_.e_y[n], f * arrays_.e_z[n]);
    Quadruple& i = particles.result[i_[n]];
    i += {inverse_mass * momentum[0], inverse_mass * momentum[1], inverse_mass * momentum[2],
          isothermal ? 0 : arrays_.energy_i[n]};
    particles.received[j_[n] - cells_->particles()] +=
        {-momentum[0], -momentum[1], -momentum[2], isothermal ? 0 : arrays_.energy_j[n]};
    positive = positive && (isothermal || i.energy > 0);
  }
  return positive;
}

}  // namespace driftless
