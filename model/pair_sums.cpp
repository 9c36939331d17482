#include "model/system.hpp"

#include <algorithm>

// How a system finds its pairs, visits them, and sums what they exchange.
namespace driftless {
namespace {

/// The other side of a contact is at rest, and no exchange exhausts it.
constexpr Quadruple boundary_motion{0, 0, 0, 1e300};

}  // namespace

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

void System::gather_trial(const TrialEnd& trial, std::size_t begin, std::size_t end) {
  if (trial.motion) return gather_motion(*trial.motion, trial_, begin, end);
  const bool isothermal = fluid_.isothermal();
  for (std::size_t n = begin; n < end; ++n) {
    const std::size_t place = cells_.place(n);
    const Vector v = state_.velocity[place] + trial.change->momentum[place] * (1 / mass(place));
    const double u = state_.internal_energy[place] + trial.change->energy[place];
    trial_[n] = {v[0], v[1], v[2], isothermal ? fluid_.bath_energy() : u};
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

void System::accumulate(const PairKernel& kernel, const TrialEnd& trial, Exchange& total,
                        Stage stage, Rounds rounds) {
  const bool again = rounds == Rounds::several, has_trial = trial.motion || trial.change;
  if (again) find_pairs();  // what is kept is of these
  make_room(motion_);
  if (has_trial) make_room(trial_);
  const auto gather = [&](std::size_t begin, std::size_t end) {
    gather_motion(state_, motion_, begin, end);
    if (has_trial) gather_trial(trial, begin, end);
  };
  const PassParticles particles{motion_.data(), trial_.data(), nullptr, nullptr};
  const bool kept = again && is_kept(stage);
  const auto visit = [&](PairPass& pass, PairBlock& block, std::size_t first, std::size_t count) {
    if (again) work_in_kept(pass, block, first, stage);
    if (!kept || !keeps_geometry()) pass.geometry(0, count);
    if (!kept) pass.draw_normals(noise_, stage);
    pass.draw_no_uniforms();
    pass.motion(particles, 0, count);
    if (has_trial) pass.trial(particles);
    pass.run(kernel, 0, count);
  };
  const auto at_boundary = [&](PairPass& pass, std::size_t boundary, std::size_t count) {
    pass.draw_contact_normals(noise_, stage, BoundaryContacts::id(boundary));
    pass.draw_no_uniforms();
    pass.motion(particles, 0, count);
    if (has_trial) pass.trial(particles);
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

void System::forget_sums() {
  sums_.assign(size() + BoundaryContacts::numbers, {});
  for (auto& block : pairs_.all()) block.kept.clear();
  summing_ = false;
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

}  // namespace driftless
