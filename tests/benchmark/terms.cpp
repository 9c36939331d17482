// What each term of the model costs: nanoseconds per pair of a step of averaged-drift for every
// choice of repulsion, friction and conduction, with internal energies or isothermal, on 3000
// particles at the density 3. All ranges are alike, so that every choice sees the same pairs, and a
// term that is absent can only save.
//
// "moving" is the whole step, pair search included; "frozen" particles keep their pairs, and what
// is left are noise, arithmetic and sums. Medians of interleaved rounds, so that a machine that
// drifts favours no choice.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "integrators/integrator.hpp"
#include "model/initial.hpp"

namespace driftless {
namespace {

constexpr std::size_t particles = 3000;
constexpr double density = 3;
constexpr double time_step = 1e-3;
constexpr int rounds = 15;
constexpr int steps_per_round = 10;

/// A system that is stepped and timed.
struct Runner {
  System system;
  std::unique_ptr<Integrator> integrator = find_method("averaged-drift")->make({});
  std::vector<double> seconds = {};
  std::uint64_t step = 0;

  void warm_up() {
    advance();
    seconds.clear();
  }

  void advance() {
    const auto start = std::chrono::steady_clock::now();
    for (int n = 0; n < steps_per_round; ++n) {
      system.set_step(++step);
      integrator->step(system, time_step);
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    seconds.push_back(elapsed.count() / steps_per_round);
  }

  double median_seconds() {
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
  }
  double pairs() const { return per_step(system.counters().pair_evaluations); }
  double numbers() const { return per_step(system.counters().random_numbers); }
  double per_step(std::uint64_t count) const {
    return static_cast<double>(count) / static_cast<double>(step);
  }
};

/// One choice of terms; `friction` is null for none. An isothermal fluid has no conduction, and its
/// closures are one.
struct Choice {
  bool isothermal;
  bool repulsion;
  const FrictionClosure* friction;
  HeatForm heat;

  FluidParameters parameters() const {
    FluidParameters f;
    f.isothermal = isothermal;
    if (!isothermal) f.heat_capacity = 60;
    f.repulsion = repulsion ? 25 : 0;
    f.friction = friction ? 4.5 : 0;
    if (friction) f.friction_closure = *friction;
    f.heat_form = heat;
    f.conduction = heat == HeatForm::none ? 0 : 1;
    return f;
  }
};

std::vector<Choice> all_choices() {
  static constexpr FrictionClosure noise = FrictionClosure::noise;
  static constexpr FrictionClosure friction = FrictionClosure::friction;
  std::vector<Choice> all;
  for (const bool repulsion : {false, true}) {
    for (const auto* closure : {static_cast<const FrictionClosure*>(nullptr), &noise, &friction}) {
      for (const auto heat :
           {HeatForm::none, HeatForm::inverse_temperature, HeatForm::temperature}) {
        all.push_back({false, repulsion, closure, heat});
      }
    }
  }
  for (const bool repulsion : {false, true}) {
    all.push_back({true, repulsion, nullptr, HeatForm::none});
    all.push_back({true, repulsion, &noise, HeatForm::none});
  }
  return all;
}

Runner make_runner(const Choice& choice, bool frozen) {
  const Fluid fluid(choice.parameters());
  const Noise noise(1, 0);
  const Box box = make_box(fluid, Layout::fluid, particles, density, 0);
  State state = place(box, Layout::fluid, Placement::random, particles, 0, noise);
  if (choice.isothermal) {
    draw_canonical(fluid, Layout::fluid, 1, noise, state);
  } else {
    const auto law = microcanonical_law(fluid, Layout::fluid, particles);
    draw_microcanonical(fluid, Layout::fluid, law.energy_at(1), noise, state);
  }
  return {System(fluid, box, std::move(state), noise, frozen)};
}

void print_row(const Choice& choice, Runner& moving, Runner& frozen) {
  const double pairs = moving.pairs();
  std::printf("%-10s  %-9s  %-8s  %-19s  %9.0f  %8.2f  %9.1f",
              choice.isothermal ? "isothermal" : "own", choice.repulsion ? "yes" : "none",
              choice.friction ? std::string(to_string(*choice.friction)).c_str() : "none",
              std::string(to_string(choice.heat)).c_str(), pairs,
              pairs > 0 ? moving.numbers() / pairs : 0.0, 1e6 * moving.median_seconds());
  if (pairs > 0) {
    std::printf("  %9.1f  %9.1f\n", 1e9 * moving.median_seconds() / pairs,
                1e9 * frozen.median_seconds() / frozen.pairs());
  } else {
    std::printf("  %9s  %9s\n", "-", "-");
  }
}

void run() {
  const auto choices = all_choices();
  std::vector<Runner> moving, frozen;
  for (const auto& choice : choices) {
    moving.push_back(make_runner(choice, false));
    frozen.push_back(make_runner(choice, true));
  }
  for (std::size_t n = 0; n < choices.size(); ++n) moving[n].warm_up(), frozen[n].warm_up();
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t n = 0; n < choices.size(); ++n) moving[n].advance(), frozen[n].advance();
  }
  std::printf("averaged-drift, %zu particles at density %g, one thread\n\n", particles, density);
  std::printf("%-10s  %-9s  %-8s  %-19s  %9s  %8s  %9s  %9s  %9s\n", "energies", "repulsion",
              "friction", "conduction", "pairs", "numbers", "us", "ns a pair", "ns a pair");
  std::printf("%-10s  %-9s  %-8s  %-19s  %9s  %8s  %9s  %9s  %9s\n", "", "", "", "", "a step",
              "a pair", "a step", "moving", "frozen");
  for (std::size_t n = 0; n < choices.size(); ++n) print_row(choices[n], moving[n], frozen[n]);
}

}  // namespace
}  // namespace driftless

int main() {
  driftless::run();
  return 0;
}
