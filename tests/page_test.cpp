#include "experiments/page.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace driftless {
namespace {

constexpr std::string_view result_begins = R"(<script type="application/json" id="result">)";

nlohmann::json sample_result() {
  std::ifstream file(std::filesystem::path(__FILE__).parent_path() / "page" / "sample_result.json");
  return nlohmann::json::parse(file);
}

std::string inlined_result(const std::string& page) {
  const auto begin = page.find(result_begins) + result_begins.size();
  return page.substr(begin, page.find("</script>", begin) - begin);
}

std::size_t count(std::string_view text, std::string_view word) {
  std::size_t found = 0;
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++found;
  return found;
}

TEST(Page, HoldsTheResultUnchanged) {
  const auto result = sample_result();
  EXPECT_EQ(nlohmann::json::parse(inlined_result(render_page(result))), result);
}

TEST(Page, NoTextOfAResultCanEndTheScriptElement) {
  auto result = sample_result();
  result["name"] = "</script><script>alert(1)</script><!-- \xe2\x80\xa8 & \"quoted\" \\";
  const std::string page = render_page(result);
  EXPECT_EQ(count(page, "</script>"), count(render_page(sample_result()), "</script>"));
  EXPECT_EQ(inlined_result(page).find('<'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(inlined_result(page)), result);
}

TEST(Page, TextThatIsNotUtf8DoesNotStopThePage) {
  auto result = sample_result();
  result["name"] = "caf\xe9";
  const auto inlined = nlohmann::json::parse(inlined_result(render_page(result)));
  EXPECT_EQ(inlined["name"], "caf\xef\xbf\xbd");
}

TEST(Page, HasItsScriptStyleAndLicencesInline) {
  const std::string page = render_page(sample_result());
  EXPECT_EQ(page.find("@RESULT@"), std::string::npos);
  EXPECT_EQ(page.find("@PAGE_"), std::string::npos);
  EXPECT_EQ(count(page, "<script"), 2U);
  EXPECT_EQ(count(page, "<script src"), 0U);
  EXPECT_EQ(count(page, "rel=\"stylesheet\""), 0U);
  EXPECT_GT(count(page, "Redistribution and use in source and binary forms"), 0U);
  EXPECT_NE(page.find("vega-lite 6"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

}  // namespace
}  // namespace driftless
