#include "experiments/study_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/cell.hpp"

namespace driftless {
namespace {

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t n = 0; n < words.size(); ++n) {
    text += (n == 0 ? "" : n + 1 < words.size() ? ", " : " and ") + words[n];
  }
  return text;
}

/// A sentence of several scenes, "{}" in it standing for them.
class Sentences {
 public:
  void add(const std::string& scene, const std::string& text) {
    const auto same = [&](const auto& entry) { return entry.text == text; };
    auto known = std::find_if(all_.begin(), all_.end(), same);
    if (known == all_.end()) known = all_.insert(all_.end(), {text, {}});
    known->scenes.push_back(scene);
  }
  void append_to(std::vector<std::string>& result) const {
    for (const auto& [text, scenes] : all_) {
      auto names = scenes;
      if (names.size() > 3) {
        names = {names[0], names[1], fmt::format("{} more scenes", names.size() - 2)};
      }
      std::string sentence = text;
      result.push_back(sentence.replace(sentence.find("{}"), 2, listed(names)));
    }
  }

 private:
  struct Entry {
    std::string text;
    std::vector<std::string> scenes;
  };
  std::vector<Entry> all_;
};

/// What a study does not resolve in a scene; empty if it resolves what there is.
std::string too_short(const Study& study, const Scene& scene) {
  std::vector<std::string> parts;
  double longest = 0;
  const auto add = [&](const char* energies, double time) {
    // What never relaxes has no law that it could be compared with.
    if (!std::isfinite(time) || resolves(study, time)) return;
    parts.push_back(fmt::format("{} energies relax in about {:.3g}", energies, time));
    longest = std::max(longest, time);
  };
  if (!scene.fluid.isothermal) add("internal", relaxation_time(scene));
  add("kinetic", kinetic_relaxation_time(scene));
  if (parts.empty()) return "";
  return fmt::format(
      "duration is too short to resolve in {{}} what depends on them: {}, which takes equilibrate "
      "{:.3g} and measure {:.3g}",
      listed(parts), 5 * longest, 20 * longest);
}

/// The methods of a study that do not apply to a scene, each once, and why the first does not.
struct Refused {
  std::vector<std::string> methods;
  std::string reason;
  bool all = true;
};

Refused refused_by(const Study& study, const Scene& scene) {
  Refused refused;
  const Fluid fluid(scene.fluid);
  for (const auto& choice : study.methods) {
    const auto reason = refusal(*find_method(choice.name), fluid, choice.options);
    if (!reason) {
      refused.all = false;
      continue;
    }
    if (refused.methods.empty()) refused.reason = *reason;
    if (std::find(refused.methods.begin(), refused.methods.end(), choice.name) ==
        refused.methods.end()) {
      refused.methods.push_back(choice.name);
    }
  }
  return refused;
}

}  // namespace

std::vector<std::string> study_warnings(const Study& study, const std::string& source) {
  Sentences not_applying, short_ones;
  bool any_applies = false;
  std::string reason;
  for (const auto& scene : study.scenes) {
    const auto refused = refused_by(study, scene);
    any_applies = any_applies || !refused.all;
    if (!refused.methods.empty()) {
      reason = refused.reason;
      not_applying.add(scene.name, fmt::format("{} {} not apply to {{}}", listed(refused.methods),
                                               refused.methods.size() == 1 ? "does" : "do"));
    }
    if (!(scene.fluid.boltzmann > 0)) continue;  // nothing fluctuates, nothing is to be resolved
    if (const auto text = too_short(study, scene); !text.empty()) short_ones.add(scene.name, text);
  }
  if (!any_applies) {
    throw InputError(
        fmt::format("{}: no method of the study applies to any of its scenes: {}", source, reason));
  }
  std::vector<std::string> warnings;
  not_applying.append_to(warnings);
  short_ones.append_to(warnings);
  return warnings;
}

}  // namespace driftless
