#include "experiments/value_rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/nearest.hpp"

namespace driftless {
namespace {

using nlohmann::json;

constexpr double largest = 1e12;           // of any number: squares and products stay finite
constexpr double exact_integers = 0x1p53;  // up to here a double holds every whole number

bool is_number(const json& value) {
  return value.is_number() && std::abs(value.get<double>()) <= largest;
}

bool is_vector(const json& value) {
  return value.is_array() && value.size() == 3 &&
         std::all_of(value.begin(), value.end(), is_number);
}

bool is_point(const json& value) {
  return value.is_array() && value.size() == 2 &&
         std::all_of(value.begin(), value.end(), is_number);
}

bool is_integer(const json& value) {
  if (value.is_number_unsigned()) return true;
  if (value.is_number_integer()) return value.get<std::int64_t>() >= 0;
  if (!value.is_number_float()) return false;
  const double number = value.get<double>();
  return number >= 0 && number <= exact_integers && number == std::floor(number);
}

bool is_name(const json& value) {
  if (!value.is_string()) return false;
  const auto& text = value.get_ref<const std::string&>();
  const auto characters =
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
  return characters >= 1 && characters <= 200 && printable(text) == text;
}

}  // namespace

ValueRule ValueRule::number() { return ValueRule(Kind::number); }
ValueRule ValueRule::positive() { return ValueRule(Kind::positive); }
ValueRule ValueRule::not_negative() { return ValueRule(Kind::not_negative); }
ValueRule ValueRule::boolean() { return ValueRule(Kind::boolean); }
ValueRule ValueRule::name() { return ValueRule(Kind::name); }
ValueRule ValueRule::vector() { return ValueRule(Kind::vector); }
ValueRule ValueRule::vectors() { return ValueRule(Kind::vectors); }

ValueRule ValueRule::points(std::string pair) {
  ValueRule rule(Kind::points);
  rule.owner_ = std::move(pair);
  return rule;
}

ValueRule ValueRule::integer(std::uint64_t least, std::uint64_t most) {
  ValueRule rule(Kind::integer);
  rule.least_ = least;
  rule.most_ = most;
  return rule;
}

ValueRule ValueRule::word(std::vector<std::string> words) {
  ValueRule rule(Kind::word);
  rule.words_ = std::move(words);
  return rule;
}

ValueRule ValueRule::object(std::string owner, std::vector<Field> fields) {
  ValueRule rule(Kind::object);
  rule.owner_ = std::move(owner);
  rule.fields_ = std::make_shared<const std::vector<Field>>(std::move(fields));
  return rule;
}

ValueRule ValueRule::objects(std::string owner, std::vector<Field> fields) {
  ValueRule rule = object(std::move(owner), std::move(fields));
  rule.kind_ = Kind::objects;
  return rule;
}

bool ValueRule::holds(const json& value) const {
  switch (kind_) {
    case Kind::number:
      return is_number(value);
    case Kind::positive:
      return is_number(value) && value.get<double>() > 0;
    case Kind::not_negative:
      return is_number(value) && value.get<double>() >= 0;
    case Kind::integer:
      return is_integer(value) && to_integer(value) >= least_ && to_integer(value) <= most_;
    case Kind::boolean:
      return value.is_boolean();
    case Kind::word:
      return value.is_string() &&
             std::find(words_.begin(), words_.end(), value.get<std::string>()) != words_.end();
    case Kind::name:
      return is_name(value);
    case Kind::vector:
      return is_vector(value);
    case Kind::vectors:
      return value.is_array() && std::all_of(value.begin(), value.end(), is_vector);
    case Kind::points:
      return value.is_array() && std::all_of(value.begin(), value.end(), is_point);
    case Kind::object:
      return value.is_object();
    case Kind::objects:
      return value.is_array() && std::all_of(value.begin(), value.end(),
                                             [](const json& one) { return one.is_object(); });
  }
  return false;
}

void ValueRule::check(const json& value, const Location& location) const {
  if (holds(value)) {
    if (kind_ == Kind::object) check_fields(value, location, owner_, *fields_);
    for (std::size_t i = 0; kind_ == Kind::objects && i < value.size(); ++i) {
      check_fields(value[i], location.element(i), owner_, *fields_);
    }
    return;
  }
  if (kind_ == Kind::vector && value.is_array() && value.size() == 3) {
    for (std::size_t i = 0; i < 3; ++i) number().check(value[i], location.element(i));
  }
  if (kind_ == Kind::vectors && value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) vector().check(value[i], location.element(i));
  }
  if (kind_ == Kind::points && value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (is_point(value[i])) continue;
      location.element(i).refuse("is " + describe(value[i]) + "; allowed is " + owner_ +
                                 ", two numbers");
    }
  }
  std::string hint;
  if (kind_ == Kind::word && value.is_string()) {
    const auto near = nearest(value.get<std::string>(), words_);
    if (near) hint = "; did you mean \"" + *near + "\"?";
  }
  location.refuse("is " + describe(value) + "; allowed is " + allowed() + hint);
}

std::string ValueRule::allowed() const {
  switch (kind_) {
    case Kind::number:
      return "a number from -1e12 to 1e12";
    case Kind::positive:
      return "a number > 0 and <= 1e12";
    case Kind::not_negative:
      return "a number >= 0 and <= 1e12";
    case Kind::integer:
      return fmt::format("a whole number from {} to {}", least_, most_);
    case Kind::boolean:
      return "true or false";
    case Kind::word:
      return either(words_, true);
    case Kind::name:
      return "a text of 1 to 200 characters on one line";
    case Kind::vector:
      return "a list of three numbers [x, y, z]";
    case Kind::vectors:
      return "a list of [x, y, z]";
    case Kind::points:
      return "a list of " + owner_;
    case Kind::object:
      return "an object with " + keys();
    case Kind::objects:
      return "a list of objects with " + keys();
  }
  return {};
}

std::string ValueRule::keys() const {
  std::vector<std::string> names;
  for (const auto& field : *fields_) names.emplace_back(field.name);
  return either(names, true);
}

json ValueRule::number_schema() const {
  json schema = {{"type", "number"}, {"maximum", largest}};
  if (kind_ == Kind::positive) {
    schema["exclusiveMinimum"] = 0;
  } else {
    schema["minimum"] = kind_ == Kind::not_negative ? 0 : -largest;
  }
  return schema;
}

json ValueRule::schema() const {
  switch (kind_) {
    case Kind::number:
    case Kind::positive:
    case Kind::not_negative:
      return number_schema();
    case Kind::integer:
      return {{"type", "integer"}, {"minimum", least_}, {"maximum", most_}};
    case Kind::boolean:
      return {{"type", "boolean"}};
    case Kind::word:
      return {{"enum", words_}};
    case Kind::name:
      return {{"type", "string"}, {"minLength", 1}, {"maxLength", 200}};
    case Kind::vector:
      return {{"type", "array"}, {"items", number().schema()}, {"minItems", 3}, {"maxItems", 3}};
    case Kind::vectors:
      return {{"type", "array"}, {"items", vector().schema()}};
    case Kind::points:
      return {
          {"type", "array"},
          {"items",
           {{"type", "array"}, {"items", number().schema()}, {"minItems", 2}, {"maxItems", 2}}}};
    case Kind::object:
      return fields_schema(*fields_);
    case Kind::objects:
      return {{"type", "array"}, {"items", fields_schema(*fields_)}};
  }
  return {};
}

void require_object(const json& value, const Location& location, const std::string& example) {
  if (value.is_object()) return;
  location.refuse("is " + describe(value) + "; allowed is an object such as " + example);
}

void require_known_keys(const json& object, const Location& location, const std::string& owner,
                        const std::vector<std::string>& names) {
  for (const auto& [key, value] : object.items()) {
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    location.member(key).refuse("is no key of " + owner + suggestion(key, names));
  }
}

const json& require_key(const json& object, const Location& location, const std::string& name,
                        const std::string& allowed) {
  const auto found = object.find(name);
  if (found != object.end()) return *found;
  location.member(name).refuse("is missing; allowed is " + allowed);
}

void check_fields(const json& object, const Location& location, const std::string& owner,
                  const std::vector<Field>& fields) {
  std::vector<std::string> names;
  for (const auto& field : fields) names.emplace_back(field.name);
  require_known_keys(object, location, owner, names);
  for (const auto& field : fields) {
    const std::string name(field.name);
    if (field.required) require_key(object, location, name, field.rule.allowed());
    if (const auto value = object.find(name); value != object.end()) {
      field.rule.check(*value, location.member(name));
    }
  }
}

json fields_schema(const std::vector<Field>& fields) {
  json properties = json::object();
  json required = json::array();
  for (const auto& field : fields) {
    const std::string name(field.name);
    properties[name] = field.rule.schema();
    properties[name]["description"] = field.meaning;
    if (field.required) required.push_back(name);
  }
  return {{"type", "object"},
          {"properties", properties},
          {"required", required},
          {"additionalProperties", false}};
}

std::uint64_t to_integer(const json& value) {
  return value.is_number_float() ? static_cast<std::uint64_t>(value.get<double>())
                                 : value.get<std::uint64_t>();
}

}  // namespace driftless
