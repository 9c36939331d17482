#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace driftless {

/// "0.1.0", "0.1.0+3f2c1d8" or "0.1.0+3f2c1d8-dirty".
std::string version();

/// Version, commit, compiler, flags, processor, the instructions used of it, threads, seed, date
/// (UTC) and the command that repeats the run.
nlohmann::json provenance(unsigned threads, std::uint64_t seed, const std::string& command);

/// A number that changes whenever the code does, be it this program, the library as chosen for this
/// processor, or a module of methods: results of other code are not reused.
std::string program_fingerprint();

/// 64 bits of a text as 16 hexadecimal digits (FNV-1a).
std::string fingerprint(const std::string& text);

}  // namespace driftless
