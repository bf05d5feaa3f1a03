// SPDX-License-Identifier: MIT
// Bridges of planks, loaded with crates.
#include <algorithm>
#include <cmath>

#include "scenes/scene.h"
#include "worlds/kinds/parts.h"

namespace cairn::bench {
namespace {

struct Planks {
  Strand strand;
  std::vector<btVector3> line;
  std::vector<btRigidBody*> bodies;
};

Strand DrawPlanks(Draft* draft, Hold hold) {
  Strand strand;
  strand.hold = hold;
  strand.half_thickness = draft->Draw(0.03, 0.08);
  strand.half_width = draft->Draw(0.4, 1);
  strand.mass = draft->DrawRatio(0.5, 15);
  strand.first_static = true;
  return strand;
}

/// Crates a little above planks in the middle, or all along.
void DropCrates(Draft* draft, const Planks& bridge) {
  const int count = draft->Count(1, 8);
  const btScalar half = draft->Draw(0.15, 0.4), above = draft->Draw(0.01, 2);
  const btScalar mass =
      draft->Load(bridge.strand.mass * draft->DrawRatio(0.3, draft->Chance(0.2) ? 200 : 40));
  const int planks = static_cast<int>(bridge.bodies.size());
  btScalar last = -1000;
  for (int i = 0; i < count; ++i) {
    const int plank = std::clamp((2 * i + 1) * planks / (2 * count), 1, planks - 1);
    const btVector3 at = bridge.bodies[plank]->getCenterOfMassPosition();
    if (at.x() < last + 2 * half + btScalar(0.05)) continue;
    last = at.x();
    // On a slope a crate's corner is what comes first.
    draft->Box(btVector3(half, half, half), mass,
               At(at.x(), at.y() + half * btScalar(1.9) + above + bridge.strand.half_thickness, 0));
  }
}

void DrawBridge(Draft* draft, Hold hold) {
  draft->Ground();
  Planks bridge;
  bridge.strand = DrawPlanks(draft, hold);
  bridge.strand.last_static = true;
  const int planks = draft->Count(6, 40);
  const btScalar span = btScalar(planks) * draft->Draw(0.35, 0.8);
  const btScalar sag = span * draft->Draw(0.01, 0.2), height = sag + draft->Draw(1, 5);
  bridge.line =
      Sagging(btVector3(-span / 2, height, 0), btVector3(span / 2, height, 0), sag, planks);
  bridge.bodies = AddStrand(draft, bridge.strand, bridge.line);
  DropCrates(draft, bridge);
}

}  // namespace

void DrawBridgeOnePin(Draft* draft) { DrawBridge(draft, Hold::kPin); }
void DrawBridgeTwoPins(Draft* draft) { DrawBridge(draft, Hold::kTwoPins); }
void DrawBridgeHinges(Draft* draft) { DrawBridge(draft, Hold::kHinge); }

void DrawDrawbridge(Draft* draft) {
  draft->Ground();
  constexpr Hold kHolds[] = {Hold::kPin, Hold::kTwoPins, Hold::kHinge, Hold::kSpring2};
  Planks bridge;
  bridge.strand = DrawPlanks(draft, kHolds[draft->Choose(4)]);
  const int planks = draft->Count(4, 20);
  const btScalar pitch = draft->Draw(0.3, 0.7), slope = draft->Draw(-0.3, 0.8);
  const btScalar length = pitch * btScalar(planks);
  const btScalar height = length * draft->Draw(0.4, 1.2) + btScalar(0.5);
  bridge.line = Straight(btVector3(0, height, 0),
                         pitch * btVector3(std::cos(slope), std::sin(slope), 0), planks);
  bridge.bodies = AddStrand(draft, bridge.strand, bridge.line);
  if (draft->Chance(0.6)) DropCrates(draft, bridge);
}

void DrawSceneBridge(Draft* draft) {
  *draft->rules() = Rules{};
  Apply(*draft->rules(), draft->world());
  const std::unique_ptr<Scene> scene = Make(*FindScene("two-pin-bridge"));
  const int planks = draft->Count(12, 50);
  // As designed in one of twenty worlds.
  const std::uint64_t seed = draft->Chance(0.05) ? 0 : 1 + draft->random()->Bits() % 1000;
  scene->Build(draft->world(), {.size = draft->scale() == 1 ? 50 : planks, .seed = seed});
}

}  // namespace cairn::bench
