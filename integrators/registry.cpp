#include <algorithm>
#include <deque>
#include <exception>
#include <stdexcept>
#include <utility>

#include "integrators/methods.hpp"
#include "integrators/modules.hpp"

namespace driftless {
namespace {

struct Registry {
  std::vector<const Method*> all;
  std::deque<Method> from_outside;  // a deque keeps the addresses
  std::string complaint;            // of the first Registration that failed

  Registry() {
#define DRIFTLESS_LIST(name) all.push_back(&name);
    DRIFTLESS_METHODS(DRIFTLESS_LIST)
#undef DRIFTLESS_LIST
  }
};

Registry& registry() {
  static Registry instance;
  return instance;
}

const Method* find_registered(std::string_view name) {
  const auto& all = registry().all;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Method* m) { return m->name == name; });
  return found == all.end() ? nullptr : *found;
}

}  // namespace

const std::vector<const Method*>& methods() {
  load_methods_of_environment();
  return registry().all;
}

const Method* find_method(std::string_view name) {
  load_methods_of_environment();
  return find_registered(name);
}

void register_method(const Method& method) {
  if (method.name.empty() || method.make == nullptr) {
    throw std::invalid_argument("a method has no name, or nothing that makes it");
  }
  if (find_registered(method.name)) {
    throw std::invalid_argument("a method named " + std::string(method.name) + " exists already");
  }
  auto& all = registry();
  all.all.push_back(&all.from_outside.emplace_back(method));
}

// It runs while the loader starts a module, where nothing may be thrown.
Registration::Registration(const Method& method, std::size_t method_size,
                           std::size_t system_size) noexcept {
  try {
    // Of another size, the method must not even be read.
    if (method_size != sizeof(Method) || system_size != sizeof(System)) {
      throw std::invalid_argument("it was compiled with headers of another version of driftless");
    }
    register_method(method);
  } catch (const std::exception& error) {
    auto& complaint = registry().complaint;
    if (complaint.empty()) complaint = error.what();
  }
}

std::size_t detail::registered_methods() { return registry().all.size(); }

std::string detail::take_complaint() { return std::exchange(registry().complaint, {}); }

std::optional<std::string> refusal(const Method& method, const Fluid& fluid,
                                   const Options& options) {
  if (fluid.isothermal()) {
    if (method.isothermal) return std::nullopt;
    return std::string(method.name) +
           " is built for particles with internal energies, this scene is isothermal and has none";
  }
  const auto takes = method.runs_thermal_repulsion;
  if (fluid.repulsion_follows_temperatures() && (takes == nullptr || !takes(options))) {
    return std::string(method.name) + (takes == nullptr ? "" : " with these options") +
           " is built for a repulsion that depends on distances alone, that of this scene follows "
           "the temperatures";
  }
  const auto closure = fluid.parameters().friction_closure;
  const auto& built_for = method.closures;
  const auto suits = [&](FrictionClosure wanted) {
    return std::find(built_for.begin(), built_for.end(), wanted) != built_for.end();
  };
  if (fluid.has_friction() && suits(closure) && !suits(FrictionClosure::friction) &&
      fluid.friction_noise_follows_energies()) {
    return std::string(method.name) +
           " is built for friction whose noise does not follow the temperatures, that of this "
           "scene does";
  }
  if (!fluid.has_friction() || suits(closure)) return std::nullopt;
  std::string names;
  for (const auto known : built_for) {
    names += (names.empty() ? "" : " and ") + std::string(to_string(known));
  }
  return std::string(method.name) + " is built for the friction closure " + names +
         ", this scene has the closure " + std::string(to_string(closure));
}

bool is_consistent(const Method& method, const Options& options, const Fluid& fluid) {
  return method.consistent &&
         (method.stays_consistent == nullptr || method.stays_consistent(options, fluid));
}

std::string_view to_string(FrictionClosure closure) {
  return closure == FrictionClosure::noise ? "noise" : "friction";
}

std::string_view to_string(HeatForm form) {
  switch (form) {
    case HeatForm::none:
      return "none";
    case HeatForm::inverse_temperature:
      return "inverse-temperature";
    case HeatForm::temperature:
      return "temperature";
  }
  throw std::logic_error("unknown heat form");
}

}  // namespace driftless
