#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace driftless {

/// The web page of a result (format "driftless-result/1"): one self-contained HTML text that opens
/// without a network. What the page shows is worked out from the result when it is opened.
std::string render_page(const nlohmann::json& result);
/// The same of a judgement (format "driftless-judgement/1").
std::string render_judgement_page(const nlohmann::json& judgement);
/// The same of reproduced experiments (format "driftless-papers/1").
std::string render_papers_page(const nlohmann::json& papers);

}  // namespace driftless
