#include "experiments/bench/bench_page.hpp"
namespace driftless { std::string bench_page(const nlohmann::json&) { return ""; } }
