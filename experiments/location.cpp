#include "experiments/location.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/study.hpp"
#include "experiments/text_file.hpp"

namespace driftless {
namespace {

constexpr std::size_t longest_shown = 60;  // bytes of a value that a message repeats

bool plain_word(std::string_view key) {
  return !key.empty() && key.size() <= longest_shown &&
         std::all_of(key.begin(), key.end(), [](char c) {
           return c == '_' || c == '-' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                  (c >= 'A' && c <= 'Z');
         });
}

std::string quote(std::string_view text) {
  std::size_t length = std::min(text.size(), longest_shown);
  // A character of several bytes is kept whole or left out.
  while (length < text.size() && length > 0 && (text[length] & 0xC0) == 0x80) --length;
  const bool whole = length == text.size();
  return nlohmann::json(printable(text.substr(0, length))).dump() + (whole ? "" : "...");
}

std::string counted(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace

Location::Location(std::string source, std::string path)
    : source_(std::move(source)), path_(std::move(path)) {}

Location Location::member(std::string_view key) const {
  if (!plain_word(key)) return Location(source_, path_ + "[" + quote(key) + "]");
  return Location(source_, path_ + (path_.empty() ? "" : ".") + std::string(key));
}

Location Location::element(std::size_t index) const {
  return Location(source_, fmt::format("{}[{}]", path_, index));
}

void Location::refuse(const std::string& what) const {
  throw InputError(printable(source_ + ": " + (path_.empty() ? "" : path_ + ": ") + what));
}

std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const auto byte = static_cast<unsigned char>(text[i]);
    if (length == 0 || byte < 0x20 || byte == 0x7F) {
      result += '?';
    } else {
      result += text.substr(i, length);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return result;
}

std::string describe(const nlohmann::json& value) {
  if (value.is_string()) return quote(value.get_ref<const std::string&>());
  if (value.is_array()) {
    return value.empty() ? "an empty list" : "a list of " + counted(value.size(), "element");
  }
  if (value.is_object()) {
    return value.empty() ? "an empty object" : "an object of " + counted(value.size(), "key");
  }
  return value.dump();
}

std::string describe(double number) { return fmt::format("{:.12g}", number); }

std::string either(const std::vector<std::string>& words, bool quoted) {
  std::string result;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) result += i + 1 == words.size() ? " or " : ", ";
    result += quoted ? quote(words[i]) : words[i];
  }
  return result;
}

}  // namespace driftless
