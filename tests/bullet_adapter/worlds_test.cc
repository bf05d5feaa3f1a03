// SPDX-License-Identifier: MIT
// Bullet's classes of worlds other than btDiscreteDynamicsWorld, and several worlds at a time.
#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Dynamics/btSimpleDynamicsWorld.h>
#include <LinearMath/btThreads.h>
#include <gtest/gtest.h>

#include <memory>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "tests/bullet_adapter/any_world.h"
#include "tests/bullet_adapter/scene_world.h"
#include "tests/bullet_adapter/watched_solver.h"

namespace cairn::test {
namespace {

constexpr btScalar kHalf = btScalar(0.5);

/// A btDiscreteDynamicsWorldMt with a pool of three solvers, and one for large islands.
class ThreadedWorld {
 public:
  explicit ThreadedWorld(const Settings& settings = {}) : for_large(settings) {
    btSetTaskScheduler(btGetSequentialTaskScheduler());
    std::vector<btConstraintSolver*> members;
    for (int i = 0; i < 3; ++i) {
      pooled.push_back(new WatchedSolver(settings));  // the pool deletes them
      members.push_back(pooled.back());
    }
    pool_ = std::make_unique<btConstraintSolverPoolMt>(members.data(), 3);
    auto configuration = std::make_unique<btDefaultCollisionConfiguration>();
    auto dispatcher = std::make_unique<btCollisionDispatcherMt>(configuration.get());
    world_ = std::make_unique<AnyWorld>(
        std::move(configuration), std::move(dispatcher), [this](const AnyWorld::Parts& parts) {
          return std::make_unique<btDiscreteDynamicsWorldMt>(
              parts.dispatcher, parts.broadphase, pool_.get(), &for_large, parts.configuration);
        });
  }

  AnyWorld& world() { return *world_; }
  /// At least so large; islands of less than 32 bodies come together whatever is asked for.
  void SolveGroupsOf(int cost) {
    auto& discrete = static_cast<btDiscreteDynamicsWorldMt&>(world_->bullet());
    discrete.getSolverInfo().m_minimumSolverBatchSize = cost;
    static_cast<btSimulationIslandManagerMt*>(discrete.getSimulationIslandManager())
        ->setMinimumSolverBatchSize(cost);
  }
  int PooledGroups() const {
    int groups = 0;
    for (const WatchedSolver* solver : pooled) groups += solver->groups;
    return groups;
  }

  WatchedSolver for_large;
  std::vector<WatchedSolver*> pooled;

 private:
  std::unique_ptr<btConstraintSolverPoolMt> pool_;
  std::unique_ptr<AnyWorld> world_;
};

void AddTowersAndChains(AnyWorld* world) {
  world->AddGround();
  for (int i = 0; i < 16; ++i) {
    world->AddTower(4, btScalar(3 * i), 0);
    world->AddChain(5, btScalar(3 * i), 10);
  }
}

/// By hand: the boxes stand on each other, a centre each metre.
void ExpectTowersStand(const AnyWorld& world) {
  for (const btRigidBody* body : world.bodies()) {
    const btVector3& at = body->getWorldTransform().getOrigin();
    if (body->isStaticOrKinematicObject() || at.z() > 5) continue;
    const btScalar above = at.y() - kHalf;
    EXPECT_NEAR(above, btScalar(static_cast<int>(above + kHalf)), 0.02);
  }
}

double LargestGap(const AnyWorld& world) {
  double largest = 0;
  for (const auto& joint : world.joints()) {
    const auto& pin = static_cast<const btPoint2PointConstraint&>(*joint);
    const btRigidBody &a = pin.getRigidBodyA(), &b = pin.getRigidBodyB();
    const btVector3 gap =
        a.getWorldTransform() * pin.getPivotInA() - b.getWorldTransform() * pin.getPivotInB();
    largest = std::max<double>(largest, gap.length());
  }
  return largest;
}

TEST(ThreadedWorlds, SolveIslandsWithoutBrackets) {
  ThreadedWorld threaded;
  AddTowersAndChains(&threaded.world());
  threaded.SolveGroupsOf(1);
  threaded.world().Step(120);
  // 144 bodies in groups of 32 and a few more
  EXPECT_GE(threaded.PooledGroups(), 4 * 120);
  EXPECT_EQ(threaded.for_large.groups, 0);
  for (const WatchedSolver* solver : threaded.pooled) {
    EXPECT_EQ(solver->prepared, 0);
    EXPECT_EQ(solver->fallbacks, 0);
  }
  ExpectTowersStand(threaded.world());
  EXPECT_LT(LargestGap(threaded.world()), 0.02);
}

TEST(ThreadedWorlds, GiveTheSameBitsEachTime) {
  const auto hash = [] {
    ThreadedWorld threaded;
    AddTowersAndChains(&threaded.world());
    threaded.SolveGroupsOf(1);
    threaded.world().Step(120);
    return threaded.world().Hash();
  };
  EXPECT_EQ(hash(), hash());
}

/// Contacts carry their start themselves and forward sweeps remember nothing, so that it does not
/// matter which solver of the pool a group comes to. Islands share no row: each is what it is in
/// one problem with the others.
TEST(ThreadedWorlds, GiveTheBitsOfOneProblem) {
  const Settings sweeps{.path = Path::kReference, .k_sm = 0};
  ThreadedWorld small(sweeps), whole(sweeps);
  for (ThreadedWorld* threaded : {&small, &whole}) {
    threaded->world().AddGround();
    for (int i = 0; i < 30; ++i) threaded->world().AddTower(1 + i % 5, btScalar(3 * i - 40), 0);
  }
  small.SolveGroupsOf(1);
  whole.SolveGroupsOf(1 << 20);
  for (int frame = 0; frame < 40; ++frame) {
    small.world().Step(1);
    whole.world().Step(1);
    ASSERT_EQ(small.world().Hash(), whole.world().Hash()) << frame;
  }
  EXPECT_GE(small.PooledGroups(), 2 * 40);
  EXPECT_EQ(whole.PooledGroups(), 40);
}

TEST(ThreadedWorlds, GiveLargeIslandsToTheirSolver) {
  ThreadedWorld threaded;
  AnyWorld& world = threaded.world();
  world.AddGround();
  // 12 x 12 boxes side by side with 2 cm between them, and a second floor across the gaps, every
  // box well above one of the first floor: the last column has nothing beside it
  for (int x = 0; x < 12; ++x) {
    for (int z = 0; z < 12; ++z) {
      for (int y = 0; y < 2; ++y) {
        const btTransform pose(btQuaternion::getIdentity(),
                               {btScalar(1.02) * btScalar(x) + kHalf / 2 * btScalar(y),
                                btScalar(0.5) + btScalar(y), btScalar(1.02) * btScalar(z)});
        world.AddBox({kHalf, kHalf, kHalf}, 1, pose);
      }
    }
  }
  world.AddTower(3, -10, -10);
  world.Step(60);
  EXPECT_GT(threaded.for_large.groups, 0);
  EXPECT_GE(threaded.for_large.most_manifolds, 250);
  EXPECT_GT(threaded.PooledGroups(), 0);
  EXPECT_EQ(threaded.for_large.prepared, 0);
  EXPECT_EQ(threaded.for_large.fallbacks, 0);
  EXPECT_TRUE(threaded.for_large.report().ok());
  ExpectTowersStand(world);
  EXPECT_LT(world.LargestSpeed(), 0.05);
}

TEST(ThreadedWorlds, LeaveAKinematicBodyOfManyIslandsAlone) {
  ThreadedWorld threaded;
  AnyWorld& world = threaded.world();
  btRigidBody* const table =
      world.AddBox({20, 1, 20}, 3, btTransform(btQuaternion::getIdentity(), {0, -1, 0}));
  table->setCollisionFlags(table->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  table->setActivationState(DISABLE_DEACTIVATION);
  for (int i = 0; i < 4; ++i) world.AddTower(2, btScalar(3 * i), 0);
  threaded.SolveGroupsOf(1);
  world.Step(60);
  EXPECT_TRUE(table->getLinearVelocity().isZero());
  EXPECT_TRUE(table->getAngularVelocity().isZero());
  ExpectTowersStand(world);
}

std::unique_ptr<AnyWorld> SimpleWorld(btConstraintSolver* solver) {
  auto configuration = std::make_unique<btDefaultCollisionConfiguration>();
  auto dispatcher = std::make_unique<btCollisionDispatcher>(configuration.get());
  return std::make_unique<AnyWorld>(
      std::move(configuration), std::move(dispatcher), [solver](const AnyWorld::Parts& parts) {
        return std::make_unique<btSimpleDynamicsWorld>(parts.dispatcher, parts.broadphase, solver,
                                                       parts.configuration);
      });
}

/// Gravity counts twice there once something touches, with Bullet's solver and with ours.
TEST(SimpleWorlds, FallAndLandAsWithBullet) {
  btSequentialImpulseConstraintSolver bullets;
  WatchedSolver ours({.k_sm = 0});
  const auto expected = SimpleWorld(&bullets), actual = SimpleWorld(&ours);
  for (AnyWorld* world : {expected.get(), actual.get()}) {
    world->AddGround();
    world->AddTower(3, 0, 0);
    world->AddTower(1, 3, 0);
    world->bodies()[4]->setWorldTransform(
        btTransform(btQuaternion::getIdentity(), btVector3(3, 3, 0)));
  }
  for (int frame = 0; frame < 120; ++frame) {
    expected->Step(1);
    actual->Step(1);
    for (size_t i = 0; i < expected->bodies().size(); ++i) {
      const btVector3 difference = actual->bodies()[i]->getWorldTransform().getOrigin() -
                                   expected->bodies()[i]->getWorldTransform().getOrigin();
      // ten sweeps in either order from either start, over boxes that drop by up to 2.5 m
      ASSERT_LT(difference.length(), 0.02) << "body " << i << " in frame " << frame;
    }
  }
  EXPECT_GT(ours.prepared, 100);
  EXPECT_EQ(ours.fallbacks, 0);
}

/// Contacts carry their start themselves. Coloured sweeps keep the colours of pairs from one
/// substep to the next, steps and joints keep more: here they are off.
TEST(TwoWorlds, ThatShareASolverInTurnStayAsTheyAreAlone) {
  const Settings sweeps{.path = Path::kReference, .k_sm = 0};
  const bullet::Options cold{.warm_start_joints = false, .geometric_stiffness = false};
  const auto alone = [&](std::string_view scene) {
    bullet::ConstraintSolver solver(sweeps, cold);
    SceneWorld world(scene, &solver);
    world.Step(60);
    return bench::StateHash(world.world());
  };
  bullet::ConstraintSolver shared(sweeps, cold);
  SceneWorld dolls("ragdolls", &shared), pyramid("pyramid", &shared);
  for (int frame = 0; frame < 60; ++frame) {
    dolls.Step(1);
    pyramid.Step(1);
  }
  EXPECT_EQ(bench::StateHash(dolls.world()), alone("ragdolls"));
  EXPECT_EQ(bench::StateHash(pyramid.world()), alone("pyramid"));
}

TEST(TwoWorlds, ThatShareASolverInTurnAreHeldByItsDefaults) {
  const auto largest_gap = [] {
    WatchedSolver shared;
    const auto first = DiscreteWorld(&shared), second = DiscreteWorld(&shared);
    AddTowersAndChains(first.get());
    second->AddGround();
    second->AddChain(9, 0, 10);
    second->AddTower(6, 0, 0);
    for (int frame = 0; frame < 120; ++frame) {
      first->Step(1);
      second->Step(1);
    }
    EXPECT_EQ(shared.fallbacks, 0);
    ExpectTowersStand(*first);
    ExpectTowersStand(*second);
    return std::pair(LargestGap(*first), LargestGap(*second));
  };
  const auto gaps = largest_gap();
  EXPECT_LT(gaps.first, 0.02);
  EXPECT_LT(gaps.second, 0.02);
  EXPECT_EQ(largest_gap(), gaps);
}

TEST(ManyWorlds, OnThreadsOfTheirOwnGiveTheBitsOfOneAlone) {
  const std::vector<std::string_view> scenes = {"pyramid", "ragdolls", "rubble", "chain"};
  const auto hash_of = [](std::string_view scene) {
    bullet::ConstraintSolver solver;
    SceneWorld world(scene, &solver);
    world.Step(60);
    return bench::StateHash(world.world());
  };
  std::vector<std::uint64_t> alone, together(2 * scenes.size());
  for (const std::string_view scene : scenes) alone.push_back(hash_of(scene));
  {
    std::vector<std::jthread> threads;
    for (size_t i = 0; i < together.size(); ++i) {
      threads.emplace_back([&, i] { together[i] = hash_of(scenes[i % scenes.size()]); });
    }
  }
  for (size_t i = 0; i < together.size(); ++i) {
    EXPECT_EQ(together[i], alone[i % scenes.size()]) << scenes[i % scenes.size()];
  }
}

}  // namespace
}  // namespace cairn::test
