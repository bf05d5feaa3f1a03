// SPDX-License-Identifier: MIT
#include "scenes/joints/hanging_chain.h"

namespace cairn::bench {
namespace {

constexpr btScalar kThickness = btScalar(0.2);  // [m]
constexpr btScalar kLinkLength = HangingChain::kLinkLength;
constexpr btScalar kBallRadius = HangingChain::kBallRadius;

/// Hangs a body by `pivot` on the lower end of a link, or on the world if there is none.
void Pin(World* world, btRigidBody* body, const btVector3& pivot, btRigidBody* link) {
  auto pin = link == nullptr ? std::make_unique<btPoint2PointConstraint>(*body, pivot)
                             : std::make_unique<btPoint2PointConstraint>(
                                   *body, *link, pivot, btVector3(0, -kLinkLength / 2, 0));
  world->AddJoint(std::move(pin), ConnectedBodies::kPassThrough);
}

}  // namespace

void AddHangingChain(World* world, const HangingChain& chain, const btTransform& frame) {
  const btVector3 half(kThickness / 2, kLinkLength / 2, kThickness / 2);
  const btVector3 top(0, kLinkLength / 2, 0), ball_top(0, kBallRadius, 0);
  btRigidBody* previous = nullptr;
  for (int i = 0; i < chain.links; ++i) {
    const btScalar y = -(btScalar(i) + btScalar(0.5)) * kLinkLength;
    btRigidBody* link = world->AddBox(half, {.mass = chain.link_mass, .pose = frame * At(0, y, 0)});
    Pin(world, link, top, previous);
    previous = link;
  }
  const btScalar y = -btScalar(chain.links) * kLinkLength - kBallRadius;
  Pin(world, world->AddSphere(kBallRadius, {.mass = chain.ball_mass, .pose = frame * At(0, y, 0)}),
      ball_top, previous);
}

}  // namespace cairn::bench
