#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// What limits each figure of the bench's page: every number and every choice of words comes from
/// the measured rows.
namespace driftless {

std::string sizes_sentence(const nlohmann::json& bench, const std::string& kernel);
std::string memory_sentence(const nlohmann::json& bench);
std::string threads_sentence(const nlohmann::json& bench);
std::string methods_sentence(const nlohmann::json& bench);
std::string terms_sentence(const nlohmann::json& bench, const std::string& kernel);

}  // namespace driftless
