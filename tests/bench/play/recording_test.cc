// SPDX-License-Identifier: MIT
#include "cairn/detail/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <vector>

#include "play/session.h"
#include "rows/frame_layout.h"
#include "scenes/facts.h"
#include "support/failure.h"

namespace cairn::play {
namespace {

using bench::StateHash;

Controls Of(const std::string& scene) {
  Controls controls;
  controls.scene.scene = scene;
  return controls;
}

void Steps(Session* session, int count) {
  for (int i = 0; i < count; ++i) session->Step();
}

std::string PathOf(const std::string& name) {
  return (std::filesystem::path(testing::TempDir()) / ("cairn_play_" + name)).string();
}

/// The step after so many of a scene, of the world on the right, in a file.
/// @return where its bodies were, by their names in the file
std::map<std::uint64_t, btVector3> Record(const std::string& scene, int steps,
                                          const std::string& path) {
  Session session(Of(scene));
  Steps(&session, steps);
  std::map<std::uint64_t, btVector3> places;
  for (const btRigidBody* body : session.player(1).world().dynamic_bodies()) {
    places[static_cast<std::uint64_t>(body->getWorldArrayIndex()) + 1] =
        body->getCenterOfMassPosition();
  }
  session.player(1).SaveNext(path);
  session.Step();
  EXPECT_EQ(session.player(1).saved(), "written " + path);
  return places;
}

// Contacts are some millimetres deep and joints gape a little, which adds up along the way.
TEST(Recorded, BodiesAreBesideEachOtherAsTheyWere) {
  for (const auto& [scene, far] : {std::pair{"bridge", 0.1}, {"castle", 0.2}, {"tower", 0.05}}) {
    SCOPED_TRACE(scene);
    const std::string path = PathOf("layout.cairn");
    const auto places = Record(scene, 10, path);
    const auto problem = cli::LoadRowProblem(path);
    const cli::FrameLayout layout = cli::LayOut(*problem);
    ASSERT_EQ(layout.boxes.size(), places.size());
    const btVector3 first = places.at(problem->frame.bodies[0].id);
    for (size_t i = 0; i < layout.boxes.size(); ++i) {
      const btVector3 then = places.at(problem->frame.bodies[i].id) - first;
      const Eigen::Vector3d now = layout.boxes[i].centre - layout.boxes[0].centre;
      EXPECT_LT((now - Eigen::Vector3d(then.x(), then.y(), then.z())).norm(), far) << i;
    }
  }
}

TEST(Recorded, JointsAreWhereTheyHoldBothBodies) {
  const std::string path = PathOf("joints.cairn");
  Record("bridge", 10, path);
  const cli::FrameLayout layout = cli::LayOut(*cli::LoadRowProblem(path));
  ASSERT_EQ(layout.joints.size(), 82u);
  for (const auto& joint : layout.joints) EXPECT_LT((joint.a - joint.b).norm(), 0.05);
}

TEST(Recorded, ABodyHasTheSizeOfItsInertiaAndAPlaceOfItsOwn) {
  cli::RowProblem problem;
  const Eigen::Vector3d half(1, 0.5, 0.6);
  Body body{.inv_mass = 0.5};
  for (int i = 0; i < 3; ++i) {
    body.inv_inertia(i, i) = 3 / (2 * (half.squaredNorm() - half[i] * half[i]));
  }
  Body cube = body;  // turned in a way that no inertia tells
  cube.inv_inertia = 3 * Eigen::Matrix3d::Identity();
  problem.frame.bodies = {body, cube, Body{.inv_mass = 0.001}, Body{}};
  const cli::FrameLayout layout = cli::LayOut(problem);
  ASSERT_EQ(layout.boxes.size(), 4u);
  EXPECT_LT((layout.boxes[0].axes.cwiseAbs() * layout.boxes[0].half - half).norm(), 1e-9);
  EXPECT_EQ(layout.boxes[1].axes, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(layout.boxes[1].half.maxCoeff(), 0.5, 1e-9);  // 2/3 kg m^2 . 2 . 2 kg . h^2
  EXPECT_NEAR(layout.boxes[2].half.x(), 0.5, 1e-9);         // 1000 kg of water
  EXPECT_EQ(layout.boxes[3].mass, 0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NE(layout.boxes[i].group, layout.boxes[i + 1].group);
    EXPECT_GT(layout.boxes[i + 1].centre.x() - layout.boxes[i].centre.x(), 1);
  }
}

TEST(Recorded, IsSolvedWithTheSettingsOfItsSide) {
  const std::string path = PathOf("side.cairn");
  Record("bridge", 20, path);
  Session session(Of(path));
  session.Step();
  Player &left = session.player(0), &right = session.player(1);
  EXPECT_EQ(left.failure() + right.failure(), "");
  EXPECT_EQ(left.settings(), nullptr);
  EXPECT_EQ(right.settings()->max_sweeps, 10);
  EXPECT_LT(right.history().back().residual, left.history().back().residual);
  EXPECT_GT(right.history().back().steps_kept, 0);
  EXPECT_TRUE(std::isnan(right.history().back().penetration));  // a recording does not know
  const std::optional<IslandReport> report = right.ReportOf(0);
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->bodies, 52);
  EXPECT_FALSE(left.ReportOf(0).has_value());

  // the same again, and better with more
  const std::uint64_t hash = StateHash(right.world());
  const double before = left.history().back().residual;
  session.controls().players[0].iterations = 200;
  session.Step();
  EXPECT_EQ(StateHash(right.world()), hash);
  EXPECT_LT(left.history().back().residual, before / 2);
  session.controls().players[1].steps = false;
  session.controls().players[1].threads = 2;
  session.Step();
  EXPECT_EQ(right.history().back().steps_kept, 0);
  EXPECT_EQ(right.settings()->threads, 2);
  session.controls().players[1].budget = kFixed;
  session.controls().players[1].budget_ms = 1.5;
  session.Step();
  EXPECT_EQ(right.settings()->budget, Budget::Time(std::chrono::microseconds(1500)));
}

TEST(Recorded, HasTheBitsOfACallOfTheLibrary) {
  const std::string path = PathOf("bits.cairn");
  Record("tower", 20, path);
  Session session(Of(path));
  session.Step();

  Recording recording;
  ASSERT_TRUE(Load(path, &recording).ok());
  recording.settings.max_sweeps = 10;
  recording.settings.budget = Budget::Unlimited();
  Solver solver(recording.settings);
  std::vector<Velocity> velocities(recording.bodies.size());
  ASSERT_TRUE(solver.Solve(recording.problem(), recording.impulses(), velocities).ok());
  const auto& outcome = session.player(1).played().recorded()->outcome();
  for (size_t i = 0; i < velocities.size(); ++i) {
    EXPECT_EQ(outcome.velocities[i].linear, velocities[i].linear) << i;
    EXPECT_EQ(outcome.velocities[i].angular, velocities[i].angular) << i;
  }
}

// What the ground gives the tower is what its momentum is above that of free fall.
TEST(Recorded, ContactsCarryTheWeightOfTheBodies) {
  const std::string path = PathOf("weight.cairn");
  Record("tower", 200, path);
  Session session(Of(path));
  session.controls().players[1].iterations = 500;
  bench::World& world = session.player(1).played().world();
  session.Step();
  double up = 0;  // on the ground
  btDispatcher& dispatcher = *world.bullet()->getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    const bool on_a = manifold.getBody0()->isStaticObject();
    if (!on_a && !manifold.getBody1()->isStaticObject()) continue;
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      EXPECT_NEAR(point.getPositionWorldOnA().y(), 0, 0.02);
      up += point.m_appliedImpulse * std::abs(point.m_normalWorldOnB.y());
    }
  }
  Recording recording;
  ASSERT_TRUE(Load(path, &recording).ok());
  double gained = 0;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    gained += body->getMass() * body->getLinearVelocity().y();
  }
  for (size_t i = 0; i < recording.bodies.size(); ++i) {
    const double inv_mass = recording.bodies[i].inv_mass;
    if (inv_mass > 0) gained -= recording.motions[i].free_velocity[1] / inv_mass;
  }
  EXPECT_NEAR(up, gained, 1e-3 * gained);
}

TEST(Recorded, IsLeftAloneByWhatMovesWorlds) {
  const std::string path = PathOf("alone.cairn");
  Record("tower", 5, path);
  Session session(Of(path));
  const std::span<btRigidBody* const> bodies = session.player(1).world().dynamic_bodies();
  const btVector3 at = bodies[3]->getCenterOfMassPosition();
  session.Grab(0, btVector3(0, 1, 0));
  session.Move(btVector3(0, 5, 0));
  session.Shoot(btVector3(0, 1, 8), btVector3(0, 0, -1));
  session.Save(PathOf("again.cairn"));
  session.controls().sleep = true;
  session.controls().rate = 30;
  Steps(&session, 3);
  EXPECT_EQ(session.player(1).saved(), "this is a recording already");
  EXPECT_EQ(session.player(1).world().dynamic_bodies().size(), 30u);
  EXPECT_EQ(bodies[3]->getCenterOfMassPosition(), at);
  EXPECT_EQ(session.player(1).world().bullet()->getNumConstraints(), 0);
}

TEST(Recorded, ASolverThatCannotSolveItSaysSoUntilAnotherComes) {
  const std::string path = PathOf("cannot.cairn");
  Record("castle", 2, path);
  Session session(Of(path));
  session.controls().players[0].solver = "bullet-si-substeps4";
  session.controls().players[1].solver = "bullet-dantzig";  // too many rows
  Steps(&session, 2);
  EXPECT_EQ(session.player(0).failure(), "bullet-si-substeps4 solves no recordings");
  EXPECT_NE(session.player(1).failure(), "");
  EXPECT_TRUE(session.player(1).history().empty());
  session.controls().players[0].solver = "cairn-pgs";
  session.controls().players[1].solver = "bullet-nncg";
  session.Step();
  for (const int side : {0, 1}) {
    EXPECT_EQ(session.player(side).failure(), "");
    EXPECT_GT(session.player(side).history().back().residual, 0);
  }
  EXPECT_FALSE(session.player(0).settings()->steps);
}

TEST(Recorded, AFileThatIsNoneIsRefused) {
  const std::string path = PathOf("whole.cairn"), cut = PathOf("cut.cairn");
  Record("tower", 1, path);
  std::filesystem::copy_file(path, cut, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::resize_file(cut, 3000);
  std::ofstream(PathOf("text.cairn")) << "no recording, but long enough to hold the header of one";
  for (const auto& [file, words] : {std::pair{cut, "was cut"},
                                    {PathOf("text.cairn"), "no recording"},
                                    {PathOf("missing.cairn"), "cannot be opened"}}) {
    try {
      Session session(Of(file));
      ADD_FAILURE() << file;
    } catch (const cli::Failure& failure) {
      EXPECT_EQ(failure.code(), cli::kBadInput);
      EXPECT_NE(std::string(failure.what()).find(words), std::string::npos) << failure.what();
    }
  }
}

}  // namespace
}  // namespace cairn::play
