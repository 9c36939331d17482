#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/location.hpp"

namespace driftless {

struct Field;

/// What a key's value may be: one description from which values are checked, messages are worded
/// and the JSON Schema is written.
class ValueRule {
 public:
  /// Finite numbers up to 1e12 in size.
  static ValueRule number();
  static ValueRule positive();
  static ValueRule not_negative();
  /// Whole numbers between the two, written with or without a fraction of zero.
  static ValueRule integer(std::uint64_t least, std::uint64_t most);
  static ValueRule boolean();
  /// One of a few words.
  static ValueRule word(std::vector<std::string> words);
  /// A name for people: 1 to 200 characters on one line.
  static ValueRule name();
  /// [x, y, z], or a list of such.
  static ValueRule vector();
  static ValueRule vectors();
  /// A list of pairs of numbers; `pair` is how messages write one: "[temperature, energy]".
  static ValueRule points(std::string pair);
  /// An object of plain fields, or a list of such; `owner` is what messages call one: "a wall".
  static ValueRule object(std::string owner, std::vector<Field> fields);
  static ValueRule objects(std::string owner, std::vector<Field> fields);

  /// Throws InputError if the value is none of these.
  void check(const nlohmann::json& value, const Location& location) const;
  /// "a number > 0", as messages and listings put it.
  std::string allowed() const;
  /// Draft 7; without title or description.
  nlohmann::json schema() const;

 private:
  enum class Kind {
    number,
    positive,
    not_negative,
    integer,
    boolean,
    word,
    name,
    vector,
    vectors,
    points,
    object,
    objects
  };
  explicit ValueRule(Kind kind) : kind_(kind) {}

  bool holds(const nlohmann::json& value) const;
  nlohmann::json number_schema() const;
  std::string keys() const;

  Kind kind_;
  std::uint64_t least_ = 0, most_ = 0;
  std::vector<std::string> words_;
  std::string owner_;
  std::shared_ptr<const std::vector<Field>> fields_;
};

/// A key of an object that only holds plain values.
struct Field {
  std::string_view name;
  ValueRule rule;
  bool required;
  std::string_view meaning;
};

/// Throws InputError unless the value is an object; `example` shows what is allowed.
void require_object(const nlohmann::json& value, const Location& location,
                    const std::string& example);
/// Throws InputError for a key that is none of `names`, naming the nearest; `owner` is "a scene".
void require_known_keys(const nlohmann::json& object, const Location& location,
                        const std::string& owner, const std::vector<std::string>& names);
/// Throws InputError if the key is missing; `allowed` says what it should hold.
const nlohmann::json& require_key(const nlohmann::json& object, const Location& location,
                                  const std::string& name, const std::string& allowed);

/// Checks an object of plain fields; throws InputError.
void check_fields(const nlohmann::json& object, const Location& location, const std::string& owner,
                  const std::vector<Field>& fields);
nlohmann::json fields_schema(const std::vector<Field>& fields);

/// The value of a checked integer, whatever way it was written.
std::uint64_t to_integer(const nlohmann::json& value);

}  // namespace driftless
