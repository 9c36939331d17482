#include "model/system.hpp"

#include <algorithm>
#include <atomic>

// How a system has its pairs exchange one after the other.
namespace driftless {

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

}  // namespace driftless
