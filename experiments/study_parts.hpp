#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/location.hpp"
#include "experiments/study.hpp"

namespace driftless {

/// The parts of a study file, each with its reader and its schema. Every reader throws InputError.

/// A name, or {"name", "options"}.
MethodChoice read_method(const nlohmann::json& value, const Location& location);
/// "all", or a list of names, of {"name", "options"}, or of "all".
std::vector<MethodChoice> read_methods(const nlohmann::json& value, const Location& location);
nlohmann::json methods_schema();
nlohmann::json to_json(const MethodChoice& choice);
/// As on a command line: "groot-warren", or with options "groot-warren:lambda=0.5".
std::string to_string(const MethodChoice& choice);
/// Whether two choices run the same: options that are left out have their defaults.
bool same(const MethodChoice& one, const MethodChoice& other);

/// {"equilibrate", "measure", "sample_every"}: whole numbers of samples, neither few nor too many.
void read_duration(const nlohmann::json& value, const Location& location, Study& study);
nlohmann::json duration_schema();

/// A list, or {"from", "to", "count", "spacing"}, of steps that each divide the study's
/// sample_every; the inner steps of a ladder are moved to the nearest that does.
std::vector<double> read_time_steps(const nlohmann::json& value, const Location& location,
                                    const Study& study);
nlohmann::json time_steps_schema();

nlohmann::json scene_schema();

/// One key of a study. Reading, the nearest name to a mistyped one and the schema are made from the
/// table of these.
struct StudyKey {
  std::string_view name;
  bool required;
  std::string_view meaning;
  nlohmann::json (*schema)();
  void (*read)(const nlohmann::json& value, const Location& location, Study& study);
};

/// In the order in which they are read.
const std::vector<StudyKey>& study_keys();

}  // namespace driftless
