#include "experiments/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <iterator>

#include "build_info.hpp"
#include "integrators/modules.hpp"
#include "model/instruction_set.hpp"

namespace driftless {
namespace {

std::string processor() {
  std::ifstream information("/proc/cpuinfo");
  for (std::string line; std::getline(information, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

std::string version() {
  std::string text = build_info::version;
  if (*build_info::commit) {
    text += fmt::format("+{:.7}{}", build_info::commit, build_info::dirty ? "-dirty" : "");
  }
  return text;
}

nlohmann::json provenance(unsigned threads, std::uint64_t seed, const std::string& command) {
  return {{"version", build_info::version},
          {"commit", build_info::commit},
          {"dirty", build_info::dirty},
          {"compiler", build_info::compiler},
          {"flags", build_info::flags},
          {"cpu", processor()},
          {"instructions", instruction_set()},
          {"threads", threads},
          {"seed", seed},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"command", command}};
}

std::string fingerprint(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const unsigned char byte : text) hash = (hash ^ byte) * 0x100000001b3ULL;
  return fmt::format("{:016x}", hash);
}

std::string program_fingerprint() {
  static const std::string value = [] {
    auto files = code_files();
    files.emplace_back("/proc/self/exe");
    std::string fingerprints;
    for (const auto& file : files) {
      std::ifstream code(file, std::ios::binary);
      fingerprints += fingerprint({std::istreambuf_iterator<char>(code), {}});
    }
    return fingerprint(fingerprints);
  }();
  return value;
}

}  // namespace driftless
