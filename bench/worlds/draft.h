// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "scenes/random.h"
#include "worlds/rules.h"

namespace cairn::bench {

/// What happens to a world in its course, at a time [s].
struct Event {
  double time;
  std::function<void(World*)> happen;
};

/// Whether what hangs on ropes and lies on bridges is made heavier than a kind has it.
enum class Loads { kAsDrawn, kHeavy };
/// Whether ten times as many bodies may touch one as a kind has it.
enum class Hubs { kAsDrawn, kCrowded };

/// A world while it is drawn: random numbers, and bodies and joints that fit each other. Lengths in
/// m, masses in kg; all bodies have the surface of the rules.
class Draft {
 public:
  /// @param scale  in (0, 1]: how much of its size the world may have; see Count()
  Draft(World* world, Rules* rules, std::uint64_t seed, double scale, Loads loads, Hubs hubs)
      : world_(world),
        rules_(rules),
        random_(seed),
        load_random_(~seed),
        loads_(loads),
        hubs_(hubs),
        scale_(scale) {}

  World* world() { return world_; }
  Rules* rules() { return rules_; }
  Random* random() { return &random_; }
  double scale() const { return scale_; }

  /// Within [low, high).
  btScalar Draw(double low, double high) { return btScalar(random_.Within(low, high)); }
  /// The same, even in the logarithm: of mass ratios.
  btScalar DrawRatio(double low, double high);
  /// The mass of a load; with numbers of its own, so that all else is drawn as without.
  btScalar Load(btScalar mass);
  bool Chance(double probability) { return random_.Within(0, 1) < probability; }
  /// Any of 0 to n - 1.
  int Choose(int n) { return static_cast<int>(random_.Within(0, n)); }
  /// A size within [least, most], scaled down but never below `least`.
  int Count(int least, int most);
  /// The same of bodies that touch one.
  int CountOfHub(int least, int most) {
    return Count(least, hubs_ == Hubs::kCrowded ? 10 * most : most);
  }

  /// A mass of 0 makes a body static.
  btRigidBody* Box(const btVector3& half, btScalar mass, const btTransform& pose);
  btRigidBody* Sphere(btScalar radius, btScalar mass, const btVector3& at);
  /// Axis along y of the pose; `length` between the centres of the caps.
  btRigidBody* Capsule(btScalar radius, btScalar length, btScalar mass, const btTransform& pose);
  btRigidBody* Cylinder(btScalar radius, btScalar height, btScalar mass, const btTransform& pose);
  /// Random corners around the centre, `radius` at most.
  btRigidBody* Hull(btScalar radius, btScalar mass, const btTransform& pose);
  /// A box, hull, sphere or capsule that fits into a ball of `radius`.
  btRigidBody* Thing(btScalar radius, btScalar mass, const btVector3& at);
  /// A static floor with its top at y = 0.
  void Ground();

  /// Adds a joint; its bodies pass through each other.
  template <class Joint>
  Joint* Add(std::unique_ptr<Joint> joint) {
    Joint* const added = joint.get();
    world_->AddJoint(std::move(joint), ConnectedBodies::kPassThrough);
    return added;
  }

  void At(double time, std::function<void(World*)> happen) {
    events_.push_back({time, std::move(happen)});
  }
  std::vector<Event>& events() { return events_; }

 private:
  World::Placing Place(btScalar mass, const btTransform& pose) const {
    return {.mass = mass, .pose = pose, .surface = rules_->surface};
  }

  World* world_;
  Rules* rules_;
  Random random_, load_random_;
  Loads loads_;
  Hubs hubs_;
  double scale_;
  std::vector<Event> events_;
};

/// One to four things that happen to any world: a joint or a body goes, a body comes from above,
/// two bodies near each other are pinned, gravity turns, all are kicked.
/// @pre the bodies are there
void DrawEvents(Draft* draft);

}  // namespace cairn::bench
