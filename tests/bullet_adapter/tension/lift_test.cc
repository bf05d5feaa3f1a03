// SPDX-License-Identifier: MIT
// A hook lifts a crate off the floor: how hard its rope is pulled.
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/random.h"
#include "tests/bullet_adapter/any_world.h"

namespace cairn::test {
namespace {

constexpr double kWeightOfKilogram = 9.81;

/// Links of 1 kg between a kinematic hook and a crate that stands below it.
class Crane {
 public:
  /// One of many lengths, loads, joints, speeds and rates.
  explicit Crane(std::uint64_t seed) : world_(DiscreteWorld(&solver_)) {
    bench::Random random(seed);
    rate_ = random.Within(0, 1) < 0.5 ? 60 : 120;
    const auto integer = [&random](int low, int high) {
      return static_cast<int>(random.Within(low, high + 1));
    };
    const int links = integer(2, 10), kind = integer(0, 3);
    const auto load = static_cast<btScalar>(random.Within(5, 60)), half = btScalar(.15);
    speed_ = random.Within(.1, .6);
    weight_ = (links + static_cast<double>(load)) * kWeightOfKilogram;
    world_->AddGround();
    const btVector3 link(btScalar(.05), half, btScalar(.05)),
        crate(btScalar(.4), btScalar(.4), btScalar(.4));
    const auto at = [half](int above) { return At(btScalar(.8) + half * btScalar(2 * above + 1)); };
    const auto add = [this](const btVector3& size, btScalar mass, const btTransform& pose) {
      btRigidBody* const body = world_->AddBox(size, mass, pose);
      body->setActivationState(DISABLE_DEACTIVATION);
      return body;
    };
    hook_ = add(link, 0, at(links));
    hook_->setCollisionFlags(hook_->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    btRigidBody* above = hook_;
    for (int i = links - 1; i >= -1; --i) {
      btRigidBody* const body = i < 0 ? add(crate, load, At(btScalar(.4))) : add(link, 1, at(i));
      const btScalar end = above->getCenterOfMassPosition().y() - half;
      auto joint = Join(kind, above, body, At(end));
      if (above == hook_) joint->setJointFeedback(&feedback_);
      world_->AddJoint(std::move(joint), false);
      above = body;
    }
  }
  /// After a second the hook speeds up for one, then rises for four, slows down for one, and hangs.
  /// The most that its joint felt, in weights of all that hangs.
  double LiftsWithMost() {
    double most = 0;
    for (int frame = 0; frame < 10 * rate_; ++frame) {
      const double t = static_cast<double>(frame) / rate_;
      const double speed = speed_ * std::clamp(std::min(t - 1, 7 - t), 0., 1.);
      btTransform pose = hook_->getWorldTransform();
      pose.getOrigin().setY(pose.getOrigin().y() + btScalar(speed / rate_));
      hook_->setWorldTransform(pose);
      world_->bullet().stepSimulation(btScalar(1) / btScalar(rate_), 0);
      most = std::max(most, static_cast<double>(feedback_.m_appliedForceBodyA.length()) / weight_);
    }
    return most;
  }

 private:
  static btTransform At(btScalar y) {
    return btTransform(btQuaternion::getIdentity(), btVector3(0, y, 0));
  }
  static std::unique_ptr<btTypedConstraint> Join(int kind, btRigidBody* a, btRigidBody* b,
                                                 const btTransform& place) {
    const btTransform in_a = a->getCenterOfMassTransform().inverse() * place,
                      in_b = b->getCenterOfMassTransform().inverse() * place;
    switch (kind) {
      case 0:
        return std::make_unique<btFixedConstraint>(*a, *b, in_a, in_b);
      case 1:
        return std::make_unique<btPoint2PointConstraint>(*a, *b, in_a.getOrigin(),
                                                         in_b.getOrigin());
      case 2:
        return std::make_unique<btHingeConstraint>(*a, *b, in_a, in_b);
      default:
        break;
    }
    auto cone = std::make_unique<btConeTwistConstraint>(*a, *b, in_a, in_b);
    cone->setLimit(btScalar(.6), btScalar(.6), btScalar(.6));
    return cone;
  }

  bullet::ConstraintSolver solver_;
  std::unique_ptr<AnyWorld> world_;
  btRigidBody* hook_ = nullptr;
  btJointFeedback feedback_;
  int rate_ = 0;       ///< [Hz]
  double speed_ = 0;   ///< [m/s]
  double weight_ = 0;  ///< [N]
};

// The first step of many closed at once what sweeps had left open. In floats 78 felt more than
// twice the weight, 54 more than three times, 3.4 weights in the mean; in doubles 78, 46 and 3.2.
TEST(Lift, TakesUpALoadWithoutAJerk) {
  constexpr std::uint64_t kBuilds = 120;
  int twice = 0, thrice = 0;
  double sum = 0;
  for (std::uint64_t seed = 0; seed < kBuilds; ++seed) {
    const double most = Crane(seed).LiftsWithMost();
    sum += most;
    twice += most > 2 ? 1 : 0;
    thrice += most > 3 ? 1 : 0;
  }
  EXPECT_LE(twice, 48);
  EXPECT_LE(thrice, 18);
  EXPECT_LE(sum / static_cast<double>(kBuilds), 2.3);
}

}  // namespace
}  // namespace cairn::test
