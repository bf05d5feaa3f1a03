// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/facts.h"
#include "scenes/scene.h"
#include "scenes/world.h"

namespace cairn::bench {
namespace {

constexpr bool kIsFloat = sizeof(btScalar) == sizeof(float);

/// A scene in a world of its own with Bullet's solver.
struct Stage {
  explicit Stage(std::string_view name, const SceneOptions& options = {})
      : scene(Make(*FindScene(name))) {
    scene->Build(&world, options);
  }

  void Run(int frames) {
    for (; frames > 0; --frames) {
      scene->BeforeStep(&world, frame++);
      world.Step();
    }
  }

  btSequentialImpulseConstraintSolver solver;
  World world{&solver};
  std::unique_ptr<Scene> scene;
  int frame = 0;
};

std::vector<btVector3> Positions(const World& world) {
  std::vector<btVector3> positions;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    positions.push_back(body->getCenterOfMassPosition());
  }
  return positions;
}

std::vector<std::string> SceneNames() {
  std::vector<std::string> names;
  for (const SceneInfo& info : Scenes()) names.emplace_back(info.name);
  return names;
}

std::string TestName(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

class EveryScene : public testing::TestWithParam<std::string> {
 protected:
  const SceneInfo& info() const { return *FindScene(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(SceneNames()), TestName);

TEST_P(EveryScene, IsBuiltAsItsKnownFactsSayAtSeveralSizes) {
  for (const int size : {info().default_size, info().min_size, info().min_size + 7}) {
    SCOPED_TRACE(size);
    if (size > info().max_size) continue;
    const Stage stage(GetParam(), {.size = size});
    const KnownFacts known = info().known_facts(size);
    EXPECT_EQ(stage.world.dynamic_bodies().size(), static_cast<size_t>(known.bodies));
    EXPECT_EQ(stage.world.joints().size(), static_cast<size_t>(known.joints));
    // Sums of a few thousand rounded numbers.
    EXPECT_NEAR(TopHeight(stage.world), known.top_height_m, 1e-5 * known.top_height_m);
    EXPECT_NEAR(TotalMass(stage.world), known.mass_kg, 1e-6 * known.mass_kg);
  }
}

TEST_P(EveryScene, HasLostNothingWhenItIsBuilt) {
  const Stage stage(GetParam());
  const SceneFacts facts = stage.scene->Measure(stage.world);
  EXPECT_NE(facts.verdict, SceneFacts::Verdict::kFallen);
  // Anchors of springs may part.
  const bool any_gap = std::ranges::any_of(
      stage.world.joints(),
      [](const btTypedConstraint* joint) { return !std::isnan(JointGap(*joint)); });
  EXPECT_EQ(std::isnan(facts.joint_gap_m), !any_gap);
  if (!std::isnan(facts.joint_gap_m)) {
    EXPECT_LT(facts.joint_gap_m, kIsFloat ? 1e-5 : 1e-13);
  }
  if (!std::isnan(facts.height_lost_m)) {
    EXPECT_NEAR(facts.height_lost_m, 0, kIsFloat ? 1e-4 : 1e-12);
  }
}

TEST_P(EveryScene, IsBuiltWithoutDeepOverlap) {
  Stage stage(GetParam());
  stage.world.bullet()->performDiscreteCollisionDetection();
  // Boxes that touch may overlap by rounding; nothing starts inside of something else.
  EXPECT_LT(MaxPenetration(stage.world), kIsFloat ? 1e-4 : 1e-6);
}

TEST_P(EveryScene, RunsSixtyFramesWithBulletsSolver) {
  Stage stage(GetParam());
  stage.Run(60);
  for (const btVector3& position : Positions(stage.world)) {
    // Nothing is NaN, flies off or falls through the ground.
    ASSERT_LT(position.length(), 500);
    ASSERT_GT(position.y(), -0.5);
  }
  EXPECT_TRUE(std::isfinite(TotalEnergy(stage.world)));
}

TEST_P(EveryScene, GivesTheSameBitsTwiceWhateverTheHeapLooksLike) {
  Stage first(GetParam());
  first.Run(120);
  // Other addresses for the second world, in another order.
  std::vector<std::unique_ptr<char[]>> holes;
  for (size_t i = 0; i < 2000; ++i) {
    holes.push_back(std::make_unique<char[]>(16 + 97 * i % 3000));
    if (i % 3 == 0) holes[i / 2].reset();
  }
  Stage second(GetParam());
  second.Run(120);
  EXPECT_EQ(StateHash(first.world), StateHash(second.world));
}

TEST_P(EveryScene, IsDisplacedByASeedALittleAndTheSameWayEachTime) {
  const int size = info().min_size + 7;
  const Stage designed(GetParam(), {.size = size});
  const Stage displaced(GetParam(), {.size = size, .seed = 3});
  const Stage again(GetParam(), {.size = size, .seed = 3});
  const Stage other(GetParam(), {.size = size, .seed = 4});
  EXPECT_EQ(StateHash(displaced.world), StateHash(again.world));
  EXPECT_NE(StateHash(displaced.world), StateHash(other.world));

  const std::vector<btVector3> from = Positions(designed.world), to = Positions(displaced.world);
  ASSERT_EQ(from.size(), to.size());
  for (size_t i = 0; i < from.size(); ++i) {
    EXPECT_GT((to[i] - from[i]).length(), 0);
    EXPECT_LE((to[i] - from[i]).length(), 1e-4);
  }
}

TEST_P(EveryScene, RefusesSizesOutOfItsRange) {
  EXPECT_THROW(Stage(GetParam(), {.size = info().min_size - 1000}), std::out_of_range);
  EXPECT_THROW(Stage(GetParam(), {.size = info().max_size + 1}), std::out_of_range);
}

// Counted by hand.
TEST(Scenes, HaveTheSizesTheyAreKnownFor) {
  const auto bodies = [](std::string_view name, int size) {
    return FindScene(name)->known_facts(size).bodies;
  };
  // Walls: 6 x (10 + 11) bricks and 5 merlons; towers: 16 courses of 8 and 4 merlons; four of each.
  EXPECT_EQ(bodies("castle", 3), 4 * (126 + 5) + 4 * (128 + 4));
  EXPECT_EQ(bodies("pyramid", 20), 210);
  EXPECT_EQ(bodies("pyramid", 100), 5050);
  EXPECT_EQ(bodies("pyramid3d", 10), 385);
  EXPECT_EQ(bodies("pyramid3d", 14), 1015);
  EXPECT_EQ(bodies("wall", 10), 5 * 10 + 5 * 11);
  EXPECT_EQ(bodies("tower", 30), 30);
  EXPECT_EQ(bodies("heavy-top", 15), 16);
  EXPECT_EQ(FindScene("heavy-top")->known_facts(15).mass_kg, 115);
  EXPECT_EQ(bodies("bridge", 40), 40 + 12);
  EXPECT_EQ(FindScene("bridge")->known_facts(40).joints, 82);
  // Both end planks are static; five crates; two pins between neighbours.
  EXPECT_EQ(bodies("two-pin-bridge", 50), 48 + 5);
  EXPECT_EQ(FindScene("two-pin-bridge")->known_facts(50).joints, 2 * 49);
  EXPECT_EQ(bodies("chain", 20), 21);
  EXPECT_EQ(FindScene("chain")->known_facts(20).joints, 21);
  EXPECT_EQ(bodies("ragdolls", 20), 220);
  EXPECT_EQ(FindScene("ragdolls")->known_facts(20).joints, 200);
  EXPECT_EQ(bodies("rubble", 600), 600);
  EXPECT_EQ(bodies("islands", 300), 1500);
  EXPECT_EQ(bodies("balls", 1000), 1000);
  EXPECT_EQ(bodies("stairs", 1), 11);
  EXPECT_EQ(FindScene("stairs")->known_facts(1).mass_kg, 72);
  EXPECT_EQ(bodies("car", 1), 5);
  EXPECT_EQ(FindScene("car")->known_facts(1).mass_kg, 880);
  EXPECT_EQ(bodies("door", 1), 2);
  EXPECT_EQ(FindScene("pendulum")->known_facts(5).joints, 5);
  EXPECT_EQ(bodies("seesaw", 1), 3);
  EXPECT_EQ(bodies("dominoes", 100), 100);
  EXPECT_EQ(bodies("arch", 11), 11);
  EXPECT_EQ(bodies("incline", 1), 1);
  // 1 + 2 + 4 + ... + 64.
  EXPECT_NEAR(FindScene("growing-tower")->known_facts(7).mass_kg, 127, 1e-12);
  EXPECT_EQ(bodies("slab", 6), 37);
  EXPECT_EQ(FindScene("slab")->known_facts(6).mass_kg, 680);
  // Three courses of 5 bricks and three of 6, 6 links and the ball.
  EXPECT_EQ(bodies("wrecking-ball", 6), 33 + 7);
  EXPECT_EQ(FindScene("wrecking-ball")->known_facts(6).joints, 7);
  // A jib, 20 links of 3 kg, a hook and its load; 12 ropes of four links; 24 planks, five of a
  // truck; 38 planks of 12 kg that move, and five crates.
  EXPECT_EQ(bodies("crane", 20), 23);
  EXPECT_EQ(FindScene("crane")->known_facts(20).mass_kg, 800 + 60 + 20 + 2000);
  EXPECT_EQ(FindScene("chandelier")->known_facts(12).joints, 60);
  EXPECT_EQ(FindScene("chandelier")->known_facts(12).mass_kg, 1048);
  EXPECT_EQ(bodies("truck", 24), 29);
  EXPECT_EQ(FindScene("truck")->known_facts(24).joints, 2 * 25 + 4);
  EXPECT_EQ(FindScene("crate-bridge")->known_facts(40).mass_kg, 38 * 12 + 500);
}

TEST(Scenes, AreFoundByNameOnly) {
  const std::vector<std::string> names = SceneNames();
  EXPECT_EQ(names.size(), 28u);
  EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
  for (const SceneInfo& info : Scenes()) EXPECT_EQ(FindScene(info.name), &info);
  EXPECT_EQ(FindScene("sandcastle"), nullptr);
  EXPECT_EQ(FindScene(""), nullptr);
}

TEST(Scenes, HaveADefaultSizeWithinTheirRange) {
  for (const SceneInfo& info : Scenes()) {
    SCOPED_TRACE(info.name);
    EXPECT_GE(info.min_size, 1);
    EXPECT_LE(info.min_size, info.default_size);
    EXPECT_LE(info.default_size, info.max_size);
  }
}

TEST(Castle, IsShotAtWithThreeBallsFromOutside) {
  Stage stage("castle", {.size = 1});
  const size_t bricks = stage.world.dynamic_bodies().size();
  stage.Run(60);
  EXPECT_EQ(stage.world.dynamic_bodies().size(), bricks);
  stage.Run(61);
  EXPECT_EQ(stage.world.dynamic_bodies().size(), bricks + 3);
}

TEST(Rubble, HasContactsThatResistRolling) {
  Stage stage("rubble", {.size = 50});
  stage.Run(120);
  int rolling = 0;
  btDispatcher* dispatcher = stage.world.bullet()->getDispatcher();
  for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
    btPersistentManifold* manifold = dispatcher->getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold->getNumContacts(); ++k) {
      rolling += manifold->getContactPoint(k).m_combinedRollingFriction > 0;
    }
  }
  EXPECT_GT(rolling, 20);
}

// 10 sweeps are not enough to hold 15 boxes under a hundred times their mass, 400 are.
TEST(HeavyTop, FallsWithFewSweepsAndStandsWithMany) {
  Stage few("heavy-top"), many("heavy-top");
  many.world.solver_info().m_numIterations = 400;
  few.Run(180);
  many.Run(180);
  const SceneFacts fallen = few.scene->Measure(few.world),
                   standing = many.scene->Measure(many.world);
  EXPECT_EQ(fallen.verdict, SceneFacts::Verdict::kFallen);
  EXPECT_GT(fallen.height_lost_m, 1);
  EXPECT_EQ(standing.verdict, SceneFacts::Verdict::kStanding);
  EXPECT_LT(standing.height_lost_m, 0.02);
}

// The bridge is built in its hanging shape: the better the solver, the less it moves.
TEST(Bridge, SinksLessTheMoreSweepsHoldIt) {
  Stage few("bridge"), many("bridge");
  many.world.solver_info().m_numIterations = 1000;
  few.Run(300);
  many.Run(300);
  const SceneFacts sunk = few.scene->Measure(few.world), held = many.scene->Measure(many.world);
  EXPECT_GT(sunk.height_lost_m, 0.5);
  EXPECT_LT(held.height_lost_m, 0.1);
  EXPECT_GT(sunk.joint_gap_m, 10 * held.joint_gap_m);
}

// Ten sweeps and a hundred hold it: crates fall 1 m (4.4 m/s) and swing with a bridge that is slack
// by a quarter of its sag.
TEST(TwoPinBridge, IsHeldTogetherByBullet) {
  for (const int iterations : {10, 100}) {
    SCOPED_TRACE(iterations);
    Stage stage("two-pin-bridge");
    stage.world.solver_info().m_numIterations = iterations;
    double fastest = 0;
    for (int frame = 0; frame < 300; ++frame) {
      stage.Run(1);
      fastest = std::max(fastest, LargestSpeed(stage.world));
    }
    EXPECT_LT(fastest, 25);
  }
}

btVector3 PositionOf(const Stage& stage, size_t body) {
  return stage.world.dynamic_bodies()[body]->getCenterOfMassPosition();
}

// The landing is 1.6 m up.
TEST(Stairs, AreTumbledDown) {
  Stage stage("stairs");
  stage.Run(240);
  EXPECT_LT(TopHeight(stage.world), 1.2);
  EXPECT_GT(PositionOf(stage, 0).x(), 1);
}

// 12 rad/s on wheels of 0.35 m are 4.2 m/s, less what bumps and the start take.
TEST(Car, DrivesOverItsBumpsOnFourWheels) {
  Stage stage("car");
  stage.Run(300);
  EXPECT_GT(PositionOf(stage, 0).x(), 10);
  EXPECT_LT(PositionOf(stage, 0).x(), 21);
  EXPECT_NEAR(PositionOf(stage, 0).z(), 0, 0.5);
  for (size_t wheel = 1; wheel <= 4; ++wheel) {
    EXPECT_NEAR(PositionOf(stage, wheel).y(), 0.35, 0.2) << wheel;
  }
}

TEST(Door, OpensWithinItsLimitsPushesACrateAndCloses) {
  Stage stage("door");
  const btVector3 crate = PositionOf(stage, 1);
  double widest = 0;
  auto& hinge = static_cast<btHingeConstraint&>(*stage.world.joints().front());
  for (int frame = 0; frame < 180; ++frame) {
    stage.Run(1);
    const double angle = hinge.getHingeAngle();
    widest = std::max(widest, angle);
    EXPECT_GT(angle, -0.05) << frame;
  }
  EXPECT_GT(widest, 1.2);
  EXPECT_LT(widest, 1.5);
  EXPECT_NEAR(hinge.getHingeAngle(), 0, 0.1);
  EXPECT_GT((PositionOf(stage, 1) - crate).length(), 0.1);
}

// 100 kg m on the right, 50 on the left.
TEST(Seesaw, TiltsToTheGroundUnderItsCrates) {
  Stage stage("seesaw");
  stage.Run(240);
  const btVector3 right = stage.world.dynamic_bodies()[0]->getWorldTransform() * btVector3(2, 0, 0);
  EXPECT_NEAR(right.y(), 0.05, 0.03);
  EXPECT_LT(LargestSpeed(stage.world), 0.1);
}

TEST(Dominoes, AllFall) {
  Stage stage("dominoes", {.size = 20});
  stage.Run(300);
  for (size_t i = 0; i < 20; ++i) EXPECT_LT(PositionOf(stage, i).y(), 0.25) << i;
}

TEST(Incline, HoldsItsBoxesByFriction) {
  Stage stage("incline", {.size = 3});
  stage.Run(240);
  EXPECT_EQ(stage.scene->Measure(stage.world).verdict, SceneFacts::Verdict::kStanding);
  EXPECT_LT(stage.scene->Measure(stage.world).height_lost_m, 0.02);
}

// A half ring stands if it is thicker than 0.1075 of its mean radius (Heyman 1969): 0.26 here.
TEST(Arch, StandsWithManySweeps) {
  Stage stage("arch");
  stage.world.solver_info().m_numIterations = 200;
  stage.Run(240);
  const SceneFacts facts = stage.scene->Measure(stage.world);
  EXPECT_EQ(facts.verdict, SceneFacts::Verdict::kStanding);
  EXPECT_LT(facts.height_lost_m, 0.05);
}

TEST(GrowingTower, FallsWithFewSweepsAndStandsWithMany) {
  Stage few("growing-tower"), many("growing-tower");
  many.world.solver_info().m_numIterations = 400;
  few.Run(240);
  many.Run(240);
  EXPECT_EQ(many.scene->Measure(many.world).verdict, SceneFacts::Verdict::kStanding);
  EXPECT_GT(few.scene->Measure(few.world).height_lost_m,
            10 * many.scene->Measure(many.world).height_lost_m);
}

TEST(Slab, StandsOnItsColumns) {
  Stage stage("slab");
  stage.Run(240);
  EXPECT_EQ(stage.scene->Measure(stage.world).verdict, SceneFacts::Verdict::kStanding);
}

TEST(WreckingBall, KnocksBricksOutOfTheWall) {
  Stage stage("wrecking-ball");
  stage.Run(30);
  const btVector3 brick = PositionOf(stage, 13);
  stage.Run(210);
  EXPECT_GT((PositionOf(stage, 13) - brick).length(), 0.3);
}

class Facts : public testing::Test {
 protected:
  btSequentialImpulseConstraintSolver solver_;
  World world_{&solver_};
};

TEST_F(Facts, OfAnEmptyWorldAreNothing) {
  EXPECT_EQ(MaxPenetration(world_), 0);
  EXPECT_TRUE(std::isnan(LargestJointGap(world_)));
  EXPECT_TRUE(std::isnan(TotalJointGap(world_)));
  EXPECT_EQ(LargestSpeed(world_), 0);
  EXPECT_EQ(TotalEnergy(world_), 0);
}

// Two boxes of 1 m with centres 0.99 m apart.
TEST_F(Facts, OfTwoBoxesOneCentimetreInsideEachOther) {
  const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.5));
  world_.AddBox(half, {.mass = 1, .pose = At(0, 0, 0)});
  world_.AddBox(half, {.mass = 1, .pose = At(0, btScalar(0.99), 0)});
  world_.bullet()->performDiscreteCollisionDetection();
  EXPECT_NEAR(MaxPenetration(world_), 0.01, 1e-6);
}

TEST_F(Facts, OfAPinWhoseAnchorsAreTenCentimetresApart) {
  btRigidBody* a = world_.AddSphere(btScalar(0.2), {.mass = 1, .pose = At(0, 0, 0)});
  btRigidBody* b = world_.AddSphere(btScalar(0.2), {.mass = 1, .pose = At(1, 0, 0)});
  // Anchors at x = 0.5 and x = 0.6.
  world_.AddJoint(std::make_unique<btPoint2PointConstraint>(*a, *b, btVector3(btScalar(0.5), 0, 0),
                                                            btVector3(btScalar(-0.4), 0, 0)),
                  ConnectedBodies::kPassThrough);
  EXPECT_NEAR(LargestJointGap(world_), 0.1, 1e-6);
  // And one on the world, that fits.
  world_.AddJoint(std::make_unique<btPoint2PointConstraint>(*a, btVector3(0, 0, 0)),
                  ConnectedBodies::kPassThrough);
  EXPECT_NEAR(LargestJointGap(world_), 0.1, 1e-6);
  EXPECT_NEAR(TotalJointGap(world_), 0.1, 1e-6);
}

// Each kind of joint with its frames 0.1 m apart along z, on bodies turned by a right angle.
TEST_F(Facts, OfEveryJointThatHoldsAPoint) {
  const btTransform turned(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI), btVector3(2, 0, 0));
  btRigidBody* a = world_.AddSphere(btScalar(0.2), {.mass = 1, .pose = At(0, 0, 0)});
  btRigidBody* b = world_.AddSphere(btScalar(0.2), {.mass = 1, .pose = turned});
  const btTransform in_a = At(1, 0, 0), in_b = turned.inverse() * At(1, 0, btScalar(0.1));
  const btHingeConstraint hinge(*a, *b, in_a, in_b);
  const btConeTwistConstraint cone(*a, *b, in_a, in_b);
  const btFixedConstraint fixed(*a, *b, in_a, in_b);
  btGeneric6DofConstraint locked(*a, *b, in_a, in_b, true);
  locked.setLinearLowerLimit(btVector3(0, 0, 0));
  locked.setLinearUpperLimit(btVector3(0, 0, 0));
  btGeneric6DofSpring2Constraint sliding(*a, *b, in_a, in_b);
  sliding.setLinearLowerLimit(btVector3(-1, 0, 0));
  const btSliderConstraint slider(*a, *b, in_a, in_b, true);

  for (const btTypedConstraint* joint :
       std::vector<const btTypedConstraint*>{&hinge, &cone, &fixed, &locked}) {
    EXPECT_NEAR(JointGap(*joint), 0.1, 1e-6) << joint->getConstraintType();
  }
  EXPECT_TRUE(std::isnan(JointGap(sliding)));
  EXPECT_TRUE(std::isnan(JointGap(slider)));
}

// By hand: 2 kg at 3 m/s and 5 m up; a ball of 0.4 * 2 * 0.5^2 = 0.2 kg m^2 at 4 rad/s.
TEST_F(Facts, OfAMovingBall) {
  btRigidBody* ball = world_.AddSphere(btScalar(0.5), {.mass = 2, .pose = At(0, 5, 0)});
  ball->setLinearVelocity(btVector3(0, 0, 3));
  ball->setAngularVelocity(btVector3(0, 4, 0));
  EXPECT_NEAR(LargestSpeed(world_), 3, 1e-6);
  EXPECT_NEAR(TotalEnergy(world_), 9 + 1.6 + 2 * 9.81 * 5, 1e-4);
  EXPECT_EQ(TopHeight(world_), 5);
  EXPECT_EQ(TotalMass(world_), 2);
}

TEST_F(Facts, HashTheSmallestChange) {
  btRigidBody* ball = world_.AddSphere(btScalar(0.5), {.mass = 2, .pose = At(0, 5, 0)});
  const std::uint64_t before = StateHash(world_);
  EXPECT_EQ(StateHash(world_), before);
  ball->setLinearVelocity(btVector3(0, 0, btScalar(1e-30)));
  EXPECT_NE(StateHash(world_), before);
}

// One step of free fall: v = -g h, and it is one step whatever the length.
TEST_F(Facts, OfAWorldThatMakesExactlyOneStep) {
  btSequentialImpulseConstraintSolver solver;
  World slow(&solver, btScalar(0.125));
  btRigidBody* ball = slow.AddSphere(btScalar(0.5), {.mass = 2, .pose = At(0, 5, 0)});
  slow.Step();
  EXPECT_NEAR(ball->getLinearVelocity().y(), -9.81 / 8, 1e-5);
  EXPECT_NEAR(ball->getCenterOfMassPosition().y(), 5 - 9.81 / 64, 1e-5);
}

TEST(World, SharesShapesOfEqualSize) {
  btSequentialImpulseConstraintSolver solver;
  World world(&solver);
  const btVector3 small(1, 1, 1), large(2, 1, 1);
  const btRigidBody* a = world.AddBox(small, {.mass = 1});
  const btRigidBody* b = world.AddBox(small, {.mass = 1, .pose = At(5, 0, 0)});
  const btRigidBody* c = world.AddBox(large, {.mass = 1, .pose = At(9, 0, 0)});
  EXPECT_EQ(a->getCollisionShape(), b->getCollisionShape());
  EXPECT_NE(a->getCollisionShape(), c->getCollisionShape());
}

TEST(World, NeverLetsBodiesSleep) {
  Stage stage("tower", {.size = 1});
  stage.Run(300);
  EXPECT_TRUE(stage.world.dynamic_bodies().front()->isActive());
}

}  // namespace
}  // namespace cairn::bench
