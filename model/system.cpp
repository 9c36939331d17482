#include "model/system.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace driftless {
namespace {

/// So many that what the passes read and write stays in the cache.
constexpr std::size_t pairs_a_chunk = 512;
/// The other side of a contact is at rest, and no exchange exhausts it.
constexpr Quadruple boundary_motion{0, 0, 0, 1e300};

/// Brings positions into the box; throws std::invalid_argument if the state makes no sense.
State valid(const Box& box, State state) {
  const std::size_t particles = state.size();
  if (state.velocity.size() != particles || state.internal_energy.size() != particles ||
      state.id.size() != particles) {
    throw std::invalid_argument("the arrays of a state differ in length");
  }
  if (!state.species.empty() && state.species.size() != particles) {
    throw std::invalid_argument("the arrays of a state differ in length");
  }
  auto ids = state.id;
  std::sort(ids.begin(), ids.end());
  if (std::adjacent_find(ids.begin(), ids.end()) != ids.end()) {
    throw std::invalid_argument("two particles of a state have the same id");
  }
  for (auto& position : state.position) {
    position = box.wrap(position);
    if (!box.contains(position)) {
      throw std::invalid_argument("a position is not finite, or is beyond a wall");
    }
  }
  return state;
}

}  // namespace

System::System(const Fluid& fluid, const Box& box, State state, const Noise& noise, bool frozen)
    : fluid_(fluid.within(box)),
      box_(box),
      state_(valid(box, std::move(state))),
      noise_(noise),
      frozen_(frozen),
      cells_(box, fluid_.range(), state_.size()),
      pairs_(cells_, fluid_.range(), 1) {
  check_species();
  drop_if_isothermal(state_.internal_energy);
  set_threads(1);
}

void System::check_species() const {
  for (const auto species : state_.species) {
    if (species < fluid_.species()) continue;
    throw std::invalid_argument("a particle is of a species that the fluid does not have");
  }
}

void System::set_threads(unsigned count) {
  threads_ = Threads(count);
  cut_cells();
}

void System::cut_cells() {
  cells_ = CellGrid(box_, fluid_.range(), size());
  pairs_ = PairBlocks(cells_, fluid_.range(), threads_.count(), fluid_.species());
  contacts_ = BoundaryContacts();
  passes_.resize(threads_.count());
  forget_sums();
  if (measured_) measure_passes();
  pairs_version_ = 0;
}

void System::measure_passes() {
  measured_ = true;
  for (auto& pass : passes_) pass.measure(true);
}

PassSeconds System::pass_seconds() const {
  PassSeconds sum;
  for (const auto& pass : passes_) sum += pass.seconds();
  return sum;
}

template <class Value>
void System::bring_along(const Places& places, std::vector<Value>& values) const {
  if (values.size() != places.size()) return;
  const auto ordered = std::make_unique_for_overwrite<Value[]>(values.size());
  for_each_particle([&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) ordered[n] = values[places[n]];
  });
  for_each_particle([&](std::size_t begin, std::size_t end) {
    std::copy(&ordered[begin], &ordered[end], &values[begin]);
  });
}

Places System::order_storage() {
  find_pairs();
  Places places(size());
  for (std::size_t n = 0; n < size(); ++n) places[n] = cells_.place(n);
  bring_along(places, state_.position);
  bring_along(places, state_.velocity);
  bring_along(places, state_.internal_energy);
  bring_along(places, state_.id);
  bring_along(places, state_.species);
  bring_along(places, conservative_.momentum);
  bring_along(places, conservative_.energy);
  cells_.follow_storage();
  factors_version_ = thermal_positions_version_ = 0;
  return places;
}

void System::find_pairs() {
  if (summing_) forget_sums();
  if (has_pairs()) return;
  const PassClock clock(passes_[0].part(&PassSeconds::search));
  begin_search();
  const std::size_t blocks = pairs_.blocks();
  const std::size_t tasks[] = {threads_.count(), threads_.count(), blocks + contacts_.all().size()};
  threads_.phases(tasks, [&](unsigned, std::size_t phase, std::size_t task) {
    if (phase < 2) {
      sort_particles(phase, task, nothing_to_prepare);
    } else if (task < blocks) {
      pairs_.find_in(pairs_.to_search(task), cells_);
    } else {
      contacts_.find_in(contacts_.all()[task - blocks], cells_);
    }
  });
  pairs_version_ = positions_version_;
}

void System::begin_search() {
  cells_.begin_sort(state_);
  pairs_.begin_find(cells_);
  contacts_.begin_find(fluid_, box_);
}

void System::sort_particles(std::size_t phase, std::size_t task,
                            FunctionReference<void(std::size_t, std::size_t)> prepare) {
  if (phase == 0) {
    cells_.assign(state_, task, threads_.count());
  } else {
    const auto [begin, end] = cells_.fill(state_, task, threads_.count());
    prepare(begin, end);
  }
}

void System::make_room(std::vector<Quadruple>& gathered) const {
  gathered.resize(size() + BoundaryContacts::numbers);
  std::fill(gathered.begin() + static_cast<std::ptrdiff_t>(size()), gathered.end(),
            boundary_motion);
}

void System::gather_motion(const Motion& motion, std::vector<Quadruple>& gathered,
                           std::size_t begin, std::size_t end) const {
  const bool isothermal = fluid_.isothermal();
  const double bath = fluid_.bath_energy();
  for (std::size_t n = begin; n < end; ++n) {
    const std::size_t place = cells_.place(n);
    const Vector& v = motion.velocity[place];
    gathered[n] = {v[0], v[1], v[2], isothermal ? bath : motion.internal_energy[place]};
  }
}

void System::count_visit(bool noise, bool uniforms) {
  const std::uint64_t pairs = pairs_.pairs() + contacts_.contacts();
  counters_.pair_evaluations += pairs;
  const auto normals =
      static_cast<unsigned>(fluid_.has_friction()) + static_cast<unsigned>(fluid_.has_conduction());
  if (noise && fluid_.fluctuates()) counters_.random_numbers += pairs * normals;
  if (uniforms) counters_.random_numbers += 2 * pairs;
}

bool System::is_kept(Stage stage) {
  const auto& blocks = pairs_.all();
  return std::all_of(blocks.begin(), blocks.end(), [&](const PairBlock& block) {
    return block.found.size == 0 || (!block.kept.empty() && block.kept_step == noise_.step() &&
                                     block.kept_stage == stage.number);
  });
}

// It takes 290 bytes a particle at density 3; in larger systems it is computed anew in each round.
bool System::keeps_geometry() const { return cells_.few(); }

void System::work_in_kept(PairPass& pass, PairBlock& block, std::size_t first, Stage stage) const {
  const std::size_t apart = block.found.size + 2 * Lanes::count();
  resize_closely(block.kept, apart * PairPass::columns(fluid_, keeps_geometry()));
  block.kept_step = noise_.step();
  block.kept_stage = stage.number;
  pass.work_in(block.kept.data() + first, apart, keeps_geometry());
}

void System::accumulate(const PairKernel& kernel, const Motion* trial, Exchange& total, Stage stage,
                        Rounds rounds) {
  const bool again = rounds == Rounds::several;
  if (again) find_pairs();  // what is kept is of these
  make_room(motion_);
  if (trial) make_room(trial_);
  const auto gather = [&](std::size_t begin, std::size_t end) {
    gather_motion(state_, motion_, begin, end);
    if (trial) gather_motion(*trial, trial_, begin, end);
  };
  const PassParticles particles{motion_.data(), trial_.data(), nullptr, nullptr};
  const bool kept = again && is_kept(stage);
  const auto visit = [&](PairPass& pass, PairBlock& block, std::size_t first, std::size_t count) {
    if (again) work_in_kept(pass, block, first, stage);
    if (!kept || !keeps_geometry()) pass.geometry(0, count);
    if (!kept) pass.draw_normals(noise_, stage);
    pass.draw_no_uniforms();
    pass.motion(particles, 0, count);
    if (trial) pass.trial(particles);
    pass.run(kernel, 0, count);
  };
  const auto at_boundary = [&](PairPass& pass, std::size_t boundary, std::size_t count) {
    pass.draw_contact_normals(noise_, stage, BoundaryContacts::id(boundary));
    pass.draw_no_uniforms();
    pass.motion(particles, 0, count);
    if (trial) pass.trial(particles);
    pass.run(kernel, 0, count);
  };
  const ContactAnswer contacts(at_boundary);
  sum(total, visit, gather, &contacts);
  drop_if_isothermal(total.energy);
  drop_if_isothermal(total.surroundings);
  count_visit(!kept, false);
}

void System::sum(Exchange& total, PairAnswer answer,
                 FunctionReference<void(std::size_t, std::size_t)> prepare,
                 const ContactAnswer* at_boundary) {
  if (measured_ || summing_ || !at_boundary) find_pairs();
  const bool search_first = !has_pairs();
  if (search_first) begin_search();
  // Particles, sorted if need be; pairs colour by colour and contacts, which who visits them finds;
  // and particles again.
  std::vector<std::size_t> tasks(search_first ? 2 : 1, threads_.count());
  summing_ = true;
  total.momentum.resize(size());
  total.energy.resize(size());
  const auto colours = pairs_.colours();
  const auto contacts = at_boundary ? contacts_.phases() : std::span<const std::size_t>();
  const std::size_t first_colour = tasks.size(), first_contact = first_colour + colours.size(),
                    last = first_contact + contacts.size();
  tasks.insert(tasks.end(), colours.begin(), colours.end());
  tasks.insert(tasks.end(), contacts.begin(), contacts.end());
  tasks.push_back(threads_.count());
  std::fill(sums_.begin() + static_cast<std::ptrdiff_t>(size()), sums_.end(), Quadruple{});
  const auto start = [&](std::size_t begin, std::size_t end) {
    std::fill_n(sums_.begin() + static_cast<std::ptrdiff_t>(begin), end - begin, Quadruple{});
    prepare(begin, end);
  };
  const auto visit = [&](PairPass& pass, PairBlock& block, std::size_t first, std::size_t count) {
    answer(pass, block, first, count);
    pass.add(sums_.data());
  };
  const auto visit_contacts = [&](PairPass& pass, std::size_t boundary, std::size_t count) {
    (*at_boundary)(pass, boundary, count);
    pass.add(sums_.data());
  };
  threads_.phases(tasks, [&](unsigned thread, std::size_t phase, std::size_t task) {
    PairPass& pass = passes_[thread];
    const std::size_t begin = size() * task / threads_.count(),
                      end = size() * (task + 1) / threads_.count();
    if (phase < first_colour && search_first) {
      sort_particles(phase, task, start);
    } else if (phase < first_colour) {
      start(begin, end);
    } else if (phase < first_contact) {
      PairBlock& block = pairs_.block(phase - first_colour, task);
      if (search_first) pairs_.find_in(block, cells_);
      for_each_run(pass, block, visit);
    } else if (phase < last) {
      auto& group = contacts_.group(phase - first_contact, task);
      if (search_first) contacts_.find_in(group, cells_);
      for_each_contact_run(pass, group, visit_contacts);
    } else {
      scatter_sums(total, begin, end);
    }
  });
  pairs_version_ = positions_version_;
  total.surroundings = {};
  for (std::size_t number = 0; !contacts.empty() && number < BoundaryContacts::numbers; ++number) {
    const auto& received = sums_[size() + number];
    total.surroundings[BoundaryContacts::boundary(number)] +=
        {Vector(received.x, received.y, received.z), received.energy};
  }
  summing_ = false;
}

// Numbers jump, places less so: reading here and there costs less than writing.
void System::scatter_sums(Exchange& total, std::size_t begin, std::size_t end) const {
  for (std::size_t i = begin; i < end; ++i) {
    const Quadruple& sum = sums_[cells_.number(i)];
    total.momentum[i] = Vector(sum.x, sum.y, sum.z);
    total.energy[i] = sum.energy;
  }
}

void System::for_each_run(PairPass& pass, PairBlock& block, PairAnswer visit) {
  std::size_t first = 0;
  for (std::size_t kind = 0; kind < block.kind_end.size(); ++kind) {
    pass.set_law(fluid_.law(kind / fluid_.species(), kind % fluid_.species()));
    for (const std::size_t end = block.kind_end[kind]; first < end;) {
      const std::size_t count = std::min(pairs_a_chunk, end - first);
      pass.take(fluid_, cells_, block.found, first, count);
      visit(pass, block, first, count);
      first += count;
    }
  }
}

void System::for_each_contact_run(PairPass& pass, const BoundaryContacts::Group& group,
                                  ContactAnswer answer) {
  pass.set_law(*group.law);
  for (std::size_t first = 0; first < group.contacts.size; first += pairs_a_chunk) {
    const std::size_t count = std::min(pairs_a_chunk, group.contacts.size - first);
    pass.take(fluid_, cells_, group.contacts, first, count);
    pass.contact_geometry(group.boundary);
    answer(pass, group.boundary, count);
  }
}

void System::drop_if_isothermal(Surroundings& surroundings) const {
  if (!fluid_.isothermal()) return;
  for (auto& received : surroundings) received.energy = 0;
}

void System::drop_if_isothermal(std::vector<double>& energies) const {
  if (fluid_.isothermal()) std::fill(energies.begin(), energies.end(), 0.0);
}

void System::forget_sums() {
  sums_.assign(size() + BoundaryContacts::numbers, {});
  for (auto& block : pairs_.all()) block.kept.clear();
  summing_ = false;
}

void System::note_failed(const PairPass& pass, std::size_t from, std::size_t to,
                         std::vector<std::uint32_t>& failed) const {
  for (std::size_t pair = from; pair < to; ++pair) {
    for (const auto particle : {pass.i(pair), pass.j(pair)}) {
      if (particle < size() && motion_[particle].energy <= 0) {
        failed.push_back(cells_.id(particle));
      }
    }
  }
}

void System::sweep_groups(PairPass& pass, const GroupedPairs& grouped,
                          const PassParticles& particles, const PairKernel& kernel,
                          const Sweep& how, std::vector<std::uint32_t>& failed) {
  const std::size_t pairs = grouped.pairs.size;
  const std::size_t chunks = (pairs + pairs_a_chunk - 1) / pairs_a_chunk;
  for (std::size_t n = 0; n < chunks; ++n) {
    const std::size_t chunk = how.order == SweepOrder::forward ? n : chunks - 1 - n;
    const std::size_t first = chunk * pairs_a_chunk;
    sweep_chunk(pass, grouped, first, std::min(pairs_a_chunk, pairs - first), particles, kernel,
                how, failed);
  }
}

// A group may lie in several chunks: its pairs do not see each other's results.
void System::sweep_chunk(PairPass& pass, const GroupedPairs& grouped, std::size_t first,
                         std::size_t count, const PassParticles& particles,
                         const PairKernel& kernel, const Sweep& how,
                         std::vector<std::uint32_t>& failed) {
  const PairGroups& groups = grouped.groups;
  const std::size_t species = fluid_.species(), kinds = species * species;
  const auto group_of = [&](std::size_t pair) {
    return static_cast<std::size_t>(std::upper_bound(groups.end.begin(), groups.end.end(), pair) -
                                    groups.end.begin());
  };
  const std::size_t first_group = group_of(first), end_group = group_of(first + count - 1) + 1;
  // Within the chunk.
  const auto begin_of = [&](std::size_t g) {
    return std::max<std::size_t>(groups.begin_of(g), first) - first;
  };
  const auto end_of = [&](std::size_t g) {
    return std::min<std::size_t>(groups.end[g], first + count) - first;
  };
  const auto set_law = [&](std::size_t g) {
    const std::size_t kind = g % kinds;
    pass.set_law(fluid_.law(kind / species, kind % species));
  };
  pass.take(fluid_, cells_, grouped, first, count);
  if (kinds == 1) {
    set_law(0);
    pass.geometry(0, count);
  }
  for (std::size_t g = first_group; kinds > 1 && g < end_group; ++g) {
    set_law(g);
    pass.geometry(begin_of(g), end_of(g));
  }
  pass.draw_normals(noise_, how.stage);
  if (how.uniforms) {
    pass.draw_uniforms(noise_, how.stage);
  } else {
    pass.draw_no_uniforms();
  }
  for (std::size_t n = first_group; n < end_group; ++n) {
    const std::size_t g = how.order == SweepOrder::forward ? n : end_group - 1 - (n - first_group);
    const std::size_t from = begin_of(g), to = end_of(g);
    set_law(g);
    pass.motion(particles, from, to);
    pass.run(kernel, from, to);
    // Frozen energies are those at the start for every pair: only the end counts.
    if (pass.apply(particles, from, to) || how.energies == SweepEnergies::frozen) continue;
    // A later pair could lift an energy above zero again: a fault in passing is a fault.
    note_failed(pass, from, to, failed);
  }
}

void System::sweep_contacts(PairPass& pass, const BoundaryContacts::Group& group,
                            const PassParticles& particles, const PairKernel& kernel,
                            const Sweep& how, std::vector<std::uint32_t>& failed) {
  for_each_contact_run(pass, group, [&](PairPass&, std::size_t boundary, std::size_t count) {
    const auto id = BoundaryContacts::id(boundary);
    pass.draw_contact_normals(noise_, how.stage, id);
    if (how.uniforms) {
      pass.draw_contact_uniforms(noise_, how.stage, id);
    } else {
      pass.draw_no_uniforms();
    }
    pass.motion(particles, 0, count);
    pass.run(kernel, 0, count);
    if (pass.apply_contacts(particles, 0, count)) return;
    if (how.energies == SweepEnergies::frozen) return;
    note_failed(pass, 0, count, failed);
  });
}

bool System::take_motion(std::size_t begin, std::size_t end) {
  bool sound = true;
  for (std::size_t i = begin; i < end; ++i) {
    const Quadruple& motion = motion_[cells_.number(i)];
    state_.velocity[i] = Vector(motion.x, motion.y, motion.z);
    if (!fluid_.isothermal()) state_.internal_energy[i] = motion.energy;
    sound = sound & is_sound(i);
  }
  return sound;
}

void System::sweep(const PairKernel& kernel, const Sweep& how) {
  find_pairs();
  make_room(motion_);
  received_.assign(BoundaryContacts::numbers, {});
  PassParticles particles{motion_.data(), nullptr, nullptr, motion_.data(), received_.data()};
  const bool frozen_energies = how.energies == SweepEnergies::frozen;
  if (frozen_energies) {
    make_room(frozen_motion_);
    particles.energy = frozen_motion_.data();
  }
  const bool by_ids = how.sequence == SweepSequence::by_ids;
  const std::size_t all_at_once[] = {1};
  const auto colours = by_ids ? std::span<const std::size_t>(all_at_once) : pairs_.colours();
  // Particles, pairs colour by colour and then contacts, or the other way round, and particles
  // again.
  std::vector<std::size_t> tasks(1, threads_.count());
  tasks.insert(tasks.end(), colours.begin(), colours.end());
  tasks.insert(tasks.end(), contacts_.phases().begin(), contacts_.phases().end());
  const bool reverse = how.order == SweepOrder::reverse;
  if (reverse) std::reverse(tasks.begin() + 1, tasks.end());
  const std::size_t last = tasks.size();
  tasks.push_back(threads_.count());
  std::vector<std::vector<std::uint32_t>> failed(threads_.count());
  std::atomic<bool> sound = true;
  threads_.phases(tasks, [&](unsigned thread, std::size_t phase, std::size_t task) {
    PairPass& pass = passes_[thread];
    const std::size_t begin = size() * task / threads_.count(),
                      end = size() * (task + 1) / threads_.count();
    const std::size_t place = reverse ? last - 1 - phase : phase - 1;  // in forward order
    if (phase == 0) {
      gather_motion(state_, motion_, begin, end);
      if (frozen_energies) gather_motion(state_, frozen_motion_, begin, end);
    } else if (phase == last) {
      if (!take_motion(begin, end)) sound = false;
    } else if (place >= colours.size()) {
      sweep_contacts(pass, contacts_.group(place - colours.size(), task), particles, kernel, how,
                     failed[thread]);
    } else if (by_ids) {
      sweep_groups(pass, pairs_.by_ids(cells_), particles, kernel, how, failed[thread]);
    } else {
      const auto grouped = [&] {
        const PassClock clock(pass.part(&PassSeconds::search));
        return pairs_.group(pairs_.block(place, task), cells_);
      };
      sweep_groups(pass, grouped(), particles, kernel, how, failed[thread]);
    }
  });
  ++energies_version_;
  for (std::size_t number = 0; contacts_.any() && number < BoundaryContacts::numbers; ++number) {
    const auto& sum = received_[number];
    state_.surroundings[BoundaryContacts::boundary(number)] +=
        {Vector(sum.x, sum.y, sum.z), sum.energy};
  }
  count_visit(true, how.uniforms);
  for (std::size_t thread = 1; thread < failed.size(); ++thread) {
    failed[0].insert(failed[0].end(), failed[thread].begin(), failed[thread].end());
  }
  if (!failed[0].empty() || !sound) throw_failure(std::move(failed[0]));
}

void System::for_each_pair(FunctionReference<void(const Geometry&)> visit) {
  find_pairs();
  for (auto& block : pairs_.all()) {
    for_each_run(passes_[0], block,
                 [&](PairPass& pass, PairBlock&, std::size_t, std::size_t count) {
                   pass.geometry(0, count);
                   visit_pairs(pass, count, visit);
                 });
  }
}

void System::visit_pairs(const PairPass& pass, std::size_t count,
                         FunctionReference<void(const Geometry&)> visit) const {
  const PairArrays& pair = pass.arrays();
  for (std::size_t n = 0; n < count; ++n) {
    const bool has_direction = pair.e_x[n] != 0 || pair.e_y[n] != 0 || pair.e_z[n] != 0;
    if (pair.r[n] >= fluid_.range() || !has_direction) continue;
    visit({cells_.place(pass.i(n)), cells_.place(pass.j(n)),
           Vector(pair.e_x[n], pair.e_y[n], pair.e_z[n]), pair.r[n], pair.w_friction[n],
           pair.w_heat[n], pair.law});
  }
}

void System::apply(const Exchange& exchange, double share) {
  give_surroundings(exchange, share);
  if (fluid_.species() == 1) {
    const double per_mass = share / fluid_.mass();
    update([&](std::size_t i, Vector& velocity, double& internal_energy) {
      velocity += exchange.momentum[i] * per_mass;
      internal_energy += share * exchange.energy[i];
    });
    return;
  }
  update([&](std::size_t i, Vector& velocity, double& internal_energy) {
    velocity += exchange.momentum[i] * (share / mass(i));
    internal_energy += share * exchange.energy[i];
  });
}

void System::give_surroundings(const Exchange& exchange, double share) {
  for (std::size_t n = 0; n < surrounding_places; ++n) {
    const auto& received = exchange.surroundings[n];
    state_.surroundings[n] += {share * received.momentum, share * received.energy};
  }
}

void System::give_surroundings(double duration) {
  renew_conservative();
  for (std::size_t n = 0; n < surrounding_places; ++n) {
    state_.surroundings[n].momentum += duration * conservative_.surroundings[n].momentum;
  }
}

void System::set_motion(const Motion& motion) {
  state_.velocity = motion.velocity;
  state_.internal_energy = motion.internal_energy;
  state_.surroundings = motion.surroundings;
  drop_if_isothermal(state_.internal_energy);
  ++energies_version_;
  check();
}

void System::swap_motion(Motion& motion) {
  std::swap(static_cast<Motion&>(state_), motion);
  drop_if_isothermal(state_.internal_energy);
  ++energies_version_;
  check();
}

void System::check() const {
  std::atomic<bool> sound = true;
  for_each_particle([&](std::size_t begin, std::size_t end) {
    bool all = true;
    for (std::size_t i = begin; i < end; ++i) all = all & is_sound(i);
    if (!all) sound = false;
  });
  if (!sound) throw_failure();
}

void System::throw_failure(std::vector<std::uint32_t> in_passing) const {
  auto failed = std::move(in_passing);
  bool negative = !failed.empty();
  for (std::size_t i = 0; i < size(); ++i) {
    if (is_sound(i)) continue;
    failed.push_back(state_.id[i]);
    negative = negative || (!fluid_.isothermal() && state_.internal_energy[i] <= 0);
  }
  std::sort(failed.begin(), failed.end());
  failed.erase(std::unique(failed.begin(), failed.end()), failed.end());
  // An energy below zero makes the roots that follow it non-finite: it is the cause of both.
  throw StepFailure(negative ? FailureCause::negative_internal_energy : FailureCause::non_finite,
                    std::move(failed));
}

void System::kick(double duration) {
  if (!fluid_.has_repulsion()) return;
  const auto& force = conservative_force();
  give_surroundings(duration);
  const double factor = duration / fluid_.mass();
  const bool alike = fluid_.species() == 1;
  for_each_particle([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      state_.velocity[i] += (alike ? factor : duration / mass(i)) * force[i];
    }
  });
}

Vector System::reflect(Vector position, std::size_t place, Surroundings& received) {
  for (int axis = 0; axis < 3; ++axis) {
    const double length = box_.lengths[axis];
    if (!box_.is_walled(axis) || (position[axis] >= 0 && position[axis] <= length)) continue;
    const bool upper = position[axis] > length;
    position[axis] = upper ? 2 * length - position[axis] : -position[axis];
    double& velocity = state_.velocity[place][axis];
    received[static_cast<std::size_t>(2 * axis + (upper ? 1 : 0))].momentum[axis] +=
        2 * mass(place) * velocity;
    velocity = -velocity;
  }
  return position;
}

void System::move_along(const std::vector<Vector>& velocity, double duration) {
  if (frozen_) return;
  const auto factors = energy_factors();
  const bool walled = box_.is_walled(0) || box_.is_walled(1) || box_.is_walled(2);
  // Shares that do not depend on the threads: sums then do not either.
  constexpr std::size_t shares = 8;
  std::array<Surroundings, shares> received;
  std::atomic<bool> sound = true, inside = true;
  const std::size_t tasks[] = {shares};
  threads_.phases(tasks, [&](unsigned, std::size_t, std::size_t share) {
    bool all_sound = true, all_inside = true;
    for (std::size_t i = size() * share / shares; i < size() * (share + 1) / shares; ++i) {
      Vector moved = box_.wrap(state_.position[i] + duration * velocity[i]);
      if (walled) moved = reflect(moved, i, received[share]);
      const bool sound_here = is_sound(i), inside_here = box_.contains(moved);
      // Whoever looks at a failed state finds every particle in the box.
      if (sound_here & inside_here) state_.position[i] = moved;
      all_sound = all_sound & sound_here;
      all_inside = all_inside & inside_here;
    }
    if (!all_sound) sound = false;
    if (!all_inside) inside = false;
  });
  for (const auto& of_share : received) {
    for (std::size_t n = 0; n < surrounding_places; ++n) state_.surroundings[n] += of_share[n];
  }
  ++positions_version_;
  if (!sound) throw_failure();
  if (inside) {
    follow_factors(factors);
    return;
  }
  // So far beyond the box that rounding leaves no image inside, or through two walls at once.
  std::vector<std::uint32_t> lost;
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector moved = box_.wrap(state_.position[i] + duration * velocity[i]);
    if (!box_.contains(moved)) lost.push_back(state_.id[i]);
  }
  throw StepFailure(FailureCause::non_finite, std::move(lost));
}

void System::renew_conservative() {
  if (conservative_version_ == positions_version_) return;
  if (!fluid_.has_repulsion()) {
    conservative_.reset(size());
    conservative_version_ = positions_version_;
    return;
  }
  const auto repulsion = [&](const auto& pair) {
    const PairLaw& law = *pair.law;
    const auto potential = law.potential(pair.r);
    return Transfer{law.repulsive_force(pair.r), law.potential_share_i() * potential,
                    law.potential_share_j() * potential};
  };
  const PairKernel kernel = PairKernel::of(repulsion);
  const auto of_pairs = [&](PairPass& pass, PairBlock&, std::size_t, std::size_t count) {
    pass.geometry(0, count);
    pass.run(kernel, 0, count);
  };
  const auto at_boundary = [&](PairPass& pass, std::size_t, std::size_t count) {
    pass.run(kernel, 0, count);
  };
  const ContactAnswer contacts(at_boundary);
  sum(conservative_, of_pairs, nothing_to_prepare, &contacts);
  conservative_version_ = positions_version_;
  count_visit(false, false);
}

const std::vector<Vector>& System::conservative_force() {
  if (fluid_.repulsion_follows_temperatures()) {
    renew_thermal_force();
    return thermal_.momentum;
  }
  renew_conservative();
  return conservative_.momentum;
}

const std::vector<double>& System::potential_shares() {
  renew_conservative();
  return conservative_.energy;
}

double System::kinetic_energy() const {
  double sum = 0;
  if (fluid_.species() == 1) {
    for (const auto& velocity : state_.velocity) sum += velocity.squaredNorm();
    return 0.5 * fluid_.mass() * sum;
  }
  for (std::size_t i = 0; i < size(); ++i) sum += mass(i) * state_.velocity[i].squaredNorm();
  return 0.5 * sum;
}

double System::internal_energy() const {
  double sum = 0;
  for (const double u : state_.internal_energy) sum += u;
  return sum;
}

double System::potential_energy() {
  double sum = 0;
  for (const double share : potential_shares()) sum += share;
  return sum;
}

Vector System::momentum() const {
  Vector sum = Vector::Zero();
  for (std::size_t i = 0; i < size(); ++i) sum += mass(i) * state_.velocity[i];
  return sum;
}

void System::set_state(State state) {
  const bool as_many = state.size() == size();
  state_ = valid(box_, std::move(state));
  check_species();
  drop_if_isothermal(state_.internal_energy);
  ++positions_version_;
  if (!as_many) cut_cells();
}

}  // namespace driftless
