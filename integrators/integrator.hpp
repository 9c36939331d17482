#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/system.hpp"

namespace driftless {

/// Value of a method's option, as written in a study.
using OptionValue = std::variant<bool, double, std::string>;
using Options = std::map<std::string, OptionValue>;

/// An option that a method declares: its default tells the type.
struct OptionSpec {
  std::string_view name;
  OptionValue fallback;
  std::string_view meaning;
};

/// Steps a system through time. Forces, heat, noise and pairs come from the System; what is here is
/// the scheme alone.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// One step of size dt >= 0. Throws StepFailure; the system is then left as it was found failing.
  virtual void step(System& system, double dt) = 0;

  /// What the scheme keeps between steps, for a checkpoint; empty if nothing.
  virtual std::vector<double> save() const { return {}; }
  virtual void load(const std::vector<double>& /*saved*/) {}

  /// Whether the order of storage may change between steps: where nothing is kept, or where what is
  /// kept comes along by follow_storage().
  virtual bool may_reorder_storage() const { return save().empty(); }
  virtual void follow_storage(const Places& /*places*/) {}
};

/// Names the step that the integrator is about to do. From time to time it orders the storage of a
/// large system (System::order_storage), where the integrator lets it: whoever else keeps something
/// of particles from step to step keeps it by ids.
void begin_step(System& system, Integrator& integrator, std::uint64_t step);

/// What a method promises of total energy, per step and in the mean; the suites hold it to it.
enum class EnergyClaim { exact, drifts };

/// A method and what it claims. Claims may be `false`: the suites check those too.
struct Method {
  std::string_view name;       ///< as in studies and results
  std::string_view title;      ///< for people
  std::string_view reference;  ///< paper and equations
  std::string_view conserves;  ///< in words
  int weak_order = 1;          ///< of stationary averages of the ideal system
  int noise_free_order = 1;    ///< towards the deterministic limit, without a potential
  EnergyClaim energy_ideal = EnergyClaim::drifts;           ///< without a potential
  EnergyClaim energy_with_potential = EnergyClaim::drifts;  ///< with one
  bool consistent = true;         ///< its limit of vanishing step is the model of theory
  bool galilean = true;           ///< a uniform velocity changes nothing
  bool order_independent = true;  ///< no order of pairs enters
  /// With the default options the exact law of an isolated pair is left as it is by every step,
  /// however large.
  bool pair_law_exact = false;
  /// Runs isothermal fluids too, as isothermal DPD has the method: the scheme without what it does
  /// to internal energies.
  bool isothermal = false;
  /// In an isothermal fluid Maxwell's law of an isolated pair is left as it is by every step for
  /// which zeta dt < 2 mu, with any options.
  bool isothermal_pair_law_exact = false;
  /// Whether with these options it runs fluids whose repulsion follows the temperatures: it takes
  /// conservative forces by System::kick and System::move alone; null: with none.
  bool (*runs_thermal_repulsion)(const Options&) = nullptr;
  /// Whether options leave it consistent in a fluid, where that depends on them; null: they do.
  bool (*stays_consistent)(const Options&, const Fluid&) = nullptr;
  std::vector<FrictionClosure> closures = {};
  std::vector<OptionSpec> options = {};
  std::unique_ptr<Integrator> (*make)(const Options&) = nullptr;
};

/// Every registered method, in the order of methods.hpp, then of register_method calls. The first
/// use loads the modules that the environment names; throws ModuleError (modules.hpp).
const std::vector<const Method*>& methods();
/// The method of a name, or nullptr. Loads and throws as methods() does.
const Method* find_method(std::string_view name);
/// Adds a copy of a method from outside the library; throws std::invalid_argument if the name is
/// taken, or if there is no name or nothing that makes it.
void register_method(const Method& method);

/// Registers a method while its module is loaded: `const Registration registered(my_method);`
/// behind the method in its file. What is wrong is told when the module has been loaded.
class Registration {
 public:
  explicit Registration(const Method& method) noexcept
      : Registration(method, sizeof(Method), sizeof(System)) {}

 private:
  /// The sizes as the method's file knows them: others than the library's are of other headers.
  Registration(const Method& method, std::size_t method_size, std::size_t system_size) noexcept;
};

/// Of methods for which that does not depend on options.
inline bool with_any_options(const Options& /*options*/) { return true; }

/// Why the method with these options cannot run the fluid, in one sentence; nothing if it can.
std::optional<std::string> refusal(const Method& method, const Fluid& fluid,
                                   const Options& options = {});

/// Whether the limit of a method with these options in this fluid is the model.
bool is_consistent(const Method& method, const Options& options, const Fluid& fluid);

/// The value of an option, or its default. T is bool, double or std::string.
template <class T>
T option(const Method& method, const Options& options, std::string_view name) {
  if (const auto given = options.find(std::string(name)); given != options.end()) {
    return std::get<T>(given->second);
  }
  for (const auto& spec : method.options) {
    if (spec.name == name) return std::get<T>(spec.fallback);
  }
  throw std::logic_error("a method asked for an option that it does not declare");
}

/// "noise" or "friction"; "none", "inverse-temperature" or "temperature".
std::string_view to_string(FrictionClosure closure);
std::string_view to_string(HeatForm form);

}  // namespace driftless
