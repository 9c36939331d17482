#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

/// Methods compiled outside of this library, in shared objects that register them (Registration of
/// integrator.hpp) while they are loaded.
namespace driftless {

/// A module that cannot be loaded, registers nothing, or a method that is refused: one sentence.
class ModuleError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Loads a module's methods; one that is loaded already changes nothing. Throws ModuleError.
void load_methods(const std::filesystem::path& module);

/// Loads, once, the modules that the environment variable DRIFTLESS_METHODS names, colons between
/// them. Throws ModuleError.
void load_methods_of_environment();

/// The modules loaded so far, by absolute paths.
std::vector<std::filesystem::path> loaded_modules();

/// The files whose code steps a system: this library as the loader chose it, then the modules.
std::vector<std::filesystem::path> code_files();

namespace detail {

/// What the registry tells of its own state while modules are loaded.
std::size_t registered_methods();
/// What went wrong in Registrations since the last call; empty if nothing did.
std::string take_complaint();

}  // namespace detail
}  // namespace driftless
