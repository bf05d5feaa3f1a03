// SPDX-License-Identifier: MIT
#include "worlds/random_world.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "worlds/conditions/collisions.h"
#include "worlds/conditions/locks.h"
#include "worlds/conditions/units.h"
#include "worlds/draft.h"

namespace cairn::bench {
namespace {

// Random numbers of their own for rules, world and steps: one does not change with another.
constexpr std::uint64_t kRuleStream = 0x5bd1e9955bd1e995u, kDraftStream = 0x27d4eb2f165667c5u,
                        kStepStream = 0x9e3779b185ebca87u, kLockStream = 0xc2b2ae3d27d4eb4fu,
                        kPlayerStream = 0xd6e8feb86659fd93u, kGroundStream = 0xa0761d6478bd642fu,
                        kMouseStream = 0xe7037ed1a0b428dbu, kPressStream = 0x8ebc6af09c88c6e3u;

std::uint64_t Stream(std::uint64_t seed, std::uint64_t stream) {
  return Random(seed ^ stream).Bits();
}

}  // namespace

const Kind& KindOf(std::uint64_t seed) { return Kinds()[seed % Kinds().size()]; }

RandomWorld::RandomWorld(const WorldSeed& seed, btConstraintSolver* solver)
    : kind_(KindOf(seed.seed)),
      world_(solver),
      steps_(Stream(seed.seed, kStepStream)),
      seed_(seed) {
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
  const auto random_of = [&seed](std::uint64_t stream) {
    return Random(Stream(seed.seed, stream));
  };
  if (seed.locks) LockAxes(random_of(kLockStream), &world_);
  if (seed.played) player_.emplace(random_of(kPlayerStream));
  if (seed.dragged) mouse_.emplace(random_of(kMouseStream));
  if (seed.pressed) press_.emplace(random_of(kPressStream), rules_.surface);
  if (seed.colliding) LetConnectedCollide(&world_);
  if (seed.moving) moving_ground_.emplace(random_of(kGroundStream), &world_);
  if (seed.unit != 1) {
    // what happens later is in metres
    ChangeUnits(seed.unit, &world_);
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
  if (player_) player_->Act(step, &world_);
  if (mouse_) mouse_->Act(step, &world_);
  if (press_) press_->Act(step, &world_);
  if (moving_ground_) moving_ground_->MoveTo(time_ + step);
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
  for (const Condition& condition : Conditions()) {
    if (seed_.*condition.on) text << ", " << condition.words;
  }
  if (seed_.unit != 1) text << ", " << seed_.unit << " units of length in a metre";
  if (!events_.empty()) text << " at";
  for (const Event& event : events_) text << ' ' << event.time;
  if (!events_.empty()) text << " s";
  return text.str();
}

}  // namespace cairn::bench
