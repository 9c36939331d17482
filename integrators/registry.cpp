#include <algorithm>
#include <deque>
#include <stdexcept>

#include "integrators/methods.hpp"

namespace driftless {
namespace {

struct Registry {
  std::vector<const Method*> all;
  std::deque<Method> from_outside;  // a deque keeps the addresses

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

}  // namespace

const std::vector<const Method*>& methods() { return registry().all; }

const Method* find_method(std::string_view name) {
  const auto& all = methods();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Method* m) { return m->name == name; });
  return found == all.end() ? nullptr : *found;
}

void register_method(const Method& method) {
  if (find_method(method.name)) {
    throw std::invalid_argument("a method named " + std::string(method.name) + " exists already");
  }
  auto& all = registry();
  all.all.push_back(&all.from_outside.emplace_back(method));
}

std::optional<std::string> refusal(const Method& method, const Fluid& fluid) {
  const auto closure = fluid.parameters().friction_closure;
  const auto& built_for = method.closures;
  const bool suited = std::find(built_for.begin(), built_for.end(), closure) != built_for.end();
  if (!fluid.has_friction() || suited) return std::nullopt;
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
