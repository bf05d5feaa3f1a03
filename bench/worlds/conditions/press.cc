// SPDX-License-Identifier: MIT
#include "worlds/conditions/press.h"

#include <algorithm>

namespace cairn::bench {
namespace {

constexpr double kSlowest = 0.3, kFastest = 2;                              // [m/s]
constexpr double kLongest = 1.5, kLongestStay = 0.5, kLongestPause = 1;     // [s]
constexpr btScalar kHalfThickness = btScalar(0.5), kRoom = btScalar(0.05);  // [m]
constexpr btScalar kFarthest = 50;                                          // [m]

struct Box {
  btVector3 low{BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT}, high = -low;
};

/// Around all bodies that are not far away.
Box BoxAround(const World& world) {
  Box box;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    const btVector3 place = body->getWorldTransform().getOrigin().absolute();
    if (!body->isInWorld() || !(place[place.maxAxis()] < kFarthest)) continue;
    btVector3 low, high;
    body->getAabb(low, high);
    box.low.setMin(low);
    box.high.setMax(high);
  }
  return box;
}

}  // namespace

void Press::Act(double time_step, World* world) {
  left_ -= time_step;
  switch (phase_) {
    case Phase::kOpen:
      if (left_ < 0) Begin(world);
      return;
    case Phase::kCloses:
      MoveTo(static_cast<btScalar>(closed_ += speed_ * time_step));
      if (left_ >= 0) return;
      phase_ = Phase::kStays;
      left_ = staying_;
      return;
    case Phase::kStays:
      if (left_ >= 0) return;
      phase_ = Phase::kOpens;
      left_ = closing_;
      return;
    case Phase::kOpens:
      MoveTo(static_cast<btScalar>(closed_ -= speed_ * time_step));
      if (left_ >= 0) return;
      for (btRigidBody* plate : plates_) world->Remove(plate);
      phase_ = Phase::kOpen;
      left_ = random_.Within(0, kLongestPause);
      return;
  }
}

void Press::Begin(World* world) {
  const double draw = random_.Within(0, 1), rest = random_.Within(0.3, 0.95);
  speed_ = random_.Within(kSlowest, kFastest);
  staying_ = random_.Within(0, kLongestStay);
  const Box box = BoxAround(*world);
  if (!(box.low.x() <= box.high.x())) return;
  const int axis = draw < 0.6 ? 1 : draw < 0.8 ? 0 : 2;
  const btVector3 middle = (box.low + box.high) / 2, half = (box.high - box.low) / 2;
  closing_ = std::min(kLongest, static_cast<double>(half[axis]) * (1 - rest) / speed_);
  closed_ = 0;
  direction_.setZero();
  direction_[axis] = 1;
  btVector3 sizes = half * btScalar(1.5) + btVector3(1, 1, 1);
  sizes[axis] = kHalfThickness;
  for (int i = 0; i < 2; ++i) {
    const btScalar side = i == 0 ? btScalar(-1) : btScalar(1);
    starts_[i] = middle + direction_ * side * (half[axis] + kRoom + kHalfThickness);
    const btTransform pose(btQuaternion::getIdentity(), starts_[i]);
    plates_[i] = world->AddBox(sizes, {.pose = pose, .surface = surface_});
    MakeKinematic(plates_[i]);
  }
  phase_ = Phase::kCloses;
  left_ = closing_;
}

void Press::MoveTo(btScalar closed) {
  for (int i = 0; i < 2; ++i) {
    const btVector3 place = starts_[i] + direction_ * (i == 0 ? closed : -closed);
    plates_[i]->setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
  }
}

}  // namespace cairn::bench
