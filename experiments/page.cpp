#include "experiments/page.hpp"

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "experiments/page/page_template.hpp"

namespace driftless {
namespace {

// In a script element "</script" and "<!--" would end or swallow what follows; JSON may write any
// character as an escape, so no `<` is left as it is. Text that is not UTF-8 becomes U+FFFD.
std::string inline_json(const nlohmann::json& value) {
  const std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(text.size() + text.size() / 64);
  for (const char character : text) {
    if (character == '<') {
      escaped += "\\u003c";
    } else {
      escaped += character;
    }
  }
  return escaped;
}

void append(std::string& page, std::span<const std::string_view> pieces) {
  for (const std::string_view piece : pieces) page += piece;
}

std::string render(const PageTemplate& page, const nlohmann::json& result) {
  std::string text;
  append(text, page.before);
  text += inline_json(result);
  append(text, page.after);
  return text;
}

}  // namespace

std::string render_page(const nlohmann::json& result) { return render(result_page(), result); }

std::string render_judgement_page(const nlohmann::json& judgement) {
  return render(judgement_page(), judgement);
}

std::string render_papers_page(const nlohmann::json& papers) {
  return render(papers_page(), papers);
}

}  // namespace driftless
