#include "experiments/judge/judge.hpp"
#include "experiments/nearest.hpp"
#include "experiments/study_parts.hpp"

namespace driftless::judge {
namespace {

using nlohmann::json;

/// "0.5" and "true" are what they look like, all else is a word.
json option_value(const std::string& text) {
  const auto value = json::parse(text, nullptr, false);
  return value.is_number() || value.is_boolean() ? value : json(text);
}

/// A method as a study would hold it.
json as_in_study(const std::string& text) {
  const auto colon = text.find(':');
  if (colon == std::string::npos) return text;
  json options = json::object();
  for (std::size_t begin = colon + 1; begin <= text.size();) {
    const auto end = std::min(text.find(',', begin), text.size());
    const auto equals = text.find('=', begin);
    if (equals >= end) {
      throw InputError("\"" + text + "\": \"" + text.substr(begin, end - begin) +
                       "\" is no option; allowed is NAME:option=value,option=value");
    }
    options[text.substr(begin, equals - begin)] =
        option_value(text.substr(equals + 1, end - equals - 1));
    begin = end + 1;
  }
  return {{"name", text.substr(0, colon)}, {"options", options}};
}

}  // namespace

std::vector<Candidate> read_candidates(const std::vector<std::string>& texts) {
  json list = json::array();
  for (const auto& text : texts) list.push_back(as_in_study(text));
  std::vector<Candidate> candidates;
  for (const auto& choice : read_methods(list, Location("command line", "METHOD"))) {
    candidates.push_back({choice});
  }
  return candidates;
}

MethodChoice read_method_option(const std::string& text) {
  return read_method(as_in_study(text), Location("command line", "--method"));
}

std::vector<const Examination*> read_examinations(const std::vector<std::string>& names) {
  if (names.empty()) return examinations();
  std::vector<std::string> known;
  for (const auto* examination : examinations()) known.emplace_back(examination->name);
  std::vector<const Examination*> chosen;
  for (const auto& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw InputError("--examination: \"" + printable(name) + "\" is no examination" +
                       suggestion(name, known));
    }
    chosen.push_back(examinations()[static_cast<std::size_t>(found - known.begin())]);
  }
  return chosen;
}

}  // namespace driftless::judge
