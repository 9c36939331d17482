#include "experiments/judge/examinations.hpp"

#include <fmt/format.h>

namespace driftless::judge {

const std::vector<const Examination*>& examinations() {
#define DRIFTLESS_ADDRESS(name) &name,
  static const std::vector<const Examination*> all = {DRIFTLESS_EXAMINATIONS(DRIFTLESS_ADDRESS)};
#undef DRIFTLESS_ADDRESS
  return all;
}

std::string to_string(Depth depth) { return depth == Depth::quick ? "quick" : "full"; }

std::string Candidate::name() const {
  std::string text = choice.name;
  const char* separator = ":";
  for (const auto& [option, value] : choice.options) {
    text += separator + option + "=";
    text += std::visit(
        [](const auto& given) {
          using Value = std::decay_t<decltype(given)>;
          if constexpr (std::is_same_v<Value, double>) return fmt::format("{:g}", given);
          return fmt::format("{}", given);
        },
        value);
    separator = ",";
  }
  return text;
}

}  // namespace driftless::judge
