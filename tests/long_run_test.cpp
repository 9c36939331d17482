// A run that was broken off and taken up again is the run that never stopped, to the last bit: its
// state, what its integrator keeps, what its observers have seen, and the files they write.

#include "experiments/long_run.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>

#include "experiments/checkpoint.hpp"
#include "experiments/fields.hpp"
#include "experiments/judge/wide_system.hpp"
#include "experiments/monitor.hpp"
#include "experiments/study.hpp"
#include "experiments/trajectory.hpp"
#include "tests/method_names.hpp"
#include "tests/small_system.hpp"

namespace driftless::testing {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double step_size = 0.004;
constexpr std::uint64_t last_step = 12;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// What a program is killed by.
struct Killed {};

class Killer : public Observer {
 public:
  explicit Killer(std::optional<std::uint64_t> at) : at_(at) {}
  void sample(System&, std::uint64_t step) override {
    if (at_ && step == *at_) throw Killed();
  }
  json save() override { return {}; }
  void load(const json&) override {}

 private:
  std::optional<std::uint64_t> at_;
};

/// All that a run leaves behind.
struct Remains {
  State state;
  std::vector<double> kept;
  json monitor, fields;
  std::string trajectory;
  std::uint64_t resumed_after = 0;
};

bool same_surroundings(const Surroundings& a, const Surroundings& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](const Received& one, const Received& other) {
    return one.momentum == other.momentum && one.energy == other.energy;
  });
}

bool same(const Remains& a, const Remains& b) {
  return same_bits(a.state, b.state) && a.state.species == b.state.species &&
         same_surroundings(a.state.surroundings, b.state.surroundings) && a.kept == b.kept &&
         a.monitor == b.monitor && a.fields == b.fields && a.trajectory == b.trajectory;
}

struct Setting {
  const Method* method = find_method("shardlow-s1");
  FluidParameters fluid;
  Box box = small_box();
  State start = {};  ///< small_state() if empty
  std::uint64_t last = last_step;
  unsigned threads = 1;
  double checkpoint_every = 1e9;  ///< seconds: at the end alone
  std::optional<std::uint64_t> killed_after;
  std::uint64_t frames_every = 3;
  json identity = {{"scene", "small"}, {"seed", 7}};
};

class LongRun : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '-');
    folder_ = fs::path(::testing::TempDir()) / ("driftless-long-run-" + name);
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path checkpoint() const { return folder_ / "checkpoint"; }

  /// A program that makes everything anew and finds what another left in the folder.
  Remains program(const Setting& setting) const {
    System system(Fluid(setting.fluid), setting.box,
                  setting.start.size() > 0 ? setting.start : small_state(setting.fluid),
                  Noise(7, 0));
    const auto integrator = setting.method->make({});
    Trajectory trajectory(folder_ / "trajectory.xyz", step_size);
    Monitor monitor(system, step_size, 3 * static_cast<double>(system.size() - 1));
    Fields fields(system, {2, 1, 2});
    Killer killer(setting.killed_after);
    LongRunPlan plan;
    plan.identity = setting.identity;
    plan.identity["method"] = setting.method->name;
    plan.time_step = step_size;
    plan.last = setting.last;
    plan.checkpoint_every = setting.checkpoint_every;
    const auto end = long_run(system, *integrator, plan,
                              {{"trajectory", &trajectory, setting.frames_every, 0},
                               {"monitor", &monitor, 2, 0},
                               {"fields", &fields, 1, 2},
                               {"killer", &killer, 1, 0}},
                              checkpoint(), setting.threads);
    return {system.state(),
            integrator->save(),
            monitor.save(),
            fields.save(),
            content(folder_ / "trajectory.xyz"),
            end.resumed_after};
  }

  void start_anew() const {
    fs::remove(checkpoint());
    fs::remove(folder_ / "trajectory.xyz");
  }

  /// The first sentence that a run complains with.
  std::string complaint(const Setting& setting) const {
    try {
      program(setting);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no complaint";
  }

  fs::path folder_;
};

Setting setting_for(const Method& method) {
  Setting setting;
  setting.method = &method;
  setting.fluid = small_fluid({method.closures.front(), HeatForm::temperature, true}, 0.5);
  return setting;
}

/// Walls and gravity beside it, and particles of two species.
Setting bounded_setting_for(const Method& method) {
  Setting setting = setting_for(method);
  const Wall wall{.temperature = 1.6, .repulsion = 20, .friction = 5, .conduction = 7};
  setting.box.walls[0] = setting.box.walls[1] = wall;
  setting.box.gravity = Vector(-0.4, 0, 0);
  setting.fluid.further_species = {{.mass = 2.5, .heat_capacity = 20}};
  setting.start = small_state(setting.fluid);
  for (std::size_t i = 0; i < setting.start.size(); ++i) {
    setting.start.species.push_back(i % 3 == 0 ? 1 : 0);
  }
  return setting;
}

class LongRunOf : public LongRun, public ::testing::WithParamInterface<const Method*> {};

TEST_P(LongRunOf, GoesOnWithTheSameBits) {
  Setting setting = setting_for(*GetParam());
  const auto whole = program(setting);
  EXPECT_GT(distance(small_box(), whole.state, small_state(setting.fluid)).velocity, 0.1);
  for (const std::uint64_t stop : {1, 5, 11, 12}) {
    start_anew();
    setting.last = stop;
    program(setting);
    setting.last = last_step;
    const auto resumed = program(setting);
    EXPECT_EQ(resumed.resumed_after, stop);
    EXPECT_TRUE(same(resumed, whole)) << stop;
  }
}

TEST_P(LongRunOf, GoesOnWithTheSameBitsBetweenWalls) {
  Setting setting = bounded_setting_for(*GetParam());
  const auto whole = program(setting);
  EXPECT_NE(whole.state.surroundings[0].energy, 0);
  start_anew();
  setting.last = 5;
  program(setting);
  setting.last = last_step;
  EXPECT_TRUE(same(program(setting), whole));
}

TEST_P(LongRunOf, GoesOnWithTheSameBitsAfterAKill) {
  Setting setting = setting_for(*GetParam());
  const auto whole = program(setting);
  start_anew();
  setting.checkpoint_every = 0;  // after every step
  for (const std::uint64_t killed : {3, 4, 9}) {
    setting.killed_after = killed;
    EXPECT_THROW(program(setting), Killed);
  }
  setting.killed_after.reset();
  const auto resumed = program(setting);
  EXPECT_EQ(resumed.resumed_after, 8U);
  EXPECT_TRUE(same(resumed, whole));
}

/// Leaves something out of the checkpoint that lies there.
void rob(const fs::path& path, const std::function<void(Checkpoint&)>& change) {
  auto robbed = read_checkpoint(path, json::from_cbor(content(path)).at("identity"));
  ASSERT_TRUE(robbed);
  change(*robbed);
  write_checkpoint(path, *robbed);
}

/// A checkpoint without what the integrator keeps is seen by the comparison of these tests.
TEST_P(LongRunOf, WithoutWhatItsIntegratorKeepsIsAnother) {
  Setting setting = setting_for(*GetParam());
  const auto whole = program(setting);
  if (whole.kept.empty()) return;  // that some methods keep something is tested below
  start_anew();
  setting.last = 5;
  program(setting);
  rob(checkpoint(), [](Checkpoint& robbed) { robbed.integrator.clear(); });
  setting.last = last_step;
  EXPECT_FALSE(same(program(setting), whole));
}

INSTANTIATE_TEST_SUITE_P(Methods, LongRunOf, ::testing::ValuesIn(methods()), test_name);

TEST_F(LongRun, WithoutSurroundingsOrSpeciesIsAnother) {
  Setting setting = bounded_setting_for(*find_method("shardlow-s1"));
  const auto whole = program(setting);
  const std::vector<std::function<void(Checkpoint&)>> robberies = {
      [](Checkpoint& robbed) { robbed.state.surroundings = {}; },
      [](Checkpoint& robbed) { robbed.state.species.assign(27, 0); }};
  for (const auto& robbery : robberies) {
    start_anew();
    setting.last = 5;
    program(setting);
    rob(checkpoint(), robbery);
    setting.last = last_step;
    EXPECT_FALSE(same(program(setting), whole));
  }
}

TEST_F(LongRun, SomeMethodsKeepSomething) {
  std::size_t keeping = 0;
  for (const Method* method : methods()) {
    start_anew();
    if (!program(setting_for(*method)).kept.empty()) ++keeping;
  }
  EXPECT_GE(keeping, 3U);
}

TEST_F(LongRun, IsTheSameForAnyNumberOfThreadsBeforeAndAfterTheRestart) {
  Setting setting;
  setting.fluid = judge::wide_fluid(FrictionClosure::noise);
  setting.box = judge::wide_box();
  setting.start = judge::wide_state(setting.fluid);
  const auto whole = program(setting);
  start_anew();
  setting.last = 5;
  setting.threads = 3;
  program(setting);
  setting.last = last_step;
  setting.threads = 2;
  EXPECT_TRUE(same(program(setting), whole));
}

TEST_F(LongRun, IsTheSameWithoutObserversAndCheckpoints) {
  for (const auto* name : {"averaged-drift", "velocity-verlet", "shardlow-aboba", "trotter"}) {
    start_anew();
    Setting setting = setting_for(*find_method(name));
    setting.checkpoint_every = 0;
    const auto observed = program(setting);
    System system(Fluid(setting.fluid), small_box(), small_state(setting.fluid), Noise(7, 0));
    const auto integrator = setting.method->make({});
    run(*integrator, system, step_size, 1, last_step + 1);
    EXPECT_TRUE(same_bits(system.state(), observed.state)) << name;
  }
}

TEST_F(LongRun, CutsTheTrajectoryBackToTheCheckpoint) {
  Setting setting = setting_for(*find_method("trotter"));
  const auto whole = program(setting);
  start_anew();
  setting.last = 4;
  program(setting);
  const std::string early = content(checkpoint());
  setting.last = 10;
  const auto later = program(setting);
  std::ofstream(checkpoint(), std::ios::binary) << early;  // killed before another was written
  setting.last = last_step;
  const auto resumed = program(setting);
  EXPECT_EQ(resumed.resumed_after, 4U);
  EXPECT_TRUE(same(resumed, whole));
  // The comparison sees frames that were left standing.
  EXPECT_NE(later.trajectory + whole.trajectory.substr(later.trajectory.size() / 2),
            whole.trajectory);
}

TEST_F(LongRun, RefusesATrajectoryThatIsShorterThanItWas) {
  Setting setting = setting_for(*find_method("trotter"));
  setting.last = 4;
  program(setting);
  fs::resize_file(folder_ / "trajectory.xyz", 100);
  setting.last = last_step;
  EXPECT_NE(complaint(setting).find("trajectory.xyz: holds 100 bytes, but "), std::string::npos)
      << complaint(setting);
}

TEST_F(LongRun, RefusesTheCheckpointOfAnotherRun) {
  const Setting setting = setting_for(*find_method("shardlow-s1"));
  program(setting);
  const auto expect = [&](const Setting& other, const std::string& part) {
    EXPECT_NE(complaint(other).find("checkpoint: is the checkpoint " + part), std::string::npos)
        << complaint(other);
  };
  Setting other = setting_for(*find_method("trotter"));
  expect(other, "of another run: method is \"shardlow-s1\" there and \"trotter\" here; allowed is");
  other = setting;
  other.identity["seed"] = 8;
  expect(other, "of another run: seed is 7 there and 8 here; allowed is");
  other = setting;
  other.frames_every = 4;
  expect(other,
         "of another run: trajectory/steps between samples is 3 there and 4 here; allowed is");
  other = setting;
  other.last = 4;
  expect(other, "after step 12 (time 0.048), beyond the end of this run after step 4");
}

TEST_F(LongRun, RefusesWhatIsNoWholeCheckpoint) {
  const Setting setting = setting_for(*find_method("shardlow-s1"));
  program(setting);
  const std::string whole = content(checkpoint());
  json other = json::from_cbor(whole);
  other["format"] = "driftless-checkpoint/0";
  std::string older;
  json::to_cbor(other, older);
  for (const auto& text : {std::string("{}"), std::string(), whole.substr(0, whole.size() / 2)}) {
    std::ofstream(checkpoint(), std::ios::binary) << text;
    EXPECT_NE(complaint(setting).find("checkpoint: is no checkpoint that this program can read"),
              std::string::npos);
  }
  std::ofstream(checkpoint(), std::ios::binary) << older;
  EXPECT_NE(complaint(setting).find("its format is \"driftless-checkpoint/0\""), std::string::npos);
}

TEST_F(LongRun, SaysWhichStepFailed) {
  Setting setting = setting_for(*find_method("averaged-drift"));
  setting.fluid.friction = 1000;
  System system(Fluid(setting.fluid), small_box(), small_state(setting.fluid), Noise(7, 0));
  const auto integrator = setting.method->make({});
  LongRunPlan plan;
  plan.time_step = 1;
  plan.last = 500;
  try {
    long_run(system, *integrator, plan, {}, {}, 1);
    FAIL() << "a step of 1 should break";
  } catch (const LongRunFailure& failure) {
    EXPECT_EQ(failure.time(), static_cast<double>(failure.step()));
    EXPECT_NE(std::string(failure.what())
                  .find(to_string(failure.cause()) + " in step " + std::to_string(failure.step()) +
                        " (time "),
              std::string::npos)
        << failure.what();
  }
}

TEST_F(LongRun, CountsTheWholeRun) {
  Setting setting = setting_for(*find_method("shardlow-s1"));
  const auto counted = [&](std::uint64_t last, const fs::path& path) {
    System system(Fluid(setting.fluid), small_box(), small_state(setting.fluid), Noise(7, 0));
    const auto integrator = setting.method->make({});
    LongRunPlan plan;
    plan.time_step = step_size;
    plan.last = last;
    return long_run(system, *integrator, plan, {}, path, 1).counters;
  };
  const auto whole = counted(last_step, {});
  counted(5, checkpoint());
  const auto resumed = counted(last_step, checkpoint());
  EXPECT_EQ(resumed.random_numbers, whole.random_numbers);
  // Not fewer, and at most one evaluation of the forces more than the run needs.
  EXPECT_GE(resumed.pair_evaluations, whole.pair_evaluations);
  EXPECT_LE(resumed.pair_evaluations, whole.pair_evaluations + 27 * 26 / 2);
}

}  // namespace
}  // namespace driftless::testing
