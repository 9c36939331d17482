// Writes the page of a result, a judgement or reproduced experiments: write_page RESULT.json
// PAGE.html. The browser tests' way to pages of results that no study would give.

#include <exception>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "experiments/page.hpp"

int main(int argument_count, char** arguments) try {
  if (argument_count != 3) {
    std::cerr << "usage: write_page RESULT.json PAGE.html\n";
    return 2;
  }
  std::ifstream input(arguments[1]);
  const auto result = nlohmann::json::parse(input);
  std::ofstream output(arguments[2], std::ios::binary);
  const auto format = result.value("format", "");
  output << (format == "driftless-judgement/1" ? driftless::render_judgement_page(result)
             : format == "driftless-papers/1"  ? driftless::render_papers_page(result)
                                               : driftless::render_page(result));
  output.close();
  return output ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << "write_page: " << error.what() << '\n';
  return 1;
}
