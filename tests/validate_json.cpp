// validate_json SCHEMA INSTANCE: exit code 0 if the instance keeps to the JSON Schema (draft 7);
// 1 if not, with a line for each fault; 2 if one of the two cannot be read.

#include <exception>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/json_schema.hpp"

namespace {

nlohmann::json read(const char* path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(std::string(path) + ": cannot be opened");
  try {
    return nlohmann::json::parse(file);
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string(path) + ": " + error.what());
  }
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 3) throw std::runtime_error("usage: validate_json SCHEMA INSTANCE");
  const auto errors = driftless::schema_errors(read(arguments[1]), read(arguments[2]));
  for (const auto& error : errors) std::cout << arguments[2] << ": " << error << '\n';
  return errors.empty() ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
