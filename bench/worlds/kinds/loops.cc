// SPDX-License-Identifier: MIT
// Joints in loops and in trees.
#include <cmath>

#include "worlds/kinds/parts.h"

namespace cairn::bench {
namespace {

/// Links around a circle in the xy plane, each held to the next.
std::vector<btRigidBody*> AddRing(Draft* draft, Hold hold, int links, const btVector3& middle) {
  const btScalar half = draft->Draw(0.15, 0.4), mass = draft->DrawRatio(0.5, 5);
  const btScalar radius = half / std::tan(SIMD_PI / btScalar(links));
  const btScalar corner = half / std::sin(SIMD_PI / btScalar(links));
  std::vector<btRigidBody*> ring;
  const auto way = [&](btScalar i) {
    const btScalar angle = SIMD_2_PI * i / btScalar(links);
    return btVector3(std::cos(angle), std::sin(angle), 0);
  };
  for (int i = 0; i < links; ++i) {
    const btVector3 out = way(btScalar(i));
    const btTransform pose = FrameAlongX(middle + radius * out, btVector3(-out.y(), out.x(), 0));
    ring.push_back(draft->Box(btVector3(half * btScalar(0.9), half / 6, half / 2),
                              mass * draft->DrawRatio(0.5, 2), pose));
  }
  for (int i = 0; i < links; ++i) {
    Connect(draft, hold, ring[i], ring[(i + 1) % links],
            {middle + corner * way(btScalar(i) + btScalar(0.5)), btVector3(0, 0, 1),
             btVector3(1, 0, 0), half / 3});
  }
  return ring;
}

}  // namespace

void DrawRing(Draft* draft) {
  draft->Ground();
  constexpr Hold kHolds[] = {Hold::kHinge, Hold::kTwoPins, Hold::kPin, Hold::kSpring2};
  const int rings = draft->Count(1, 3), links = draft->Count(4, 16);
  const Hold hold = kHolds[draft->Choose(4)];
  const btScalar size = btScalar(0.15 * links + 0.6);
  for (int i = 0; i < rings; ++i) {
    const std::vector<btRigidBody*> ring =
        AddRing(draft, hold, links, btVector3(0, size + draft->Draw(0, 1), btScalar(2 * i)));
    if (!draft->Chance(0.5)) continue;
    // Hung on a point of its own.
    btRigidBody* const top = ring[links / 4];
    const btVector3 at = top->getCenterOfMassPosition() + btVector3(0, btScalar(0.2), 0);
    btRigidBody* const nail = draft->Sphere(btScalar(0.05), 0, at);
    Pin(draft, nail, top, at);
  }
}

void DrawTruss(Draft* draft) {
  draft->Ground();
  const int bays = draft->Count(2, 6);
  const btScalar side = draft->Draw(0.6, 1.2), mass = draft->DrawRatio(0.5, 5), thick = side / 20;
  const btScalar height = draft->Draw(1, 3);
  const Hold hold = draft->Chance(0.5) ? Hold::kHinge : Hold::kTwoPins;
  // Knots are blocks; a bar runs from one to another with a joint at each end.
  std::vector<btRigidBody*> knots;
  for (int i = 0; i <= bays; ++i) {
    for (int k = 0; k < 2; ++k) {
      knots.push_back(draft->Box(btVector3(2, 2, 2) * thick, i == 0 ? 0 : mass,
                                 At(side * btScalar(i), height + side * btScalar(k), 0)));
    }
  }
  // Diagonals lie before and behind the others, so that nothing starts inside of anything.
  const auto bar = [&](int a, int b, btScalar layer) {
    const btVector3 z(0, 0, 1), shift = btScalar(2.5) * layer * thick * z;
    const btVector3 from = knots[a]->getCenterOfMassPosition() + shift,
                    to = knots[b]->getCenterOfMassPosition() + shift, along = to - from;
    btRigidBody* const body = draft->Box(btVector3(along.length() / 2 - 3 * thick, thick, thick),
                                         mass, FrameAlongX((from + to) / 2, along));
    const btVector3 cut = 2 * thick * along.normalized();
    const btScalar half_width = thick * btScalar(layer == 0 ? 2 : 0.5);
    Connect(draft, hold, knots[a], body, {from + cut, z, along, half_width});
    Connect(draft, hold, body, knots[b], {to - cut, z, along, half_width});
  };
  const bool crossed = draft->Chance(0.5);
  for (int i = 0; i < bays; ++i) {
    const int k = 2 * i;
    bar(k, k + 2, 0);
    bar(k + 1, k + 3, 0);
    bar(k + 2, k + 3, 0);
    bar(k, k + 3, 1);
    if (crossed) bar(k + 1, k + 2, -1);
  }
  const btScalar half = side / 4;
  draft->Box(btVector3(half, half, half), mass * draft->DrawRatio(0.3, 100),
             At(side * (btScalar(bays) - btScalar(0.5)),
                height + side + 3 * thick + half + btScalar(0.02), 0));
}

void DrawTree(Draft* draft) {
  draft->Ground();
  const int bodies = draft->Count(4, 40);
  const Hold hold = draft->Chance(0.3) ? Hold::kFixed : DrawHold(draft);
  const btScalar length = draft->Draw(0.3, 0.6), mass = draft->DrawRatio(0.5, 10);
  const bool held = draft->Chance(0.6), lighter = draft->Chance(0.7);
  const btScalar spread = draft->Draw(0.5, 1.2);
  btVector3 side(0, 0, 0);
  struct Branch {
    btRigidBody* body;
    btVector3 end, way;
    btScalar mass;
  };
  std::vector<Branch> tree;
  const auto add = [&](const btVector3& from, const btVector3& way, btScalar weight) {
    const btTransform pose = FrameAlongX(from + length / 2 * way, way);
    tree.push_back({draft->Box(length / 2 * btVector3(btScalar(0.75), btScalar(0.1), btScalar(0.1)),
                               weight, pose),
                    from + length * way, way, weight > 0 ? weight : mass});
  };
  add(btVector3(0, held ? 0 : length, 0), btVector3(0, 1, 0), held ? 0 : mass);
  for (int i = 1; i < bodies; ++i) {
    const Branch parent = tree[(i - 1) / 2];
    // The two branches of a fork part to opposite sides.
    if (i % 2 == 1) {
      const btScalar turn = draft->Draw(0, 6.28);
      side = spread * btVector3(std::cos(turn), 0, std::sin(turn));
      side -= side.dot(parent.way) * parent.way;
    } else {
      side = -side;
    }
    const btVector3 way = (parent.way + side).normalized();
    add(parent.end, way, lighter ? parent.mass * draft->Draw(0.4, 1) : mass);
    Connect(draft, hold, parent.body, tree.back().body,
            {parent.end, way.cross(btVector3(btScalar(0.3), 0, 1)).normalized(), way, length / 10});
  }
}

/// Balls, whose inertia is alike about all axes, joined in space; gravity is weak, so that they do
/// not fall fast.
void DrawFloating(Draft* draft) {
  const btScalar aside = draft->Draw(-1, 1), down = draft->Draw(-2, 0);
  draft->rules()->gravity = btVector3(aside, down, 0);
  draft->rules()->events = false;
  const int balls = draft->Count(2, 25);
  const btScalar radius = draft->Draw(0.1, 0.3), mass = draft->DrawRatio(0.5, 5);
  const Hold hold = DrawHold(draft);
  std::vector<btRigidBody*> tree;
  for (int i = 0; i < balls; ++i) {
    const btVector3 at(3 * radius * btScalar(i), 20, 0);
    tree.push_back(draft->Sphere(radius, mass * draft->DrawRatio(0.3, 30), at));
    tree[i]->setLinearVelocity(draft->random()->InCube(2));
    tree[i]->setAngularVelocity(draft->random()->InCube(2));
    if (i > 0) {
      Connect(draft, hold, tree[i - 1], tree[i],
              {at - btVector3(radius * btScalar(1.5), 0, 0), btVector3(0, 0, 1), btVector3(1, 0, 0),
               radius});
    }
  }
}

void DrawFloatingLoop(Draft* draft) {
  draft->rules()->gravity = btVector3(0, draft->Draw(-2, 0), 0);
  draft->rules()->events = false;
  const int balls = draft->Count(3, 16);
  const btScalar radius = draft->Draw(0.1, 0.3), mass = draft->DrawRatio(0.5, 5);
  const btScalar circle = radius * btScalar(1.2) / std::sin(SIMD_PI / btScalar(balls));
  constexpr Hold kHolds[] = {Hold::kHinge, Hold::kTwoPins, Hold::kPin, Hold::kFixed};
  const Hold hold = kHolds[draft->Choose(4)];
  std::vector<btRigidBody*> ring;
  for (int i = 0; i < balls; ++i) {
    const btScalar angle = SIMD_2_PI * btScalar(i) / btScalar(balls);
    ring.push_back(
        draft->Sphere(radius, mass * draft->DrawRatio(0.3, 30),
                      btVector3(circle * std::cos(angle), 20 + circle * std::sin(angle), 0)));
    ring[i]->setLinearVelocity(draft->random()->InCube(1));
  }
  for (int i = 0; i < balls; ++i) {
    btRigidBody *const a = ring[i], *const b = ring[(i + 1) % balls];
    const btVector3 from = a->getCenterOfMassPosition(), to = b->getCenterOfMassPosition();
    Connect(draft, hold, a, b, {(from + to) / 2, btVector3(0, 0, 1), to - from, radius});
  }
}

}  // namespace cairn::bench
