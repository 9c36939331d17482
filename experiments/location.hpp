#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace driftless {

/// Where in which file a value stands: what every message about it begins with.
class Location {
 public:
  /// `source` is the file's name as the user gave it; the path of the whole file is empty.
  explicit Location(std::string source, std::string path = {});

  /// The member `key` of an object: a.b, or a["b c"] where b is no plain word.
  Location member(std::string_view key) const;
  /// The element of a list: a[3].
  Location element(std::size_t index) const;

  const std::string& source() const { return source_; }
  const std::string& path() const { return path_; }

  /// Throws InputError "source: path: what", on one line whatever the parts contain.
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  std::string source_;
  std::string path_;
};

/// The text on one line of printable UTF-8: control characters and broken bytes become '?'.
std::string printable(std::string_view text);

/// A value for a message: as JSON, shortened where long; lists and objects by their kind and size.
std::string describe(const nlohmann::json& value);

/// A number for a message: up to 12 significant digits.
std::string describe(double number);

/// "a", "a or b", "a, b or c"; quoted as JSON strings if `quoted`.
std::string either(const std::vector<std::string>& words, bool quoted);

}  // namespace driftless
