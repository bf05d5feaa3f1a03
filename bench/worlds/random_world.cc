// SPDX-License-Identifier: MIT
#include "worlds/random_world.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "worlds/draft.h"
#include "worlds/units.h"

namespace cairn::bench {
namespace {

// Random numbers of their own for rules, world and steps: one does not change with another.
constexpr std::uint64_t kRuleStream = 0x5bd1e9955bd1e995u, kDraftStream = 0x27d4eb2f165667c5u,
                        kStepStream = 0x9e3779b185ebca87u, kLockStream = 0xc2b2ae3d27d4eb4fu;

std::uint64_t Stream(std::uint64_t seed, std::uint64_t stream) {
  return Random(seed ^ stream).Bits();
}

/// What a body may not do.
struct Locks {
  btVector3 linear, angular;
};

/// Of a game seen from the side, of one seen from above with balls that roll and without, of
/// characters, of what may lean in one plane.
Locks DrawLocks(Random* random) {
  static const Locks kLocks[] = {{{1, 1, 0}, {0, 0, 1}},
                                 {{1, 0, 1}, {0, 1, 0}},
                                 {{1, 0, 1}, {1, 1, 1}},
                                 {{1, 1, 1}, {0, 0, 0}},
                                 {{1, 1, 1}, {0, 0, 1}}};
  return kLocks[std::min(4, static_cast<int>(random->Within(0, 5)))];
}

/// The same for all bodies, for half of them, or for each its own.
void LockAxes(Random random, World* world) {
  const double draw = random.Within(0, 1);
  Locks locks = DrawLocks(&random);
  for (btRigidBody* body : world->dynamic_bodies()) {
    if (draw > 0.8) locks = DrawLocks(&random);
    if (draw > 0.6 && random.Within(0, 1) < 0.5) continue;
    body->setLinearFactor(locks.linear);
    body->setAngularFactor(locks.angular);
  }
}

}  // namespace

const Kind& KindOf(std::uint64_t seed) { return Kinds()[seed % Kinds().size()]; }

RandomWorld::RandomWorld(const WorldSeed& seed, btConstraintSolver* solver)
    : kind_(KindOf(seed.seed)), world_(solver), steps_(Stream(seed.seed, kStepStream)) {
  Random random(Stream(seed.seed, kRuleStream));
  rules_ = DrawRules(&random);
  Draft draft(&world_, &rules_, Stream(seed.seed, kDraftStream), seed.scale,
              seed.heavy ? Loads::kHeavy : Loads::kAsDrawn,
              seed.crowded ? Hubs::kCrowded : Hubs::kAsDrawn);
  kind_.draw(&draft);
  if (rules_.events) DrawEvents(&draft);
  Apply(rules_, &world_);
  if (kind_.floats) {
    // momentum is watched there, and only what solvers do to it
    for (btRigidBody* body : world_.dynamic_bodies()) body->setFlags(0);
  }
  heavy_ = seed.heavy;
  crowded_ = seed.crowded;
  locks_ = seed.locks;
  if (locks_) LockAxes(Random(Stream(seed.seed, kLockStream)), &world_);
  unit_ = seed.unit;
  if (unit_ != 1) {
    // what happens later is in metres
    ChangeUnits(unit_, &world_);
    return;
  }
  events_ = std::move(draft.events());
  std::stable_sort(events_.begin(), events_.end(),
                   [](const Event& a, const Event& b) { return a.time < b.time; });
}

void RandomWorld::Step() {
  for (; next_event_ < events_.size() && events_[next_event_].time <= time_; ++next_event_) {
    events_[next_event_].happen(&world_);
    // A body that has lost its support, or is to fall on sleepers, must be seen.
    for (btRigidBody* body : world_.dynamic_bodies()) body->activate(true);
  }
  double step = 1 / rules_.rate;
  if (rules_.uneven > 1) step *= std::pow(rules_.uneven, steps_.Within(-1, 1));
  world_.SetTimeStep(static_cast<btScalar>(step));
  world_.Step();
  time_ += step;
}

int RandomWorld::Frames(double seconds) const {
  return std::max(1, static_cast<int>(std::lround(seconds * rules_.rate)));
}

std::string RandomWorld::Describe() const {
  double lightest = HUGE_VAL, heaviest = 0;
  for (const btRigidBody* body : world_.dynamic_bodies()) {
    lightest = std::min<double>(lightest, body->getMass());
    heaviest = std::max<double>(heaviest, body->getMass());
  }
  std::ostringstream text;
  text.precision(3);
  text << kind_.name << ": " << kind_.description << "; " << world_.dynamic_bodies().size()
       << " bodies of " << lightest << " to " << heaviest << " kg, " << world_.joints().size()
       << " joints; " << bench::Describe(rules_);
  if (locks_) text << ", locked axes";
  if (heavy_) text << ", heavy loads";
  if (crowded_) text << ", crowded hubs";
  if (unit_ != 1) text << ", " << unit_ << " units of length in a metre";
  if (!events_.empty()) text << " at";
  for (const Event& event : events_) text << ' ' << event.time;
  if (!events_.empty()) text << " s";
  return text.str();
}

}  // namespace cairn::bench
