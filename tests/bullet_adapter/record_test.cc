// SPDX-License-Identifier: MIT
// Frames of worlds in files: what was solved, to the bit, without disturbing the world.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "cairn/solver.h"
#include "tests/bullet_adapter/scene_world.h"
#include "tests/simd/ask_for.h"

namespace cairn::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder that is not there yet, of this precision.
std::string FreshFolder(const std::string& name) {
  const std::string folder =
      testing::TempDir() + "/record" + std::to_string(8 * sizeof(btScalar)) + "_" + name;
  fs::remove_all(folder);
  return folder;
}

/// CAIRN_RECORD while it lives.
class RecordInto {
 public:
  RecordInto(const std::string& folder, const char* frames) {
    setenv("CAIRN_RECORD", folder.c_str(), 1);
    setenv("CAIRN_RECORD_FRAMES", frames, 1);
  }
  ~RecordInto() {
    unsetenv("CAIRN_RECORD");
    unsetenv("CAIRN_RECORD_FRAMES");
  }
};

std::string BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Recording Read(const std::string& path) {
  Recording recording;
  const RecordingStatus status = Load(path, &recording);
  EXPECT_TRUE(status.ok()) << path << " " << status.message;
  return recording;
}

std::vector<double> SolveNext(Solver* solver, Recording recording) {
  solver->settings() = recording.settings;
  if (recording.replay) solver->settings().tuning.replay = &*recording.replay;
  std::vector<Velocity> velocities(recording.bodies.size());
  const Impulses impulses = recording.impulses();
  EXPECT_TRUE(solver->Solve(recording.problem(), impulses, velocities).ok());
  return AllImpulses(recording.problem(), impulses);
}

std::vector<double> SolveAlone(const Recording& recording) {
  Solver solver;
  return SolveNext(&solver, recording);
}

std::vector<double> Shown(const bullet::ConstraintSolver& solver) {
  const std::span<const double> impulses = solver.impulses();
  return {impulses.begin(), impulses.end()};
}

class RecordedScene : public testing::TestWithParam<std::string_view> {};

TEST_P(RecordedScene, IsTheSameFileAndHasTheSameBitsOnEveryInstructionSet) {
  const std::string folder = FreshFolder(std::string(GetParam()));
  std::string first;
  std::vector<double> solved;
  for (const simd::Target target : simd::SupportedTargets()) {
    const AskFor asked(target);
    const RecordInto into(folder, "20");
    bullet::ConstraintSolver solver(Settings{.method = Method::kPgs});
    SceneWorld world(GetParam(), &solver);
    world.Step(21);
    ASSERT_EQ(solver.recorded().written, 1) << solver.recorded().last_failure;
    const std::string file = solver.recorded().last_file;
    if (first.empty()) {
      first = BytesOf(file);
      solved = SolveAlone(Read(file));
    }
    EXPECT_TRUE(BytesOf(file) == first) << simd::TargetName(target);
    EXPECT_TRUE(SolveAlone(Read(file)) == solved) << simd::TargetName(target);
  }
  const Recording recording = Read(folder + "/world-1/frame-000020.cairn");
  EXPECT_EQ(recording.frame, 20);
  EXPECT_THAT(recording.source, HasSubstr(sizeof(btScalar) == 4 ? "float" : "float64"));
}

// With the frames before it, which decide about colours and steps, a frame is that of the game.
void ExpectGameAgain(std::string_view scene, const Settings& settings) {
  const std::string folder = FreshFolder("game_" + std::string(scene));
  const RecordInto into(folder, "");
  bullet::ConstraintSolver solver(settings);
  SceneWorld world(scene, &solver);
  Solver again;
  for (int frame = 0; frame < 25; ++frame) {
    world.Step(1);
    if (solver.problem().bodies.empty()) continue;
    ASSERT_TRUE(SolveNext(&again, Read(solver.recorded().last_file)) == Shown(solver)) << frame;
  }
  EXPECT_GT(solver.recorded().written, 20);
  fs::remove_all(folder);
}

TEST_P(RecordedScene, PlayedFromItsFirstFrameIsTheGameToTheBit) {
  ExpectGameAgain(GetParam(), {});
  ExpectGameAgain(GetParam(), {.budget = Budget::Time(std::chrono::milliseconds(2))});
}

INSTANTIATE_TEST_SUITE_P(Every, RecordedScene, testing::ValuesIn(SceneNames()), SceneTestName());

std::uint64_t HashOfTower(bullet::ConstraintSolver* solver) {
  SceneWorld world("tower", solver);
  world.Step(30);
  return bench::StateHash(world.world());
}

TEST(RecordedWorld, IsTheSameWorld) {
  bullet::ConstraintSolver alone;
  const std::uint64_t expected = HashOfTower(&alone);
  EXPECT_EQ(alone.recorded().written, 0);

  const std::string folder = FreshFolder("same");
  {
    const RecordInto into(folder, "");
    bullet::ConstraintSolver solver;
    EXPECT_EQ(HashOfTower(&solver), expected);
    EXPECT_EQ(solver.recorded().written, 30);
  }
  fs::remove_all(folder);
  std::ofstream(folder) << "no folder";
  const RecordInto into(folder, "");
  bullet::ConstraintSolver solver;
  EXPECT_EQ(HashOfTower(&solver), expected);
  EXPECT_EQ(solver.recorded().written, 0);
  EXPECT_EQ(solver.recorded().failed, 1);
  EXPECT_THAT(solver.recorded().last_failure, HasSubstr(folder));
  EXPECT_EQ(solver.complaint(), solver.recorded().last_failure);
}

TEST(RecordedWorld, MayBeOneOfBulletsOwnRows) {
  const std::string folder = FreshFolder("reference");
  fs::create_directories(folder);
  bullet::ConstraintSolver solver(Settings{.method = Method::kPgs},
                                  {.mode = bullet::Mode::kReference});
  SceneWorld world("tower", &solver);
  world.Step(10);
  solver.RecordNext(folder + "/tower.cairn", 10);
  world.Step(1);
  EXPECT_EQ(solver.recorded().written, 1);
  const Recording recording = Read(folder + "/tower.cairn");
  EXPECT_EQ(recording.frame, 10);
  EXPECT_TRUE(SolveAlone(recording) == Shown(solver));
  world.Step(1);
  EXPECT_EQ(solver.recorded().written, 1);
}

// What made a game fail is what one wants to look at.
TEST(RecordedWorld, MayBeOneThatIsRefused) {
  const std::string folder = FreshFolder("refused");
  fs::create_directories(folder);
  bullet::ConstraintSolver solver;
  SceneWorld world("tower", &solver);
  world.Step(5);
  const btScalar none = std::numeric_limits<btScalar>::quiet_NaN();
  world.world().dynamic_bodies()[0]->setLinearVelocity(btVector3(none, 0, 0));
  solver.RecordNext(folder + "/nan.cairn");
  world.Step(1);
  EXPECT_TRUE(solver.fell_back());
  EXPECT_EQ(solver.recorded().written, 1);
  Recording recording = Read(folder + "/nan.cairn");
  EXPECT_FALSE(recording.manifolds.empty()) << "not what Bullet made of it";
  EXPECT_EQ(recording.frame, -1) << "nobody said which it is";
  std::vector<Velocity> velocities(recording.bodies.size());
  const Impulses impulses = recording.impulses();
  EXPECT_EQ(Solver(recording.settings).Solve(recording.problem(), impulses, velocities).status,
            Status::kNotFinite);
}

}  // namespace
}  // namespace cairn::test
