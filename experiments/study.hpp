#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/scene.hpp"
#include "integrators/integrator.hpp"

namespace driftless {

/// One method of a study with its options as given.
struct MethodChoice {
  std::string name;
  Options options;
};

/// Scenes x methods x time steps x replicas. Durations in simulated time, so that every step covers
/// the same physics.
struct Study {
  std::string name;
  std::vector<Scene> scenes;
  std::vector<MethodChoice> methods;
  std::vector<double> time_steps;
  double equilibrate = 0;
  double measure = 0;
  double sample_every = 0;
  unsigned replicas = 2;
  std::uint64_t seed = 1;
};

/// A fault of the input or of the place to write to: one sentence for the user, exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads and checks a study file (JSON with comments). Throws InputError naming file, path in the
/// file, value, allowed range and, for a mistyped name, the nearest right one.
Study read_study(const std::string& path);
/// The same from text; `source` stands for the file's name in messages.
Study parse_study(const std::string& text, const std::string& source);

/// Steps of a time step between two samples: a whole number in every study that was read.
std::uint64_t steps_per_sample(const Study& study, double time_step);

/// The study with every default and preset written out; reading it again gives the same study.
nlohmann::json to_json(const Study& study);
/// A scene's every key, as an override of its preset would be written.
nlohmann::json to_json(const Scene& scene);
nlohmann::json to_json(const Options& options);

/// JSON Schemas (draft 7) of study, result, comparison, judgement and papers files; the study's
/// from the same table as the reader.
nlohmann::json study_schema();
nlohmann::json result_schema();
nlohmann::json comparison_schema();
nlohmann::json judgement_schema();
nlohmann::json papers_schema();

}  // namespace driftless
