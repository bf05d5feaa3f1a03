// SPDX-License-Identifier: MIT
// A man walks over a taut bridge of planks on pins: it carries him, and does not throw him.
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/random.h"
#include "tests/bullet_adapter/any_world.h"

namespace cairn::test {
namespace {

/// 8 to 28 planks of 2 to 20 kg between two banks, all level, on two pins a seam. The man of 50 to
/// 150 kg, a capsule that does not turn, stands on the first bank.
class PlankBridge {
 public:
  PlankBridge(std::uint64_t seed, int rate)
      : legs_(btScalar(.3), 1), world_(DiscreteWorld(&solver_)), rate_(rate) {
    bench::Random random(seed);
    planks_ = static_cast<int>(random.Within(8, 29));
    const auto plank = static_cast<btScalar>(random.Within(2, 20));
    const auto mass = static_cast<btScalar>(random.Within(50, 150));
    speed_ = static_cast<btScalar>(random.Within(1, 3));

    const btVector3 bank(2, btScalar(.2), 2), half(kSeam * btScalar(.45), btScalar(.04), kReach);
    btRigidBody* last = Add(bank, 0, {-2, btScalar(-.16), 0});
    btRigidBody* const end = Add(bank, 0, {kSeam * btScalar(planks_) + 2, btScalar(-.16), 0});
    for (int i = 0; i <= planks_; ++i) {
      const btScalar seam = kSeam * btScalar(i);
      btRigidBody* const next = i < planks_ ? Add(half, plank, {seam + kSeam / 2, 0, 0}) : end;
      next->setDamping(btScalar(.05), btScalar(.1));
      for (const btScalar side : {-kReach, kReach}) Pin(next, last, {seam, 0, side});
      last = next;
    }

    btVector3 inertia;
    legs_.calculateLocalInertia(mass, inertia);
    man_ = std::make_unique<btRigidBody>(mass, nullptr, &legs_, inertia);
    man_->setWorldTransform(At({-1, kStands, 0}));
    man_->setAngularFactor(0);
    man_->setActivationState(DISABLE_DEACTIVATION);
    world_->bullet().addRigidBody(man_.get());
  }
  /// Over to the other bank after a second. How far above the deck he came, standing is 0 [m].
  double WalksOver() {
    double most = 0;
    const auto h = 1 / btScalar(rate_);
    const btScalar strength = btScalar(.8 * 9.81) * h;
    const btScalar way = kSeam * btScalar(planks_) + 2;
    const int frames = static_cast<int>((1 + way / speed_) * btScalar(rate_));
    for (int frame = 0; frame < frames; ++frame) {
      const btVector3 velocity = man_->getLinearVelocity();
      btVector3 change(frame > rate_ ? speed_ - velocity.x() : -velocity.x(), 0, -velocity.z());
      if (change.length() > strength) change *= strength / change.length();
      man_->setLinearVelocity(velocity + change);
      world_->bullet().stepSimulation(h, 0);
      const btScalar above = man_->getCenterOfMassPosition().y() - kStands;
      most = std::max(most, static_cast<double>(above));
    }
    return most;
  }

 private:
  static constexpr btScalar kSeam = btScalar(.4), kReach = btScalar(.8), kStands = btScalar(.85);

  static btTransform At(const btVector3& place) {
    return btTransform(btQuaternion::getIdentity(), place);
  }
  btRigidBody* Add(const btVector3& half, btScalar mass, const btVector3& place) {
    btRigidBody* const body = world_->AddBox(half, mass, At(place));
    body->setActivationState(DISABLE_DEACTIVATION);
    return body;
  }
  void Pin(btRigidBody* a, btRigidBody* b, const btVector3& place) {
    auto pin = std::make_unique<btPoint2PointConstraint>(
        *a, *b, a->getWorldTransform().inverse() * place, b->getWorldTransform().inverse() * place);
    world_->AddJoint(std::move(pin), false);
  }

  bullet::ConstraintSolver solver_;
  btCapsuleShape legs_;
  std::unique_ptr<btRigidBody> man_;
  std::unique_ptr<AnyWorld> world_;
  int rate_;  ///< [Hz]
  int planks_ = 0;
  btScalar speed_ = 0;  ///< [m/s]
};

// Steps were undone that caught what sweeps had let go, as too violent for the small errors that
// sweeps leave, or as rougher than those. Then he fell, and the first step that was kept threw him:
// in floats 6 of 14 at 144 Hz, by up to 1.4 m, and 13 at 240 Hz, by up to 5.
TEST(Walk, OverATautBridgeIsSafeAtAnyRate) {
  constexpr std::uint64_t kBridges = 14;
  for (const int rate : {60, 120, 144, 240}) {
    int thrown = 0;
    double most = 0;
    for (std::uint64_t seed = 0; seed < kBridges; ++seed) {
      const double above = PlankBridge(seed, rate).WalksOver();
      most = std::max(most, above);
      thrown += above > 0.1 ? 1 : 0;
    }
    EXPECT_LE(thrown, rate > 144 ? 1 : 0) << rate << " Hz";
    EXPECT_LT(most, 0.5) << rate << " Hz";
  }
}

}  // namespace
}  // namespace cairn::test
