// SPDX-License-Identifier: MIT
#include "worlds/random_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

const SceneInfo& RandomScene::Info() {
  static constexpr SceneInfo info = {.name = "random",
                                     .description = "A random world of 'cairn worlds'",
                                     .size_means = "as its seed",
                                     .default_size = 0,
                                     .min_size = 0,
                                     .max_size = std::numeric_limits<int>::max(),
                                     .motion = SceneInfo::Motion::kKeepsMoving,
                                     .known_facts = nullptr,
                                     .make = &MakeThat<RandomScene>};
  return info;
}

void RandomScene::AddBodies(World* world, int size) {
  if (!seeded_) seed_.seed = static_cast<std::uint64_t>(size);
  const auto random_of = [this](std::uint64_t stream) {
    return Random(Stream(seed_.seed, stream));
  };
  steps_ = random_of(kStepStream);
  Random random = random_of(kRuleStream);
  rules_ = DrawRules(&random);
  if (!seeded_) rules_.iterations = btContactSolverInfo().m_numIterations;
  Draft draft(world, &rules_, Stream(seed_.seed, kDraftStream), seed_.scale,
              seed_.heavy ? Loads::kHeavy : Loads::kAsDrawn,
              seed_.crowded ? Hubs::kCrowded : Hubs::kAsDrawn);
  kind().draw(&draft);
  if (rules_.events) DrawEvents(&draft);
  Apply(rules_, world);
  if (kind().floats) {
    // momentum is watched there, and only what solvers do to it
    for (btRigidBody* body : world->dynamic_bodies()) body->setFlags(0);
  }
  if (seed_.locks) LockAxes(random_of(kLockStream), world);
  if (seed_.played) player_.emplace(random_of(kPlayerStream));
  if (seed_.dragged) mouse_.emplace(random_of(kMouseStream));
  if (seed_.pressed) press_.emplace(random_of(kPressStream), rules_.surface);
  if (seed_.colliding) LetConnectedCollide(world);
  if (seed_.moving) moving_ground_.emplace(random_of(kGroundStream), world);
  if (seed_.unit != 1) {
    // what happens later is in metres
    ChangeUnits(seed_.unit, world);
    return;
  }
  events_ = std::move(draft.events());
  std::stable_sort(events_.begin(), events_.end(),
                   [](const Event& a, const Event& b) { return a.time < b.time; });
}

void RandomScene::BeforeStep(World* world, int) {
  for (; next_event_ < events_.size() && events_[next_event_].time <= time_; ++next_event_) {
    events_[next_event_].happen(world);
    // A body that has lost its support, or is to fall on sleepers, must be seen.
    for (btRigidBody* body : world->dynamic_bodies()) body->activate(true);
  }
  double step = 1 / rules_.rate;
  if (rules_.uneven > 1) step *= std::pow(rules_.uneven, steps_.Within(-1, 1));
  if (player_) player_->Act(step, world);
  if (mouse_) mouse_->Act(step, world);
  if (press_) press_->Act(step, world);
  time_ += step;
  if (moving_ground_) moving_ground_->MoveTo(time_);
  world->SetTimeStep(static_cast<btScalar>(step));
}

std::string RandomScene::Describe(const World& world) const {
  double lightest = HUGE_VAL, heaviest = 0;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    lightest = std::min<double>(lightest, body->getMass());
    heaviest = std::max<double>(heaviest, body->getMass());
  }
  std::ostringstream text;
  text.precision(3);
  text << kind().name << ": " << kind().description << "; " << world.dynamic_bodies().size()
       << " bodies of " << lightest << " to " << heaviest << " kg, " << world.joints().size()
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

RandomWorld::RandomWorld(const WorldSeed& seed, btConstraintSolver* solver)
    : world_(solver), scene_(seed) {
  scene_.Build(&world_, {});
}

void RandomWorld::Step() {
  scene_.BeforeStep(&world_, 0);
  world_.Step();
}

int RandomWorld::Frames(double seconds) const {
  return std::max(1, static_cast<int>(std::lround(seconds * rules().rate)));
}

}  // namespace cairn::bench
