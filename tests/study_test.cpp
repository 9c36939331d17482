#include "experiments/study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/json_schema.hpp"

namespace driftless {
namespace {

using nlohmann::json;

const char* const good_text = R"(// Comments may stand anywhere.
{
  "format": "driftless-study/1",
  "name": "a study",
  "scenes": [
    {"preset": "mackie-1999", "friction_closure": "noise"},
    {"preset": "two-body" /* pairs */, "particles": 200}
  ],
  "methods": ["espanol", {"name": "shardlow-s1", "options": {"as_published": true}}],
  "time_steps": [0.1, 0.05],
  "duration": {"equilibrate": 10, "measure": 100, "sample_every": 0.5},
  "replicas": 3,
  "seed": 7 // the last key
}
)";

const json& good() {
  static const json study = json::parse(good_text, nullptr, true, true);
  return study;
}

/// The good study with one value replaced or added.
std::string with(const char* pointer, const json& value) {
  json study = good();
  study[json::json_pointer(pointer)] = value;
  return study.dump(2);
}

/// The good study with one key taken out.
std::string without(const char* parent, const char* key) {
  json study = good();
  study[json::json_pointer(parent)].erase(key);
  return study.dump(2);
}

/// The good study's text with one piece of it replaced, for what no JSON value can be.
std::string written(const std::string& piece, const std::string& by) {
  std::string text = good_text;
  const auto place = text.find(piece);
  EXPECT_NE(place, std::string::npos) << piece;
  return text.replace(place, piece.size(), by);
}

struct BadStudy {
  const char* what;
  std::string text;
  const char* path;                ///< how the message begins, after the file
  std::vector<const char*> parts;  ///< what else it contains: value, range, nearest name
};

std::vector<BadStudy> not_json() {
  std::string deep_lists(100000, '[');
  std::string deep_objects;
  for (int i = 0; i < 50000; ++i) deep_objects += "{\"a\":";
  return {
      {"empty file", "", "line 1, column 1", {"empty"}},
      {"blank file", " \n\t\n", "line 1, column 1", {"empty"}},
      {"comment alone", "// nothing", "line 1", {"not JSON"}},
      {"no JSON", "format: driftless", "line 1, column 1", {"not JSON"}},
      {"cut short", std::string(good_text).substr(0, 100), "line ", {"not JSON"}},
      {"comma missing",
       written("\"replicas\": 3,", "\"replicas\": 3"),
       "line 13, column 3",
       {"not JSON"}},
      {"comma too much",
       written("0.05]", "0.05,]"),
       "line 10, column 28 (in time_steps)",
       {"not JSON"}},
      {"comment left open", written("/* pairs */", "/* pairs"), "line ", {"not JSON", "comment"}},
      {"trailing garbage", std::string(good_text) + "{}", "line 15, column 1", {"not JSON"}},
      {"single quotes", written("\"seed\"", "'seed'"), "line 13, column 3", {"not JSON"}},
      {"NaN", written("[0.1,", "[NaN,"), "line 10", {"time_steps", "NaN", "finite"}},
      {"minus Infinity", written("[0.1,", "[-Infinity,"), "line 10", {"-Infinity", "finite"}},
      {"number too large", written("[0.1,", "[1e999,"), "time_steps[0]", {"1e999", "1e308"}},
      {"number too small", written("[0.1,", "[1e-999,"), "time_steps[0]", {"1e-999", "too small"}},
      {"leading zero", written("[0.1,", "[00.1,"), "line 10", {"not JSON"}},
      {"not UTF-8 in a text",
       written("a study", "a \xff study"),
       "line 4, column 14",
       {"0xff", "UTF-8"}},
      {"not UTF-8 in a comment",
       written("pairs */", "\xc3 */"),
       "line 7, column 30",
       {"0xc3", "UTF-8"}},
      {"overlong UTF-8", written("a study", "\xc0\xaf"), "line 4", {"0xc0"}},
      {"overlong UTF-8 of three", written("a study", "\xe0\x80\xaf"), "line 4", {"0xe0"}},
      {"overlong UTF-8 of four", written("a study", "\xf0\x80\x80\xaf"), "line 4", {"0xf0"}},
      {"UTF-8 beyond Unicode", written("a study", "\xf4\x90\x80\x80"), "line 4", {"0xf4"}},
      {"surrogate", written("a study", "\xed\xa0\x80"), "line 4", {"0xed"}},
      {"zero byte", written("a study", std::string("a\0b", 3)), "line 4", {"not JSON"}},
      {"deep lists", deep_lists, "[0][0]", {"nested", "20 levels"}},
      {"deep objects", deep_objects, "a.a", {"nested", "20 levels"}},
      {"key twice", written("\"seed\": 7", "\"seed\": 7, \"seed\": 7"), "seed", {"twice"}},
      {"scene's key twice",
       written("\"particles\": 200", "\"particles\": 200, \"particles\": 300"),
       "scenes[1].particles",
       {"twice"}},
      {"option twice",
       written("\"as_published\": true", "\"as_published\": true, \"as_published\": true"),
       "methods[1].options.as_published",
       {"twice"}},
  };
}

std::vector<BadStudy> bad_keys() {
  json many = good();
  many["methods"] = "all";
  many["replicas"] = 100000;
  return {
      {"a list", "[]", "the whole file", {"an empty list", "driftless-study/1"}},
      {"a number", "3", "the whole file", {"is 3", "object"}},
      {"format missing", without("", "format"), "format", {"missing", "driftless-study/1"}},
      {"format of a result",
       with("/format", "driftless-result/1"),
       "format",
       {"driftless-result/1", "did you mean \"driftless-study/1\""}},
      {"unknown key", with("/time_stesp", {0.1}), "time_stesp", {"did you mean \"time_steps\""}},
      {"key in another case", with("/Seed", 3), "Seed", {"did you mean \"seed\""}},
      {"key like nothing", with("/zzzzzz", 3), "zzzzzz", {"allowed is", "duration"}},
      {"key with line breaks", with("/a\nb", 3), "[\"a?b\"]", {"no key"}},
      {"name of no characters", with("/name", ""), "name", {"\"\"", "1 to 200"}},
      {"name of two lines", with("/name", "a\nb"), "name", {"one line"}},
      {"name a number", with("/name", 3), "name", {"is 3", "text"}},
      {"methods missing", without("", "methods"), "methods", {"missing"}},
      {"duration missing", without("", "duration"), "duration", {"missing", "sample_every"}},
      {"no scene", without("", "scenes"), "scenes", {"missing"}},
      {"scene and scenes", with("/scene", {{"preset", "two-body"}}), "scene", {"beside scenes"}},
      {"replicas none", with("/replicas", 0), "replicas", {"is 0", "1 to 100000"}},
      {"replicas a fraction", with("/replicas", 2.5), "replicas", {"2.5", "whole number"}},
      {"replicas a text", with("/replicas", "2"), "replicas", {"\"2\"", "whole number"}},
      {"seed negative", with("/seed", -1), "seed", {"-1", "9007199254740991"}},
      {"seed too large",
       written("\"seed\": 7", "\"seed\": 18446744073709551616"),
       "seed",
       {"1.84467", "9007199254740991"}},
      {"too many runs", many.dump(), "replicas", {"100000", "1e6"}},
  };
}

std::vector<BadStudy> bad_scenes() {
  return {
      {"scenes empty", with("/scenes", json::array()), "scenes", {"empty list", "1 to 1000"}},
      {"scenes an object", with("/scenes", {{"preset", "two-body"}}), "scenes", {"object", "list"}},
      {"scene a name", with("/scenes/0", "two-body"), "scenes[0]", {"\"two-body\"", "preset"}},
      {"preset missing",
       without("/scenes/0", "preset"),
       "scenes[0].preset",
       {"missing", "soft-fluid"}},
      {"preset unknown",
       with("/scenes/0/preset", "mackie-1998"),
       "scenes[0].preset",
       {"mackie-1998", "did you mean \"mackie-1999\""}},
      {"preset a number", with("/scenes/0/preset", 1999), "scenes[0].preset", {"1999", "two-body"}},
      {"scene's key unknown",
       with("/scenes/0/fricton", 1),
       "scenes[0].fricton",
       {"did you mean \"friction\""}},
      {"scene's key abridged",
       with("/scenes/0/closure", "noise"),
       "scenes[0].closure",
       {"did you mean \"friction_closure\""}},
      {"scene's key by hyphens",
       with("/scenes/0/heat-form", "none"),
       "scenes[0].heat-form",
       {"did you mean \"heat_form\""}},
      {"closure unknown",
       with("/scenes/0/friction_closure", "niose"),
       "scenes[0].friction_closure",
       {"niose", "\"noise\" or \"friction\"", "did you mean \"noise\""}},
      {"heat form by underscore",
       with("/scenes/0/heat_form", "inverse_temperature"),
       "scenes[0].heat_form",
       {"did you mean \"inverse-temperature\""}},
      {"friction negative", with("/scenes/0/friction", -1), "scenes[0].friction", {"-1", ">= 0"}},
      {"friction true", with("/scenes/0/friction", true), "scenes[0].friction", {"true", ">= 0"}},
      {"density null", with("/scenes/0/density", nullptr), "scenes[0].density", {"null", "> 0"}},
      {"density zero", with("/scenes/0/density", 0), "scenes[0].density", {"is 0", "> 0"}},
      {"mass beyond the range",
       with("/scenes/0/mass", 1e200),
       "scenes[0].mass",
       {"1e+200", "1e12"}},
      {"temperature a text",
       with("/scenes/0/temperature", "hot"),
       "scenes[0].temperature",
       {"\"hot\"", "number > 0"}},
      {"boltzmann negative",
       with("/scenes/0/boltzmann", -0.5),
       "scenes[0].boltzmann",
       {"-0.5", ">= 0"}},
      {"nothing fluctuates",
       with("/scenes/0/boltzmann", 0),
       "scenes[0].initial_state",
       {"microcanonical", "boltzmann is 0", "\"rest\"", "\"given\""}},
      {"phi below every number",
       with("/scenes/0",
            {{"preset", "mackie-1999"}, {"boltzmann", 1e-200}, {"heat_capacity", 1e-200}}),
       "scenes[0]",
       {"heat_capacity is 0", "> 0"}},
      {"particles a fraction",
       with("/scenes/0/particles", 10.5),
       "scenes[0].particles",
       {"10.5", "whole number from 2"}},
      {"particles beyond 64 bits",
       with("/scenes/0/particles", 1e30),
       "scenes[0].particles",
       {"1e+30", "10000000"}},
      {"box too small",
       with("/scenes/0/particles", 8),
       "scenes[0].particles",
       {"is 8", "1.24", "at least 16"}},
      {"no box is large enough",
       with("/scenes/0/friction_range", 1e5),
       "scenes[0].particles",
       {"100000", "lower density"}},
      {"half a pair", with("/scenes/1/particles", 7), "scenes[1].particles", {"is 7", "even"}},
      {"pairs apart",
       with("/scenes/1/pair_distance", 1),
       "scenes[1].pair_distance",
       {"is 1", "range 1", "< 1"}},
      {"pairs that move", with("/scenes/1/frozen", false), "scenes[1].frozen", {"false", "true"}},
      {"pairs of density",
       with("/scenes/1/density", 2),
       "scenes[1].density",
       {"is 2", "no effect"}},
      {"pairs without exchange",
       with("/scenes/1", {{"preset", "two-body"}, {"friction", 0}, {"heat_form", "none"}}),
       "scenes[1].friction",
       {"is 0", "conduction > 0"}},
      {"fluid of pairs",
       with("/scenes/0/pair_distance", 0.3),
       "scenes[0].pair_distance",
       {"0.3", "no effect"}},
      {"frozen under forces",
       with("/scenes/0", {{"preset", "soft-fluid"}, {"frozen", true}}),
       "scenes[0].repulsion",
       {"25", "frozen"}},
      {"frozen a number",
       with("/scenes/0/frozen", 1),
       "scenes[0].frozen",
       {"is 1", "true or false"}},
      {"vector too short",
       with("/scenes/0/frame_velocity", {1, 2}),
       "scenes[0].frame_velocity",
       {"2 elements", "[x, y, z]"}},
      {"vector of texts",
       with("/scenes/0/frame_velocity", {1, 2, "3"}),
       "scenes[0].frame_velocity[2]",
       {"\"3\"", "number"}},
      {"velocities too few",
       with("/scenes/0/initial_velocities", {{1, 0, 0}, {-1, 0, 0}}),
       "scenes[0].initial_velocities",
       {"2 velocities", "1000"}},
      {"velocity of two parts",
       with("/scenes/0/initial_velocities", {{1, 0, 0}, {-1, 0}}),
       "scenes[0].initial_velocities[1]",
       {"2 elements", "[x, y, z]"}},
      {"velocities across a pair",
       with("/scenes/1", {{"preset", "two-body"},
                          {"particles", 2},
                          {"initial_velocities", {{1, 0, 0}, {0, 0.5, 0}}}}),
       "scenes[1].initial_velocities[1]",
       {"[0, 0.5, 0]", "[x, 0, 0]"}},
      {"spread of a law",
       with("/scenes/0", {{"preset", "mackie-1999"},
                          {"initial_velocity_spread", 1},
                          {"initial_state", "microcanonical"}}),
       "scenes[0].initial_velocity_spread",
       {"is 1", "no effect"}},
      {"start's temperature of a law",
       with("/scenes/0/initial_temperature", 2),
       "scenes[0].initial_temperature",
       {"is 2", "no effect"}},
      {"names alike",
       with("/scenes/0/name", "two-body"),
       "scenes[1].name",
       {"two-body", "another"}},
      {"scenes alike",
       with("/scenes/1", good()["scenes"][0]),
       "scenes[1].name",
       {"mackie-1999, friction_closure noise"}},
  };
}

std::vector<BadStudy> bad_methods() {
  return {
      {"methods empty", with("/methods", json::array()), "methods", {"empty list", "1 to 1000"}},
      {"methods a number", with("/methods", 3), "methods", {"is 3", "list"}},
      {"methods a name",
       with("/methods", "espanol"),
       "methods",
       {"\"espanol\"", "\"all\" or a list"}},
      {"method unknown",
       with("/methods/0", "shardlow-s3"),
       "methods[0]",
       {"shardlow-s3", "did you mean \"shardlow-s1\""}},
      {"method by underscore",
       with("/methods/0", "marsh_coveney"),
       "methods[0]",
       {"did you mean \"marsh-coveney\""}},
      {"method like nothing",
       with("/methods/0", "zzz"),
       "methods[0]",
       {"\"zzz\"", "isoenergetic-verlet"}},
      {"method a number", with("/methods/0", 1), "methods[0]", {"is 1", "espanol"}},
      {"method without name",
       without("/methods/1", "name"),
       "methods[1].name",
       {"missing", "espanol"}},
      {"method's name unknown",
       with("/methods/1/name", "shardlow"),
       "methods[1].name",
       {"did you mean \"shardlow-s1\""}},
      {"method's key unknown",
       with("/methods/1/option", 3),
       "methods[1].option",
       {"did you mean \"options\""}},
      {"all with options",
       with("/methods/1/name", "all"),
       "methods[1].name",
       {"\"all\"", "espanol"}},
      {"option unknown",
       with("/methods/1/options/as_publishd", true),
       "methods[1].options.as_publishd",
       {"shardlow-s1", "did you mean \"as_published\""}},
      {"option of another type",
       with("/methods/1/options/as_published", "yes"),
       "methods[1].options.as_published",
       {"\"yes\"", "true or false"}},
      {"option a number",
       with("/methods/0", {{"name", "avalos-mackie-midpoint"}, {"options", {{"tolerance", true}}}}),
       "methods[0].options.tolerance",
       {"true", "a number"}},
      {"options where there are none",
       with("/methods/0", {{"name", "espanol"}, {"options", {{"as_published", true}}}}),
       "methods[0].options.as_published",
       {"espanol", "none"}},
      {"options a list", with("/methods/1/options", {1}), "methods[1].options", {"list", "object"}},
      {"method twice",
       with("/methods", {"espanol", "espanol"}),
       "methods[1]",
       {"espanol", "second time"}},
      {"method twice by defaults",
       with("/methods",
            {"shardlow-s1", {{"name", "shardlow-s1"}, {"options", {{"as_published", false}}}}}),
       "methods[1]",
       {"shardlow-s1", "second time"}},
      {"method beside all",
       with("/methods", {"all", "espanol"}),
       "methods[1]",
       {"espanol", "second time"}},
  };
}

std::vector<BadStudy> bad_times() {
  const json ladder = {{"from", 0.0625}, {"to", 0.5}, {"count", 4}};
  const auto ladder_with = [&](const char* key, const json& value) {
    json changed = ladder;
    changed[key] = value;
    return with("/time_steps", changed);
  };
  return {
      {"steps empty", with("/time_steps", json::array()), "time_steps", {"empty list", "from"}},
      {"steps a number", with("/time_steps", 0.1), "time_steps", {"0.1", "list"}},
      {"step zero", with("/time_steps/1", 0), "time_steps[1]", {"is 0", "> 0"}},
      {"step negative", with("/time_steps/1", -0.1), "time_steps[1]", {"-0.1", "> 0"}},
      {"step a text", with("/time_steps/1", "0.1"), "time_steps[1]", {"\"0.1\"", "number"}},
      {"step twice", with("/time_steps/1", 0.1), "time_steps[1]", {"0.1", "second time"}},
      {"step between samples",
       with("/time_steps/1", 0.15),
       "time_steps[1]",
       {"0.15", "sample_every 0.5", "nearest is 0.166666666667"}},
      {"step beyond a sample",
       with("/time_steps/1", 0.9),
       "time_steps[1]",
       {"0.9", "nearest is 0.5"}},
      {"steps beyond counting",
       with("/time_steps/1", 1e-12),
       "time_steps[1]",
       {"1e-12", "1e12 of them"}},
      {"ladder's key unknown",
       ladder_with("cuont", 3),
       "time_steps.cuont",
       {"did you mean \"count\""}},
      {"ladder without end",
       with("/time_steps", {{"from", 0.1}, {"count", 3}}),
       "time_steps.to",
       {"missing", "> 0"}},
      {"ladder of one", ladder_with("count", 1), "time_steps.count", {"is 1", "2 to 1000"}},
      {"ladder downwards", ladder_with("from", 0.9), "time_steps.from", {"0.9", "below to", "0.5"}},
      {"ladder between samples",
       ladder_with("to", 0.4),
       "time_steps.to",
       {"0.4", "nearest is 0.5"}},
      {"ladder too fine", ladder_with("count", 40), "time_steps.count", {"40", "fewer"}},
      {"spacing unknown",
       ladder_with("spacing", "logarithmic"),
       "time_steps.spacing",
       {"logarithmic", "did you mean \"log\""}},
      {"duration a number", with("/duration", 100), "duration", {"100", "sample_every"}},
      {"duration's key unknown",
       with("/duration/equilibrat", 1),
       "duration.equilibrat",
       {"did you mean \"equilibrate\""}},
      {"measure missing", without("/duration", "measure"), "duration.measure", {"missing", "> 0"}},
      {"measure zero", with("/duration/measure", 0), "duration.measure", {"is 0", "> 0"}},
      {"equilibrate negative",
       with("/duration/equilibrate", -10),
       "duration.equilibrate",
       {"-10", ">= 0"}},
      {"sample_every beyond measure",
       with("/duration/sample_every", 200),
       "duration.sample_every",
       {"200", "from 1e-05 to 10"}},
      {"samples too few",
       with("/duration/sample_every", 20),
       "duration.sample_every",
       {"is 20", "5 samples", "to 10"}},
      {"samples too many",
       with("/duration/sample_every", 1e-6),
       "duration.sample_every",
       {"1e-06", "1e+08 samples"}},
      {"measure no multiple",
       with("/duration/measure", 100.2),
       "duration.measure",
       {"100.2", "sample_every 0.5", "100"}},
      {"equilibrate no multiple",
       with("/duration/equilibrate", 0.7),
       "duration.equilibrate",
       {"0.7", "for example 0.5"}},
  };
}

std::vector<BadStudy> bad_studies() {
  std::vector<BadStudy> all;
  for (const auto& part : {not_json(), bad_keys(), bad_scenes(), bad_methods(), bad_times()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

/// The message of the InputError; anything else thrown fails the test.
std::string message_of(const std::string& text, const std::string& source) {
  try {
    parse_study(text, source);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what();
  }
  return "";
}

void expect_one_sentence(const std::string& message) {
  EXPECT_LT(message.size(), 1000u);
  EXPECT_EQ(std::count_if(message.begin(), message.end(),
                          [](unsigned char c) { return c < 0x20 || c == 0x7f; }),
            0)
      << message;
  EXPECT_NO_THROW(json(message).dump()) << "not UTF-8";
}

TEST(BadStudies, each_give_one_sentence_with_file_path_value_and_what_is_allowed) {
  std::set<std::string> titles;
  for (const auto& bad : bad_studies()) {
    SCOPED_TRACE(bad.what);
    EXPECT_TRUE(titles.insert(bad.what).second);
    const std::string message = message_of(bad.text, "folder/bad.json");
    const std::string start = std::string("folder/bad.json: ") + bad.path;
    EXPECT_EQ(message.substr(0, start.size()), start);
    for (const char* part : bad.parts) {
      EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
    }
    expect_one_sentence(message);
    // A decimal point may stand inside a sentence, a full stop with more behind it may not.
    EXPECT_EQ(message.find(". "), std::string::npos) << message;
    if (std::getenv("DRIFTLESS_PRINT_MESSAGES")) std::printf("%s\n", message.c_str());
  }
  EXPECT_GE(titles.size(), 45u);
}

TEST(BadStudies, of_any_cut_and_any_changed_byte_throw_nothing_but_input_errors) {
  const std::string text = good_text;
  constexpr char bytes[] = "\0\x01\n\"\\{}[],:/*-+.eE019anN\x7f\x80\xff";
  std::vector<std::string> variants;
  for (std::size_t i = 0; i < text.size(); ++i) {
    variants.push_back(text.substr(0, i));
    variants.push_back(text.substr(0, i) + text.substr(i + 1));
    for (std::size_t byte = 0; byte + 1 < sizeof bytes; ++byte) {
      variants.push_back(text);
      variants.back()[i] = bytes[byte];
    }
  }
  std::size_t refused = 0;
  for (const auto& variant : variants) {
    try {
      parse_study(variant, "bad.json");
    } catch (const InputError& error) {
      ++refused;
      expect_one_sentence(error.what());
    }
  }
  EXPECT_GT(refused, variants.size() / 2);
}

class Files : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "driftless-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string message_of_file(const std::string& path) {
    try {
      read_study(path);
    } catch (const InputError& error) {
      expect_one_sentence(error.what());
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(Files, that_are_missing_folders_or_unreadable_are_named) {
  const std::string missing = (folder_ / "missing.json").string();
  EXPECT_EQ(message_of_file(missing).find(missing + ": cannot be read (No such file"), 0u);
  EXPECT_EQ(message_of_file(folder_.string()).find(folder_.string() + ": is a folder"), 0u);
  const auto loop = folder_ / "loop.json";
  std::filesystem::create_symlink(loop, loop);  // unreadable for every user
  EXPECT_EQ(message_of_file(loop.string()).find(loop.string() + ": cannot be read ("), 0u);
  const auto file = folder_ / "file.json";
  std::ofstream(file) << "{}";
  EXPECT_NE(message_of_file((file / "inside.json").string()).find("cannot be read ("),
            std::string::npos);
  EXPECT_EQ(message_of_file("").find(": cannot be read ("), 0u);
}

TEST_F(Files, are_read_and_give_the_study_its_name) {
  const auto file = folder_ / "first light.json";
  std::ofstream(file) << "\xef\xbb\xbf" << without("", "name");  // a byte order mark is no fault
  EXPECT_EQ(read_study(file.string()).name, "first light");
  std::ofstream(file) << good_text;
  EXPECT_EQ(read_study(file.string()).name, "a study");
  EXPECT_EQ(message_of_file(file.string()), "");
}

TEST_F(Files, with_odd_names_still_give_one_line) {
  const auto file = folder_ / "two\nlines\x1b.json";
  std::ofstream(file) << "[]";
  EXPECT_NE(message_of_file(file.string()).find("two?lines?.json: the whole file: "),
            std::string::npos);
}

TEST(Studies, hold_what_the_file_says) {
  const Study study = parse_study(good_text, "good.json");
  EXPECT_EQ(study.name, "a study");
  ASSERT_EQ(study.scenes.size(), 2u);
  EXPECT_EQ(study.scenes[0].name, "mackie-1999");
  EXPECT_EQ(study.scenes[0].fluid.friction_closure, FrictionClosure::noise);
  EXPECT_EQ(study.scenes[0].fluid.conduction, 850);
  EXPECT_EQ(study.scenes[1].particles, 200u);
  ASSERT_EQ(study.methods.size(), 2u);
  EXPECT_EQ(study.methods[0].name, "espanol");
  EXPECT_TRUE(study.methods[0].options.empty());
  EXPECT_EQ(study.methods[1].options.at("as_published"), OptionValue(true));
  EXPECT_EQ(study.time_steps, (std::vector<double>{0.1, 0.05}));
  EXPECT_EQ(study.equilibrate, 10);
  EXPECT_EQ(study.measure, 100);
  EXPECT_EQ(study.sample_every, 0.5);
  EXPECT_EQ(study.replicas, 3u);
  EXPECT_EQ(study.seed, 7u);
  EXPECT_EQ(steps_per_sample(study, 0.05), 10u);
}

TEST(Studies, written_out_read_back_the_same) {
  const json ladder = {{"from", 0.01}, {"to", 0.5}, {"count", 9}};
  const json three = {{{"preset", "mackie-1999"}},
                      {{"preset", "mackie-1999"}, {"heat_form", "temperature"}},
                      {{"preset", "soft-fluid"}, {"boltzmann", 0.3}, {"name", "cold"}}};
  for (const auto& text :
       {std::string(good_text), with("/methods", "all"), with("/time_steps", ladder),
        with("/scenes", three), with("/seed", 9007199254740991u)}) {
    const Study study = parse_study(text, "good.json");
    const json out = to_json(study);
    const Study again = parse_study(out.dump(), "again.json");
    EXPECT_EQ(to_json(again), out);
    EXPECT_EQ(again.time_steps, study.time_steps);
    EXPECT_EQ(again.seed, study.seed);
    ASSERT_EQ(again.methods.size(), study.methods.size());
    for (std::size_t i = 0; i < study.methods.size(); ++i) {
      EXPECT_EQ(again.methods[i].name, study.methods[i].name);
      EXPECT_EQ(again.methods[i].options, study.methods[i].options);
    }
    for (std::size_t i = 0; i < study.scenes.size(); ++i) {
      EXPECT_EQ(again.scenes[i].fluid, study.scenes[i].fluid);
      EXPECT_EQ(again.scenes[i].name, study.scenes[i].name);
    }
  }
}

TEST(Studies, have_defaults_for_name_replicas_and_seed) {
  json least = good();
  for (const char* key : {"name", "replicas", "seed", "scenes"}) least.erase(key);
  least["scene"] = {{"preset", "soft-fluid"}};
  const Study study = parse_study(least.dump(), "folder/least.json");
  EXPECT_EQ(study.name, "least");
  EXPECT_EQ(study.replicas, 2u);
  EXPECT_EQ(study.seed, 1u);
  ASSERT_EQ(study.scenes.size(), 1u);
  EXPECT_EQ(study.scenes[0].name, "soft-fluid");
}

TEST(Studies, take_whole_numbers_however_they_are_written) {
  const Study study = parse_study(written("\"replicas\": 3", "\"replicas\": 3.0e0"), "good.json");
  EXPECT_EQ(study.replicas, 3u);
}

TEST(Studies, name_scenes_of_one_preset_by_their_overrides) {
  const json scenes = {{{"preset", "mackie-1999"}},
                       {{"preset", "mackie-1999"}, {"friction_closure", "noise"}},
                       {{"preset", "mackie-1999"}, {"heat_capacity", 6}, {"friction", 0.5}},
                       {{"preset", "mackie-1999"}, {"name", "mine"}, {"particles", 64}},
                       {{"preset", "soft-fluid"}, {"particles", 81}}};
  const Study study = parse_study(with("/scenes", scenes), "good.json");
  std::vector<std::string> names;
  for (const auto& scene : study.scenes) names.push_back(scene.name);
  EXPECT_EQ(names, (std::vector<std::string>{"mackie-1999", "mackie-1999, friction_closure noise",
                                             "mackie-1999, heat_capacity 6, friction 0.5", "mine",
                                             "soft-fluid"}));
}

TEST(Methods, of_all_are_those_of_the_registry) {
  for (const json& all : {json("all"), json::array({"all"})}) {
    const Study study = parse_study(with("/methods", all), "good.json");
    ASSERT_EQ(study.methods.size(), methods().size());
    for (std::size_t i = 0; i < study.methods.size(); ++i) {
      EXPECT_EQ(study.methods[i].name, methods()[i]->name);
    }
  }
}

TEST(Methods, may_come_again_with_other_options) {
  const json twice = {"all", {{"name", "shardlow-s2"}, {"options", {{"as_published", true}}}}};
  EXPECT_EQ(parse_study(with("/methods", twice), "good.json").methods.size(), methods().size() + 1);
}

TEST(Ladders, keep_their_ends_and_divide_the_time_between_samples) {
  const json log = {{"from", 0.01}, {"to", 0.25}, {"count", 6}};
  const Study study = parse_study(with("/time_steps", log), "good.json");
  ASSERT_EQ(study.time_steps.size(), 6u);
  EXPECT_EQ(study.time_steps.front(), 0.01);
  EXPECT_EQ(study.time_steps.back(), 0.25);
  for (std::size_t i = 0; i < 6; ++i) {
    const double step = study.time_steps[i];
    EXPECT_NEAR(static_cast<double>(steps_per_sample(study, step)) * step, 0.5, 1e-12);
    EXPECT_NEAR(step / (0.01 * std::pow(25, static_cast<double>(i) / 5)), 1, 0.15);
  }
  const json linear = {{"from", 0.05}, {"to", 0.25}, {"count", 3}, {"spacing", "linear"}};
  const Study other = parse_study(with("/time_steps", linear), "good.json");
  EXPECT_NEAR(other.time_steps[1], 0.5 / 3, 1e-12);
}

TEST(Steps, may_be_rounded_decimals) {
  const Study study = parse_study(with("/time_steps", {0.1666666667, 0.5}), "good.json");
  EXPECT_EQ(steps_per_sample(study, study.time_steps[0]), 3u);
}

// What the reader takes the schema takes, and what breaks a key's rule breaks the schema too.
TEST(StudySchema, agrees_with_the_reader) {
  const json schema = study_schema();
  const auto errors = [&](const std::string& text) {
    return schema_errors(schema, json::parse(text));
  };
  EXPECT_EQ(schema_errors(schema, good()), std::vector<std::string>{});
  EXPECT_EQ(errors(to_json(parse_study(good_text, "good.json")).dump()),
            std::vector<std::string>{});
  EXPECT_EQ(errors(with("/methods", "all")), std::vector<std::string>{});
  EXPECT_EQ(errors(with("/time_steps", {{"from", 0.01}, {"to", 0.5}, {"count", 9}})),
            std::vector<std::string>{});
  // What no schema of one value can say: sums, products, names that must differ, JSON itself.
  const std::set<std::string> beyond = {"name of two lines",
                                        "too many runs",
                                        "nothing fluctuates",
                                        "phi below every number",
                                        "box too small",
                                        "no box is large enough",
                                        "half a pair",
                                        "pairs apart",
                                        "pairs that move",
                                        "pairs of density",
                                        "pairs without exchange",
                                        "fluid of pairs",
                                        "frozen under forces",
                                        "velocities too few",
                                        "velocities across a pair",
                                        "spread of a law",
                                        "start's temperature of a law",
                                        "names alike",
                                        "scenes alike",
                                        "method twice",
                                        "method twice by defaults",
                                        "method beside all",
                                        "step twice",
                                        "step between samples",
                                        "step beyond a sample",
                                        "steps beyond counting",
                                        "ladder downwards",
                                        "ladder between samples",
                                        "ladder too fine",
                                        "sample_every beyond measure",
                                        "samples too few",
                                        "samples too many",
                                        "measure no multiple",
                                        "equilibrate no multiple"};
  std::size_t seen = 0;
  for (const auto& part : {bad_keys(), bad_scenes(), bad_methods(), bad_times()}) {
    for (const auto& bad : part) {
      SCOPED_TRACE(bad.what);
      if (beyond.count(bad.what)) {
        ++seen;
      } else {
        const json study = json::parse(bad.text, nullptr, true, true);
        EXPECT_FALSE(schema_errors(schema, study).empty());
      }
    }
  }
  EXPECT_EQ(seen, beyond.size());
}

json sample_result() {
  const json observable = {{"mean", 1.1},
                           {"error", 1e-3},
                           {"effective_samples", 300.5},
                           {"degrees_of_freedom", 21.5},
                           {"replicas_disagree", true},
                           {"exact", 1.1},
                           {"unit", "T"},
                           {"status", "ok"},
                           {"deviation",
                            {{"value", 1e-3},
                             {"lower", 0},
                             {"upper", 3e-3},
                             {"below_noise", true},
                             {"bound", 4e-3},
                             {"resolution", 3e-3}}}};
  const json curve = {
      {"x", {0.1, 0.3}}, {"density", {1, 2}}, {"error", {0, 0.1}}, {"exact", {1.1, 1.9}}};
  const Study study = parse_study(good_text, "good.json");
  json parameters = to_json(study.scenes[0]);
  return {{"format", "driftless-result/1"},
          {"name", "a study"},
          {"provenance",
           {{"version", "0.1.0"},
            {"commit", "0123abc"},
            {"dirty", false},
            {"compiler", "g++"},
            {"flags", "-O3"},
            {"cpu", "a CPU"},
            {"threads", 4},
            {"seed", 7},
            {"date", "2024-02-29T12:00:00Z"},
            {"command", "driftless run good.json -o good"}}},
          {"study", to_json(study)},
          {"scenes",
           {{{"name", "mackie-1999"},
             {"preset", "mackie-1999"},
             {"parameters", parameters},
             {"relaxation_time", nullptr},
             {"resolves_internal_energy", false},
             {"kinetic_relaxation_time", 1.9},
             {"resolves_kinetic_energy", true},
             {"energy_per_particle", 56.4},
             {"note", "a note"}}}},
          {"methods",
           {{{"name", "shardlow-s1"},
             {"title", "a title"},
             {"reference", "a paper"},
             {"conserves", "momentum"},
             {"consistent", true},
             {"galilean", true}}}},
          {"cells",
           {{{"scene", "mackie-1999"},
             {"method", "shardlow-s1"},
             {"options", {{"as_published", true}}},
             {"time_step", 0.1},
             {"consistent", true},
             {"status", "unstable"},
             {"replicas", 3},
             {"failed_replicas", 1},
             {"conditioned_on_survival", true},
             {"observables", {{"kinetic_temperature", observable}}},
             {"failures",
              {{{"replica", 2}, {"cause", "non-finite number"}, {"step", 7}, {"time", 0.7}}}},
             {"off_equilibrium",
              {{"agrees", true},
               {"largest_z", 1.5},
               {"threshold", 5},
               {"observable", "internal_temperature"}}},
             {"curves", {{"momentum", curve}}},
             {"energy_trace", {{"time", {0, 1}}, {"energy", {0, -0.1}}}},
             {"cost",
              {{"core_seconds_per_time", nullptr},
               {"spread", 0.1},
               {"pair_evaluations_per_step", 4000},
               {"random_numbers_per_step", 8000},
               {"solver_iterations_per_step", 0},
               {"steps", 1100}}}},
            {{"scene", "mackie-1999"},
             {"method", "espanol"},
             {"options", json::object()},
             {"time_step", 0.1},
             {"consistent", true},
             {"status", "not_applicable"},
             {"reason", "another closure"},
             {"replicas", 3},
             {"failed_replicas", 0},
             {"conditioned_on_survival", false},
             {"observables", json::object()},
             {"failures", json::array()}}}},
          {"orders",
           {{{"scene", "mackie-1999"},
             {"method", "espanol"},
             {"observable", "kinetic_temperature"},
             {"order", 1.1},
             {"error", 0.1},
             {"points", 4}}}},
          {"answers",
           {{{"scene", "mackie-1999"},
             {"observable", "equilibrium"},
             {"tolerance", 0.01},
             {"level", 0.95},
             {"cells_compared", 0},
             {"resolution", nullptr},
             {"method", nullptr},
             {"time_step", nullptr},
             {"cost", nullptr},
             {"upper", nullptr},
             {"runner_up", nullptr},
             {"cheaper_inconsistent", nullptr},
             {"sentence", "No method."}}}}};
}

TEST(ResultSchema, takes_a_result) {
  EXPECT_EQ(schema_errors(result_schema(), sample_result()), std::vector<std::string>{});
  json answered = sample_result();
  answered["answers"][0].update(
      {{"method", "espanol"},
       {"time_step", 0.1},
       {"cost", 0.2},
       {"upper", 0.003},
       {"runner_up",
        {{"method", "shardlow-s1"}, {"time_step", 0.1}, {"cost", 1}, {"upper", 0.004}}}});
  EXPECT_EQ(schema_errors(result_schema(), answered), std::vector<std::string>{});
}

TEST(ResultSchema, refuses_what_is_no_result) {
  const std::vector<std::pair<const char*, json>> faults = {
      {"/format", "driftless-result/2"},
      {"/surplus", 1},
      {"/provenance/threads", 0},
      {"/provenance/date", "29 February"},
      {"/provenance/dirty", "no"},
      {"/study/time_steps/0", 0},
      {"/study/duration/measure", nullptr},
      {"/scenes/0/relaxation_time", "long"},
      {"/scenes/0/energy_per_particle", nullptr},
      {"/scenes/0/parameters/Particles", 3},
      {"/cells/0/status", "fine"},
      {"/cells/0/reason", "none is wanted"},
      {"/cells/0/time_step", -0.1},
      {"/cells/0/failed_replicas", 0.5},
      {"/cells/0/observables/Kinetic", json::object()},
      {"/cells/0/observables/kinetic_temperature/error", -1},
      {"/cells/0/observables/kinetic_temperature/exact", nullptr},
      {"/cells/0/observables/kinetic_temperature/status", "unknown"},
      {"/cells/0/observables/kinetic_temperature/deviation/upper", -1},
      {"/cells/0/observables/kinetic_temperature/deviation/noise", true},
      {"/cells/0/failures/0/step", "seven"},
      {"/cells/0/curves/energy", json::object()},
      {"/cells/0/curves/momentum/density/0", nullptr},
      {"/cells/0/cost/core_seconds_per_time", "cheap"},
      {"/cells/0/options/as_published", nullptr},
      {"/orders/0/points", -1},
      {"/cells/0/observables/kinetic_temperature/deviation/bound", -1},
      {"/cells/0/observables/kinetic_temperature/degrees_of_freedom", 0.5},
      {"/answers/0/tolerance", 0},
      {"/answers/0/level", 1},
      {"/answers/0/runner_up", json::object()},
  };
  for (const auto& [pointer, value] : faults) {
    json result = sample_result();
    result[json::json_pointer(pointer)] = value;
    EXPECT_FALSE(schema_errors(result_schema(), result).empty()) << pointer;
  }
}

TEST(ResultSchema, wants_every_part_that_is_not_optional) {
  const std::vector<std::pair<const char*, std::set<std::string>>> objects = {
      {"", {}},
      {"/provenance", {}},
      {"/study", {"format"}},
      {"/study/duration", {}},
      {"/scenes/0", {"note"}},
      {"/methods/0", {}},
      {"/cells/0", {"off_equilibrium", "curves", "energy_trace"}},
      {"/cells/1", {}},
      {"/cells/0/observables/kinetic_temperature",
       {"exact", "deviation", "degrees_of_freedom", "replicas_disagree"}},
      {"/cells/0/observables/kinetic_temperature/deviation", {"bound", "resolution"}},
      {"/cells/0/failures/0", {}},
      {"/cells/0/off_equilibrium", {}},
      {"/cells/0/curves/momentum", {"exact"}},
      {"/cells/0/energy_trace", {}},
      {"/orders/0", {}},
      {"/answers/0", {}}};
  for (const auto& [pointer, optional] : objects) {
    const json::json_pointer place(pointer);
    const json whole = sample_result().at(place);
    for (const auto& [key, value] : whole.items()) {
      json result = sample_result();
      result[place].erase(key);
      const bool complete = schema_errors(result_schema(), result).empty();
      EXPECT_EQ(complete, optional.count(key) == 1) << pointer << "/" << key;
    }
  }
}

TEST(SchemaErrors, name_the_deepest_place_once) {
  json result = sample_result();
  result["cells"][0]["failures"][0]["step"] = "seven";
  const auto errors = schema_errors(result_schema(), result);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].find("cells[0].failures[0].step: "), 0u) << errors[0];
}

}  // namespace
}  // namespace driftless
