#include "experiments/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <vector>

#include "experiments/location.hpp"
#include "experiments/text_file.hpp"

namespace driftless {
namespace {

using nlohmann::json;

constexpr std::size_t deepest = 20;  // levels; a study needs five

/// "line 3, column 7" of a byte; columns count bytes.
std::string line_and_column(std::string_view text, std::size_t position) {
  const auto before = text.substr(0, position);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const auto start = before.rfind('\n');
  const auto column = 1 + position - (start == std::string_view::npos ? 0 : start + 1);
  return fmt::format("line {}, column {}", line, column);
}

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '+';
}

/// "NaN", "-Infinity" and the like that start at a byte of the text, as they stand there.
std::optional<std::string> non_finite_word(std::string_view text, std::size_t first) {
  std::size_t last = std::min(first, text.size());
  while (last < text.size() && is_word_character(text[last])) ++last;
  const std::string word(text.substr(first, last - first));
  std::string lower;
  for (const char c : word) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) lower += static_cast<char>(c | 0x20);
  }
  if (lower == "nan" || lower == "inf" || lower == "infinity") return word;
  return std::nullopt;
}

/// The library's complaint without its own positions and prefixes, and without what it read last,
/// which may be the whole file so far.
std::string complaint(const std::string& what) {
  const std::string mark = " - ", read = "; last read: '", expected = "; expected ";
  const auto start = what.find(mark, what.find("syntax error") + 1);
  std::string text = start == std::string::npos ? what : what.substr(start + mark.size());
  const auto cut = text.find(read);
  if (cut == std::string::npos) return text;
  const auto rest = text.rfind("'" + expected);
  const bool has_rest = rest != std::string::npos && rest >= cut + read.size();
  return text.substr(0, cut) + (has_rest ? text.substr(rest + 1) : "");
}

/// Up to 20 bytes of the line from a byte on.
std::string excerpt(std::string_view text, std::size_t position) {
  const auto line = text.substr(position, text.find_first_of("\r\n", position) - position);
  return line.empty() ? "" : " at " + describe(json(printable(line.substr(0, 20))));
}

/// Builds the value and knows the path to it, which is what messages need and a plain parse hides.
class Builder : public nlohmann::json_sax<json> {
 public:
  Builder(const std::string& text, const std::string& source) : text_(text), source_(source) {}

  json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t& written) override {
    const auto mantissa = written.substr(0, written.find_first_of("eE"));
    if (value == 0 && mantissa.find_first_of("123456789") != std::string::npos) {
      here().refuse("is " + written + ", which is too small for a number of double precision; " +
                    "allowed is 0 or at least 1e-300");
    }
    return add(value);
  }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& /*value*/) override { return false; }
  bool start_object(std::size_t /*size*/) override { return open(json::object()); }
  bool start_array(std::size_t /*size*/) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    if (open_.back()->contains(value)) {
      location().member(value).refuse("is given twice; allowed is once");
    }
    key_ = value;
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& error) override {
    if (error.id == 406) {
      here().refuse("is " + token.substr(0, 40) +
                    ", which is too large for a number of double precision; " +
                    "allowed is at most 1e308");
    }
    const std::size_t byte = start_of(token, position);
    const auto within = location().path();
    const Location place(
        source_, line_and_column(text_, byte) + (within.empty() ? "" : " (in " + within + ")"));
    if (const auto word = non_finite_word(text_, byte)) {
      place.refuse("is " + *word + "; allowed is a finite number");
    }
    place.refuse("is not JSON" + excerpt(text_, byte) + ": " + complaint(error.what()));
  }

 private:
  /// Where the token starts whose last byte was read as the `count`th. The library's own idea of a
  /// token takes in what it skipped before, so only whole strings are taken from it.
  std::size_t start_of(const std::string& token, std::size_t count) const {
    const std::size_t end = std::min(count, text_.size());
    const bool whole_string = token.size() >= 2 && token.find('"', 1) == token.size() - 1 &&
                              token.front() == '"' && end >= token.size() &&
                              text_.compare(end - token.size(), token.size(), token) == 0;
    if (whole_string) return end - token.size();
    std::size_t start = count > 0 && count <= text_.size() ? count - 1 : end;
    const bool word = start < text_.size() && is_word_character(text_[start]);
    while (word && start > 0 && is_word_character(text_[start - 1])) --start;
    return start;
  }
  /// The list or object that is open.
  Location location() const {
    Location result(source_);
    for (std::size_t level = 0; level + 1 < open_.size(); ++level) {
      result = step(result, level);
    }
    return result;
  }
  Location step(const Location& from, std::size_t level) const {
    return open_[level]->is_array() ? from.element(open_[level]->size() - 1)
                                    : from.member(keys_[level]);
  }
  /// The value that comes next.
  Location here() const {
    const Location around = location();
    if (open_.empty()) return around;
    return open_.back()->is_array() ? around.element(open_.back()->size()) : around.member(key_);
  }

  json& put(json value) {
    if (open_.empty()) return root_ = std::move(value);
    if (open_.back()->is_array()) {
      open_.back()->push_back(std::move(value));
      return open_.back()->back();
    }
    return (*open_.back())[key_] = std::move(value);
  }
  bool add(json value) {
    put(std::move(value));
    return true;
  }
  bool open(json value) {
    if (open_.size() >= deepest) {
      const auto start = here().path().substr(0, 60);
      Location(source_, start)
          .refuse(fmt::format("is nested too deeply; allowed is {} levels", deepest));
    }
    // Elements of a list never move while one of them is open: the list grows only after that.
    json& opened = put(std::move(value));
    if (!open_.empty()) keys_.push_back(key_);
    open_.push_back(&opened);
    return true;
  }
  bool close() {
    open_.pop_back();
    if (!keys_.empty()) keys_.pop_back();
    return true;
  }

  const std::string& text_;
  const std::string& source_;
  json root_;
  std::vector<json*> open_;        // from the whole file to the innermost
  std::vector<std::string> keys_;  // keys_[n]: where open_[n + 1] stands in open_[n], if an object
  std::string key_;
};

void require_utf8(const std::string& text, const std::string& source) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) {
      const int byte = static_cast<unsigned char>(text[i]);
      Location(source, line_and_column(text, i))
          .refuse(fmt::format("is not UTF-8 but the byte 0x{:02x}; allowed is UTF-8 text", byte));
    }
    i += length;
  }
}

}  // namespace

json parse_json_text(const std::string& text, const std::string& source) {
  require_utf8(text, source);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    Location(source).refuse("line 1, column 1: is empty; allowed is a JSON object");
  }
  Builder builder(text, source);
  json::sax_parse(text, &builder, json::input_format_t::json, true, true);
  return builder.take();
}

json rounded(const json& value) {
  if (value.is_number_float()) return std::stod(fmt::format("{:.6g}", value.get<double>()));
  json copy = value;
  if (value.is_structured()) {
    for (auto& part : copy) part = rounded(part);
  }
  return copy;
}

}  // namespace driftless
