// SPDX-License-Identifier: MIT
#include "play/session.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <vector>

#include "cairn/detail/recording.h"
#include "examples/debug_draw.h"
#include "examples/fixed_steps.h"
#include "run/solver_run.h"
#include "scenes/facts.h"
#include "support/failure.h"
#include "worlds/random_world.h"

namespace cairn::play {
namespace {

using bench::StateHash;

Controls Of(const std::string& scene, int size = 0) {
  Controls controls;
  controls.scene = {.scene = scene, .size = size, .seed = 0};
  return controls;
}

void Steps(Session* session, int count) {
  for (int i = 0; i < count; ++i) session->Step();
}

/// The state after so many frames of `cairn run SCENE --solver SOLVER`.
std::uint64_t RunHash(const std::string& scene, const std::string& size, const std::string& solver,
                      int frames) {
  const std::vector<cli::SolverChoice> choices = cli::ParseSolvers(solver);
  cli::SolverRun run(cli::ParseScene(scene, size), choices.front(), cli::RunOptions{});
  for (int i = 0; i < frames; ++i) run.Step(cli::SolverRun::Observing::kOff);
  return StateHash(run.world());
}

TEST(Session, HasTheBitsOfARun) {
  const std::vector<std::pair<std::string, int>> scenes = {
      {"castle", 1}, {"bridge", 0}, {"ragdolls", 4}, {"heavy-top", 0}};
  for (const auto& [scene, size] : scenes) {
    SCOPED_TRACE(scene);
    const std::string typed = size == 0 ? "" : std::to_string(size);
    Session session(Of(scene, size));
    Steps(&session, 80);
    EXPECT_EQ(StateHash(session.player(0).world()), RunHash(scene, typed, "bullet-si", 80));
    EXPECT_EQ(StateHash(session.player(1).world()), RunHash(scene, typed, "cairn", 80));
    EXPECT_NE(StateHash(session.player(0).world()), StateHash(session.player(1).world()));
  }
}

TEST(Session, HasTheBitsOfARandomWorld) {
  Controls controls = Of("random");
  controls.scene.seed = 17;
  Session session(controls);
  Steps(&session, 30);

  bullet::ConstraintSolver solver;
  bench::RandomWorld world({.seed = 17}, &solver);
  world.world().solver_info().m_numIterations = 10;
  for (int i = 0; i < 30; ++i) world.Step();
  EXPECT_EQ(StateHash(session.player(1).world()), StateHash(world.world()));
}

TEST(Session, DrawingPausingAndMeasuringChangeNoBit) {
  Session plain(Of("tower")), busy(Of("tower"));
  struct NoDraw : examples::DebugDraw {
    void Line(const Point&, const Point&, unsigned) override { ++lines; }
    void Dot(const Point&, unsigned) override { ++dots; }
    int lines = 0, dots = 0;
  } draw;
  for (int i = 0; i < 40; ++i) {
    busy.controls().paused = i % 2 == 0;
    busy.controls().measure = i % 3 == 0;
    busy.controls().players[1].threads = 1 + i % 2;
    plain.Step();
    busy.Step();
    const bench::World& world = busy.player(1).world();
    examples::DrawContacts(*world.bullet(), world.time_step(), &draw);
    bench::FactsOfIsland(world, 3);
  }
  EXPECT_EQ(StateHash(plain.player(1).world()), StateHash(busy.player(1).world()));
  EXPECT_GT(draw.dots, 40);
  EXPECT_GT(draw.lines, 40);
}

// A box of 3 kg at rest: what pushes up at its corners is its weight, half a metre together.
TEST(DebugDraw, ImpulsesAreAsLongAsTheWeightTheyCarry) {
  btSequentialImpulseConstraintSolver solver;
  bench::World world(&solver);
  world.AddGround(10);
  world.AddBox(btVector3(1, 1, 1), {.mass = 3, .pose = bench::At(0, 1, 0)});
  for (int i = 0; i < 60; ++i) world.Step();
  struct Sum : examples::DebugDraw {
    void Line(const Point& from, const Point& to, unsigned) override { up += to.y - from.y; }
    void Dot(const Point&, unsigned) override { ++dots; }
    double up = 0;
    int dots = 0;
  } sum;
  examples::DrawContacts(*world.bullet(), world.time_step(), &sum);
  EXPECT_EQ(sum.dots, 4);
  EXPECT_NEAR(sum.up, 0.5, 0.01);  // ten iterations end within that
}

TEST(Session, RestartBeginsAgain) {
  Session session(Of("wall"));
  const std::uint64_t start = StateHash(session.player(0).world());
  Steps(&session, 5);
  EXPECT_NE(StateHash(session.player(0).world()), start);
  session.Restart();
  EXPECT_EQ(StateHash(session.player(0).world()), start);
  EXPECT_EQ(session.frame(), 0);
  EXPECT_TRUE(session.player(0).history().empty());
}

TEST(Session, ASceneThatIsNotThereLeavesAllAsItWas) {
  Session session(Of("wall"));
  Steps(&session, 3);
  session.controls().scene.scene = "wal lpaper";
  EXPECT_THROW(session.Restart(), cli::Failure);
  EXPECT_EQ(session.frame(), 3);
  session.controls().scene.scene = "no/such/file.bullet";
  EXPECT_THROW(session.Restart(), cli::Failure);
  Steps(&session, 1);
  EXPECT_EQ(session.frame(), 4);
}

TEST(Session, SolversChangeWhileItRuns) {
  Session session(Of("pyramid"));
  Steps(&session, 5);
  EXPECT_EQ(session.player(1).solver().name, "cairn");
  const double height = bench::TopHeight(session.player(1).world());
  session.controls().players[1].solver = "bullet-nncg";
  session.Step();
  EXPECT_EQ(session.player(1).solver().name, "bullet-nncg");
  EXPECT_EQ(session.player(1).cairn(), nullptr);
  EXPECT_NEAR(bench::TopHeight(session.player(1).world()), height, 0.01);  // the same world
  session.controls().players[1].solver = "cairn";
  Steps(&session, 2);
  EXPECT_NE(session.player(1).cairn(), nullptr);
}

TEST(Session, SettingsReachTheSolver) {
  Session session(Of("pyramid"));
  PlayerControls& right = session.controls().players[1];
  right.threads = 3;
  right.steps = false;
  right.acceleration = false;
  right.iterations = 7;
  session.controls().rate = 120;
  session.Step();
  const Settings& settings = session.player(1).cairn()->settings();
  EXPECT_EQ(settings.threads, 3);
  EXPECT_FALSE(settings.steps);
  EXPECT_EQ(settings.acceleration, Acceleration::kNone);
  EXPECT_EQ(settings.budget, Budget::Unlimited());
  EXPECT_EQ(session.player(1).world().bullet()->getSolverInfo().m_numIterations, 7);
  EXPECT_EQ(session.player(1).world().time_step(), btScalar(1) / 120);

  right.budget = kFixed;
  right.budget_ms = 1.5;
  session.Step();
  EXPECT_EQ(settings.budget, Budget::Time(std::chrono::microseconds(1500)));
  right.budget = kRest;
  session.SetRest(std::chrono::milliseconds(3));
  session.Step();
  EXPECT_EQ(settings.budget, Budget::Time(std::chrono::milliseconds(3)));
  right.budget = kMatch;
  session.Step();
  ASSERT_EQ(settings.budget.kind(), Budget::Kind::kTime);
  EXPECT_GT(settings.budget.time().count(), 0);
  EXPECT_LT(settings.budget.time(), std::chrono::seconds(1));
}

TEST(Session, ADraggedBodyFollowsInBothWorlds) {
  Session session(Of("wall"));
  Steps(&session, 5);
  const int body = 104;  // in the top course
  const btVector3 from =
      session.player(0).world().dynamic_bodies()[body]->getCenterOfMassPosition();
  session.Grab(body, from);
  for (int i = 0; i < 60; ++i) {
    session.Move(from + btVector3(0, btScalar(0.03) * btScalar(std::min(i, 50)), 0));
    session.Step();
  }
  for (int side : {0, 1}) {
    const btRigidBody* held = session.player(side).world().dynamic_bodies()[body];
    EXPECT_NEAR(held->getCenterOfMassPosition().y(), from.y() + 1.5, 0.3) << side;
    EXPECT_EQ(session.player(side).world().bullet()->getNumConstraints(), 1);
  }
  session.Release();
  Steps(&session, 10);
  EXPECT_EQ(session.player(0).world().bullet()->getNumConstraints(), 0);
  EXPECT_LT(session.player(1).world().dynamic_bodies()[body]->getLinearVelocity().y(), -0.5);
}

TEST(Session, ABallFliesIntoEachWorld) {
  Session session(Of("wall"));
  session.controls().ball_speed = 10;
  session.Shoot(btVector3(0, 1, 8), btVector3(0, 0, -3));
  for (int side : {0, 1}) {
    const bench::World& world = session.player(side).world();
    EXPECT_EQ(world.dynamic_bodies().size(), 106u);
    EXPECT_NEAR(world.dynamic_bodies().back()->getLinearVelocity().z(), -10, 1e-5);
  }
  Steps(&session, 60);  // 6 m before it meets something
  EXPECT_LT(session.player(1).world().dynamic_bodies().back()->getCenterOfMassPosition().z(), 4);
}

TEST(Session, ARayPicksTheBodyItMeetsAndItsIsland) {
  Session session(Of("tower"));
  Steps(&session, 3);
  btVector3 at;
  const int body = session.player(1).Pick(btVector3(0, btScalar(0.5), 20),
                                          btVector3(0, btScalar(0.5), -20), &at);
  ASSERT_GE(body, 0);
  EXPECT_EQ(session.player(1).Pick(btVector3(50, 90, 20), btVector3(50, 90, -20), &at), -1);
  const bench::IslandFacts facts = bench::FactsOfIsland(session.player(1).world(), body);
  EXPECT_EQ(facts.bodies, 30);
  EXPECT_GT(facts.contacts, 100);
  EXPECT_FALSE(facts.asleep);
  const std::optional<IslandReport> report = session.player(1).ReportOf(body);
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->bodies, 30);
  EXPECT_FALSE(session.player(0).ReportOf(body).has_value());  // Bullet says nothing
}

TEST(Session, BodiesSleepWhenTheyMay) {
  Session session(Of("slab"));
  session.controls().sleep = true;
  Steps(&session, 400);
  EXPECT_GT(session.player(1).history().back().asleep, 0);
  session.controls().sleep = false;
  session.Step();
  EXPECT_EQ(session.player(1).history().back().asleep, 0);
}

TEST(Session, AFrameIsSavedForEachSolver) {
  const std::string folder = std::filesystem::temp_directory_path() / "cairn_play_session_test";
  std::filesystem::create_directories(folder);
  Session session(Of("tower"));
  Steps(&session, 3);
  session.Save(folder + "/frame.cairn");
  session.Step();
  for (const char* side : {"left", "right"}) {
    Recording recording;
    ASSERT_TRUE(Load(folder + "/frame-" + side + ".cairn", &recording).ok()) << side;
    EXPECT_EQ(recording.bodies.size(), 30u);
  }
  EXPECT_THAT(session.player(0).saved(), testing::StartsWith("written"));
  session.controls().players = {PlayerControls{}, PlayerControls{.solver = "bullet-nncg"}};
  session.Save(folder + "/other.cairn");
  session.Step();
  for (const int side : {0, 1}) {
    EXPECT_THAT(session.player(side).saved(), testing::StartsWith("written")) << side;
  }
  session.Save(folder + "/late.cairn");
  session.controls().players[0].solver = "bullet-si";  // who was asked is gone before the step
  session.Step();
  EXPECT_FALSE(std::filesystem::exists(folder + "/late-left.cairn"));
  EXPECT_TRUE(std::filesystem::exists(folder + "/late-right.cairn"));
  session.Save(folder + "/no/such/folder/frame.cairn");
  session.Step();
  EXPECT_THAT(session.player(1).saved(), testing::StartsWith("cannot write"));
  std::filesystem::remove_all(folder);
}

TEST(Session, StatisticsAreThoseOfTheWorld) {
  Session session(Of("bridge"));
  Steps(&session, 20);
  for (int side : {0, 1}) {
    const Player& player = session.player(side);
    ASSERT_EQ(player.history().size(), 20u);
    const Sample& last = player.history().back();
    EXPECT_EQ(last.energy, bench::TotalEnergy(player.world()));
    EXPECT_EQ(last.joint_gap, bench::LargestJointGap(player.world()));
    EXPECT_GT(last.solver_ms, 0);
    EXPECT_GT(last.world_ms, 0);
    EXPECT_GT(player.MeanSolverTime(), 0);
  }
  EXPECT_GT(session.player(0).history().back().residual,
            session.player(1).history().back().residual);
  Steps(&session, 300);
  EXPECT_EQ(session.player(0).history().size(), Player::kMostHistory);
}

TEST(Session, APoseIsBetweenTheLastTwo) {
  Session session(Of("rubble", 27));
  Steps(&session, 4);
  const btRigidBody* body = session.player(0).world().dynamic_bodies()[3];
  const btVector3 then = body->getWorldTransform().getOrigin();
  session.Step();
  const btVector3 now = body->getWorldTransform().getOrigin();
  const btVector3 middle = session.player(0).Pose(*body, btScalar(0.5)).getOrigin();
  EXPECT_LT((middle - (then + now) / 2).length(), 1e-6);
  EXPECT_EQ(session.player(0).Pose(*body, 1).getOrigin(), now);
}

TEST(Controls, FieldsHaveNamesOfTheirOwnAndRefuseWhatTheyCannotBe) {
  Controls controls;
  std::set<std::string> names;
  for (const Field& field : Fields(&controls)) {
    EXPECT_TRUE(names.insert(field.name).second) << field.name;
    if (!std::holds_alternative<std::string*>(field.value) || !field.words.empty()) {
      EXPECT_THROW(Set(field, "-7e9x"), cli::Failure) << field.name;
    }
  }
  EXPECT_EQ(names.size(), 33u);
}

TEST(Controls, PresetsAreWhatTheySay) {
  Controls controls;
  controls.worlds = 1;
  controls.players[1].solver = "cairn";
  UsePreset("match", 0, &controls);
  EXPECT_EQ(controls.worlds, 2);
  EXPECT_EQ(controls.players[0].budget, kMatch);
  EXPECT_EQ(controls.players[1].solver, "bullet-si");
  UsePreset("2ms", 1, &controls);
  EXPECT_EQ(controls.players[1], (PlayerControls{.budget = std::string(kFixed), .budget_ms = 2}));
  UsePreset("bullet", 0, &controls);
  EXPECT_EQ(controls.players[0], PlayerControls{.solver = "bullet-si"});
  EXPECT_THROW(UsePreset("fastest", 0, &controls), cli::Failure);
}

// 144 Hz for a second at steps of 1/60 s: 60 steps, one at most a picture, shares in [0, 1).
TEST(FixedSteps, StepsAreFixedWhateverThePictures) {
  examples::FixedSteps loop;
  int steps = 0;
  for (int i = 0; i < 144; ++i) {
    const examples::FixedSteps::Plan plan = loop.Advance(1.0 / 144, {}, 1);
    EXPECT_LE(plan.steps, 1);
    EXPECT_GE(plan.share, 0);
    EXPECT_LT(plan.share, 1);
    steps += plan.steps;
  }
  EXPECT_EQ(steps, 60);
  EXPECT_EQ(loop.Advance(3, {}, 1).steps, examples::FixedSteps::kMostSteps);  // after a hitch
  EXPECT_EQ(loop.Advance(1.0 / 60, {.speed = 0.5}, 1).steps, 0);
  EXPECT_EQ(loop.Advance(1.0 / 60, {.speed = 0.5}, 1).steps, 1);
}

TEST(FixedSteps, TheBudgetIsWhatAPictureHasLeft) {
  examples::FixedSteps loop;
  for (int i = 0; i < 200; ++i) loop.Learn(0.006);
  // nine tenths of 1/60 s - 6 ms, for two worlds
  const auto budget = loop.Advance(1.0 / 60, {}, 2).budget;
  EXPECT_NEAR(static_cast<double>(budget.count()), 0.9 * (1e9 / 60 - 6e6) / 2, 1e4);
  for (int i = 0; i < 200; ++i) loop.Learn(0.1);
  EXPECT_EQ(loop.Advance(1.0 / 60, {}, 1).budget, std::chrono::microseconds(500));
}

}  // namespace
}  // namespace cairn::play
