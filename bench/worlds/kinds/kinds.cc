// SPDX-License-Identifier: MIT
#include "worlds/kinds/kinds.h"

// Every kind of world. A new one is a function `void Draw<Name>(Draft*)` in the file of its family
// and a line here, at the end: seeds are worlds of other kinds then.
#define CAIRN_BENCH_KINDS(KIND)                                                              \
  KIND(Chain, "chain", "a chain of any joints with a load at its end, swinging or hanging")  \
  KIND(Garland, "garland", "a chain between two posts with loads hung on it")                \
  KIND(BridgeOnePin, "bridge-one-pin", "planks on one pin each, crates dropped on them")     \
  KIND(BridgeTwoPins, "bridge-two-pins", "planks on two pins each, one more than they need") \
  KIND(BridgeHinges, "bridge-hinges", "planks on hinges")                                    \
  KIND(Drawbridge, "drawbridge", "a bridge with a free end")                                 \
  KIND(SceneBridge, "two-pin-bridge", "the scene of that name, displaced a little")          \
  KIND(Net, "net", "a net on four corners that catches things")                              \
  KIND(Curtain, "curtain", "a net on its upper edge, with something thrown at it")           \
  KIND(Crane, "crane", "a mast, a jib that turns, a rope, a load on the hook")               \
  KIND(WreckingBall, "wrecking-ball", "a ball on a rope swings into a wall")                 \
  KIND(DollsOnStairs, "dolls-on-stairs", "ragdolls fall down stairs")                        \
  KIND(DollsOnPile, "dolls-on-pile", "ragdolls fall on boxes and on each other")             \
  KIND(Tower, "tower", "a stack whose masses grow upwards")                                  \
  KIND(HeavyOnLight, "heavy-on-light", "stacks with one mass far from the others")           \
  KIND(Slab, "slab", "a heavy slab on columns of light boxes")                               \
  KIND(ShotWall, "shot-wall", "a wall of bricks that is shot at")                            \
  KIND(Pyramid, "pyramid", "a pyramid of boxes or hulls, sometimes with a load on top")      \
  KIND(Car, "car", "cars on btHinge2Constraint with motors")                                 \
  KIND(SpringCar, "spring-car", "cars on springs of 6-dof joints with motors")               \
  KIND(Cart, "cart", "carts and trains of carts on motor hinges")                            \
  KIND(SixDofRow, "six-dof-row", "a row of btGeneric6DofConstraint, limits and motors")      \
  KIND(SpringRow, "spring-row", "a row of btGeneric6DofSpringConstraint")                    \
  KIND(Spring2Row, "spring-2-row", "a row of btGeneric6DofSpring2Constraint")                \
  KIND(Sliders, "sliders", "sliders with limits and motors, in rows and one on another")     \
  KIND(ConeTwists, "cone-twists", "chains of cone-twist joints with narrow limits")          \
  KIND(Gears, "gears", "wheels on hinges, geared, with a motor and weights")                 \
  KIND(FixedFrame, "fixed-frame", "boxes fixed to each other, one to several, dropped")      \
  KIND(Ring, "ring", "closed loops of hinges or two pins, more joints than needed")          \
  KIND(Truss, "truss", "a truss of bars and pins with braces it does not need")              \
  KIND(Tree, "tree", "a tree of joints, standing fixed or thrown")                           \
  KIND(PileOfBoxes, "pile-boxes", "boxes in a pit")                                          \
  KIND(PileOfBalls, "pile-balls", "balls in a pit")                                          \
  KIND(PileOfHulls, "pile-hulls", "hulls in a pit")                                          \
  KIND(PileOfCapsules, "pile-capsules", "capsules in a pit")                                 \
  KIND(PileOfAll, "pile-mixed", "all shapes and mass ratios to 1000 in a pit")               \
  KIND(JointedHub, "jointed-hub", "one body with up to 50 others jointed to it")             \
  KIND(TouchedHub, "touched-hub", "one body with up to 50 others lying on it")

namespace cairn::bench {

#define CAIRN_BENCH_DECLARE(name, word, description) void Draw##name(Draft* draft);
CAIRN_BENCH_KINDS(CAIRN_BENCH_DECLARE)
void DrawFloating(Draft* draft);
void DrawFloatingLoop(Draft* draft);
#undef CAIRN_BENCH_DECLARE

std::span<const Kind> Kinds() {
#define CAIRN_BENCH_LINE(name, word, description) {word, description, &Draw##name},
  static const Kind kinds[] = {
      CAIRN_BENCH_KINDS(CAIRN_BENCH_LINE){"floating", "jointed bodies in free fall", &DrawFloating,
                                          true},
      {"floating-loop", "a closed loop of joints in free fall", &DrawFloatingLoop, true}};
  return kinds;
}

}  // namespace cairn::bench
