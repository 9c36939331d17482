#include "experiments/judge/balance.hpp"

#include <fmt/format.h>

#include "experiments/judge/balance_runs.hpp"
#include "experiments/judge/examinations.hpp"

namespace driftless::judge {
namespace {

constexpr double phi_over_k = 10;
constexpr double mass_ratio = 4;  ///< of isothermal pairs of two species

/// Copies or replicas and the seconds that the smallest step takes.
struct Share {
  std::size_t count;
  double seconds;
};

struct Sizes {
  Share entropy, pairs, fluid;
};

Sizes sizes(Depth depth) {
  if (depth == Depth::quick) return {{100000, 3}, {16000, 8}, {600, 4}};
  return {{500000, 15}, {64000, 32}, {3000, 20}};
}

std::vector<Part> parts(const Candidate& candidate, const Conditions& conditions) {
  const Sizes size = sizes(conditions.depth);
  std::vector<Part> all;
  const auto add = [&](std::string name, double seconds, auto run) {
    const std::uint64_t seed = 1000 * conditions.seed + all.size();
    all.push_back({std::move(name), seconds, [run, seed] { return run(seed); }});
  };
  for (const auto& asked : pair_cases(candidate)) {
    for (const double step : asked.relaxes ? entropy_steps() : std::vector<double>()) {
      add(entropy_part(asked, step), size.entropy.seconds * entropy_steps().front() / step,
          [=, count = size.entropy.count](std::uint64_t seed) {
            return run_entropy_course(candidate, asked.bench, step, count, seed);
          });
    }
    // The moments are of shares of the energy, which isothermal pairs do not keep.
    for (const double step : is_reversed(asked) ? pair_steps() : std::vector<double>()) {
      add(reversal_part(asked.name, step), size.pairs.seconds * pair_steps().back() / step,
          [=, count = size.pairs.count](std::uint64_t seed) {
            return run_pair_reversal(candidate, asked.bench, step, count, seed);
          });
    }
  }
  for (const auto& asked : fluid_cases(candidate)) {
    for (const double step : fluid_steps()) {
      add(reversal_part(asked.name, step), size.fluid.seconds * fluid_steps().back() / step,
          [=, count = size.fluid.count](std::uint64_t seed) {
            return run_fluid_reversal(candidate, asked.fluid, step, count, seed);
          });
    }
  }
  return all;
}

Conclusion conclude(const Candidate& candidate, const Conditions&, const Records& records) {
  if (pair_cases(candidate).empty()) {
    return {{{.subject = "balance",
              .verdict = Verdict::not_applicable,
              .sentence = fmt::format("{} is built for no closure of the friction of fluids that "
                                      "keep energy.",
                                      candidate.method().name)}}};
  }
  Conclusion conclusion;
  conclude_entropy(candidate, records, conclusion);
  conclude_reversal(candidate, records, conclusion);
  return conclusion;
}

}  // namespace

std::vector<PairCase> pair_cases(const Candidate& candidate) {
  std::vector<PairCase> cases;
  for (const auto closure : candidate.method().closures) {
    for (const double conduction : {1.0, 0.0}) {
      if (conduction == 0 && candidate.method().energy_ideal != EnergyClaim::exact) continue;
      const auto bench =
          two_body::make_bench(phi_over_k, closure, HeatForm::inverse_temperature, conduction);
      if (refusal(candidate.method(), bench.fluid)) continue;
      cases.push_back({fmt::format("pairs with {}, closure {}",
                                   conduction > 0 ? "friction and conduction" : "friction alone",
                                   to_string(closure)),
                       bench, conduction > 0});
    }
  }
  const auto isothermal = two_body::make_isothermal_bench();
  if (!refusal(candidate.method(), isothermal.fluid)) {
    cases.push_back({"isothermal pairs", isothermal, true});
    cases.push_back(
        {"isothermal pairs of two species", two_body::make_isothermal_bench(mass_ratio), true});
  }
  return cases;
}

bool is_reversed(const PairCase& asked) { return !asked.bench.fluid.isothermal(); }

std::vector<FluidCase> fluid_cases(const Candidate& candidate) {
  auto pairs = pair_cases(candidate);
  std::erase_if(pairs, [](const PairCase& asked) { return !is_reversed(asked); });
  if (pairs.empty()) return {};
  FluidParameters fluid;
  fluid.heat_capacity = phi_over_k;
  fluid.friction = 4.5;
  fluid.friction_closure = pairs.back().bench.fluid.parameters().friction_closure;
  fluid.heat_form = HeatForm::inverse_temperature;
  fluid.conduction = phi_over_k;
  return {
      {fmt::format("fluid of 32 particles, closure {}", to_string(fluid.friction_closure)), fluid}};
}

const std::vector<double>& entropy_steps() {
  static const std::vector<double> steps = {0.1, 0.2, 0.4, 0.8};
  return steps;
}

const std::vector<double>& pair_steps() {
  static const std::vector<double> steps = {0.4, 0.2, 0.1, 0.05};
  return steps;
}

const std::vector<double>& fluid_steps() {
  static const std::vector<double> steps = {0.1, 0.05, 0.025};
  return steps;
}

std::string entropy_part(const PairCase& asked, double step) {
  const char* quantity = asked.bench.fluid.isothermal() ? "free energy" : "entropy";
  return fmt::format("{} of {}, step {}", quantity, asked.name, step);
}

std::string reversal_part(const std::string& case_name, double step) {
  return fmt::format("reversal of {}, step {}", case_name, step);
}

const Examination balance{
    .name = "balance",
    .title = "Detailed balance and the H-theorem",
    .question =
        "Does the entropy S[P](t) of an ensemble only rise [Marsh and Coveney 1998, 31, 32], and "
        "does the stationary motion look alike forwards and backwards in time? Isolated frozen "
        "pairs with phi/k = 10 start in a narrow smooth cloud far from equilibrium, with several "
        "times its kinetic energy; S[P] is followed for 8 relaxation times of the relative "
        "velocity by a histogram of the energy's shares against the exact law, bins being a third "
        "of that law's width, at 1, 2, 4 and 8 times a step of a tenth of the relaxation time. The "
        "bins are narrower than the cloud, so that what is lost between them is a few per cent of "
        "the changes: a chain that keeps the exact law can show no fall, and a fall beyond the "
        "noise - counted for all pairs of times - says that the method leads away from the exact "
        "law. Of isothermal pairs, of one species and of two with the mass ratio 4, the functional "
        "F[P] = <H> + k T <ln P> [7, 8] may only fall, by the same histogram of the velocity "
        "alone. In the stationary state <f(t) g(t + tau)> is "
        "compared with its reversed twin for "
        "moments f, g of pairs and of the particles of a small ideal fluid, by Hotelling's T^2 "
        "over "
        "all moments, which takes their correlation into account, and transitions of pairs "
        "between 16 bins are counted both ways. Energies are shares of the present energy, also "
        "where that drifts; friction alone is asked of methods that keep it, because without "
        "conduction the shares of a drifting energy have no stationary law. No method claims "
        "detailed balance at finite steps: there a violation "
        "is reported; it has to vanish with the step.",
    .parts = parts,
    .conclude = conclude};

}  // namespace driftless::judge
