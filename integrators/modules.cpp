#include "integrators/modules.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <string_view>

namespace driftless {
namespace {

namespace fs = std::filesystem;

struct Module {
  void* handle;
  fs::path path;
};

/// The modules loaded, and the lock of those who load: a module that asks for methods while it is
/// loaded comes here again.
struct Modules {
  std::recursive_mutex mutex;
  std::vector<Module> all;
  bool environment_read = false;
};

Modules& modules() {
  static Modules instance;
  return instance;
}

void throw_complaint(const std::string& whose) {
  if (const auto complaint = detail::take_complaint(); !complaint.empty()) {
    throw ModuleError("a method of " + whose + " is refused: " + complaint);
  }
}

/// The loader's reason, without the path that it may begin with.
std::string reason_of_loader(const fs::path& path) {
  const std::string reason = dlerror();
  const auto prefix = path.string() + ": ";
  return reason.starts_with(prefix) ? reason.substr(prefix.size()) : reason;
}

}  // namespace

void load_methods(const fs::path& module) {
  load_methods_of_environment();
  auto& loaded = modules();
  const std::lock_guard lock(loaded.mutex);
  // A name without a slash would be looked for among the system's libraries.
  const auto path = fs::absolute(module).lexically_normal();
  const auto before = detail::registered_methods();
  // Never closed: names and functions of the methods live there.
  void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    throw ModuleError(path.string() + " cannot be loaded: " + reason_of_loader(path));
  }
  const auto known = [&](const Module& other) { return other.handle == handle; };
  if (std::any_of(loaded.all.begin(), loaded.all.end(), known)) return;
  throw_complaint(path.string());
  if (detail::registered_methods() == before) {
    throw ModuleError(path.string() + " registers no method");
  }
  loaded.all.push_back({handle, path});
}

void load_methods_of_environment() {
  auto& loaded = modules();
  const std::lock_guard lock(loaded.mutex);
  if (loaded.environment_read) return;
  loaded.environment_read = true;
  const char* const value = std::getenv("DRIFTLESS_METHODS");
  std::string_view rest = value == nullptr ? "" : value;
  try {
    throw_complaint("this program");
    while (!rest.empty()) {
      const auto end = std::min(rest.find(':'), rest.size());
      if (end > 0) load_methods(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  } catch (...) {
    loaded.environment_read = false;  // who asks again is told again
    throw;
  }
}

std::vector<fs::path> loaded_modules() {
  auto& loaded = modules();
  const std::lock_guard lock(loaded.mutex);
  std::vector<fs::path> paths;
  for (const auto& module : loaded.all) paths.push_back(module.path);
  return paths;
}

std::vector<fs::path> code_files() {
  load_methods_of_environment();
  auto files = loaded_modules();
  // Of an address in this file: one that a program sees could be the program's own.
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&modules), &library) != 0) {
    files.insert(files.begin(), fs::absolute(library.dli_fname));
  }
  return files;
}

}  // namespace driftless
