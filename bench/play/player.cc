// SPDX-License-Identifier: MIT
#include "play/player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/facts.h"
#include "support/duration.h"

namespace cairn::play {
namespace {

/// Measuring costs about a sweep: every step of small worlds, every fifth of large ones.
constexpr size_t kManyBodies = 400;
constexpr int kSparse = 5;
constexpr size_t kHalfSecond = 30;  // steps at 60 Hz

constexpr btScalar kPinForce = btScalar(30 * 9.81);  // of a pin on a body of 1 kg [N]
constexpr btScalar kPinErp = btScalar(0.2);
constexpr btScalar kBallDensity = 600;  // [kg/m^3]

}  // namespace

Player::Player(const Controls& controls, const PlayerControls& own) {
  SetSolver(own.solver);
  played_ = MakePlayedWorld(controls.scene, watched_.get());
  watched_->Watch(played_->world().bullet());
  defaults_ = played_->world().solver_info();
  Apply(controls, own);
}

Player::~Player() { Release(); }

void Player::SetSolver(const std::string& name) {
  const auto solvers = cli::Solvers();
  const auto found = std::find_if(solvers.begin(), solvers.end(),
                                  [&](const auto& entry) { return entry.name == name; });
  entry_ = &*found;  // names are checked where they are set
  std::unique_ptr<cli::Contestant> contestant = entry_->make();
  auto watched = std::make_unique<cli::WatchedSolver>(contestant->solver());
  if (played_) {
    watched->Watch(played_->world().bullet());
    played_->world().bullet()->setConstraintSolver(watched.get());
  }
  writer_ = {};  // it knows the solver that goes
  watched_ = std::move(watched);
  contestant_ = std::move(contestant);
}

void Player::Apply(const Controls& controls, const PlayerControls& own) {
  if (entry_->name != own.solver) SetSolver(own.solver);
  effort_.iterations = own.iterations;
  contestant_->AllowThreads(own.threads);
  if (cairn() != nullptr) {
    cairn()->settings().steps = own.steps;
    cairn()->settings().acceleration = own.acceleration ? Acceleration::kNncg : Acceleration::kNone;
  }
  own_ = own;
  measure_ = controls.measure;
  substeps_ = controls.substeps;
  if (played_->has_own_steps()) return;
  played_->world().SetTimeStep(btScalar(1) / btScalar(controls.rate));
  if (controls.sleep && !sleep_) played_->world().LetSleep();
  if (!controls.sleep) {
    for (btRigidBody* body : played_->world().dynamic_bodies()) {
      body->forceActivationState(DISABLE_DEACTIVATION);
    }
  }
  sleep_ = controls.sleep;
}

void Player::Observe() {
  observing_ = measure_ &&
               (played_->world().dynamic_bodies().size() <= kManyBodies || frame_ % kSparse == 0);
  if (!observing_) return contestant_->Observe(nullptr);
  residual_ = 0;
  contestant_->Observe([this](const ContactProblem& problem, std::span<const double> impulses) {
    const Report report = Measure(problem, impulses);
    if (report.ok()) residual_ = std::max(residual_, report.residual_max);
  });
}

void Player::Step(std::optional<std::chrono::nanoseconds> budget) {
  effort_.budget = entry_->control == cli::Control::kClock ? budget : std::nullopt;
  if (played_->recorded() != nullptr) return SolveRecording();
  if (!failure_.empty()) return;
  btContactSolverInfo info = defaults_;
  contestant_->Begin(effort_, &info);
  played_->world().solver_info() = info;
  Observe();

  const auto& objects = played_->world().bullet()->getCollisionObjectArray();
  before_.clear();
  for (int i = 0; i < objects.size(); ++i) before_.push_back(objects[i]->getWorldTransform());

  const auto begin = std::chrono::steady_clock::now();
  played_->Step(substeps_ * entry_->parts);
  Take(std::chrono::steady_clock::now() - begin);
  if (writer_.asked()) {
    const std::string fault = writer_.Take();
    saved_ = fault.empty() ? "written " + saved_ : fault;
  }
  failure_ = !contestant_->refusal().empty() ? contestant_->refusal() : watched_->failure();
}

void Player::Take(std::chrono::nanoseconds all) {
  const bench::World& world = played_->world();
  const std::chrono::nanoseconds observing = contestant_->TakeObservingTime();
  const std::chrono::nanoseconds solver = watched_->TakeTime();
  const cli::Work work = contestant_->work();
  Sample sample{.solver_ms = cli::Milliseconds(solver - observing),
                .world_ms = cli::Milliseconds(all - solver),
                .residual = residual_,
                .energy = bench::TotalEnergy(world),
                .penetration = bench::MaxPenetration(world),
                .joint_gap = bench::LargestJointGap(world),
                .sweeps = work.iterations,
                .steps_kept = work.steps_accepted,
                .steps_undone = work.steps_restored,
                .guarded = work.guarded};
  if (cairn() != nullptr) {
    const bullet::SubstepTimes times = cairn()->times();
    sample.build_ms = cli::Milliseconds(times.build);
    sample.solve_ms = cli::Milliseconds(times.solve);
    sample.write_ms = cli::Milliseconds(times.write);
  }
  for (const btRigidBody* body : world.dynamic_bodies()) sample.asleep += !body->isActive();
  Keep(sample);
}

void Player::Keep(const Sample& sample) {
  if (history_.size() == kMostHistory) history_.erase(history_.begin());
  history_.push_back(sample);
  ++frame_;
}

void Player::SolveRecording() {
  cli::FrameWorld& recorded = *played_->recorded();
  Settings settings = recorded.problem().frame.settings;
  settings.threads = own_.threads;
  settings.steps = own_.steps && entry_->name != "cairn-pgs";
  settings.acceleration = own_.acceleration ? Acceleration::kNncg : Acceleration::kNone;
  cli::RowLimit limit{.iterations = {}, .time = effort_.budget};
  if (!limit.time) limit.iterations = own_.iterations;
  failure_ = recorded.Solve(*entry_, settings, limit);
  if (!failure_.empty()) return;
  if (measure_) residual_ = recorded.Residual();
  const cli::RowOutcome& outcome = recorded.outcome();
  Keep({.solver_ms = cli::Milliseconds(recorded.time()),
        .residual = residual_,
        .energy = NAN,
        .penetration = NAN,
        .joint_gap = NAN,
        .sweeps = outcome.iterations,
        .steps_kept = outcome.steps_accepted,
        .steps_undone = outcome.steps_restored,
        .guarded = recorded.cairn() ? recorded.cairn()->report().guarded : 0});
}

double Player::MeanSolverTime() const {
  const size_t count = std::min(history_.size(), kHalfSecond);
  double sum = 0;
  for (size_t i = history_.size() - count; i < history_.size(); ++i) sum += history_[i].solver_ms;
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

void Player::Shoot(const btVector3& from, const btVector3& velocity, double mass) {
  if (played_->recorded() != nullptr) return;
  const btScalar volume = btScalar(mass) / kBallDensity;
  const btScalar radius = std::cbrt(volume * 3 / (4 * SIMD_PI));
  btTransform pose = btTransform::getIdentity();
  pose.setOrigin(from);
  btRigidBody* const ball =
      played_->world().AddSphere(radius, {.mass = btScalar(mass), .pose = pose});
  ball->setLinearVelocity(velocity);
}

void Player::Grab(int body, const btVector3& at) {
  Release();
  const auto bodies = played_->world().dynamic_bodies();
  if (body < 0 || body >= static_cast<int>(bodies.size()) || played_->recorded()) return;
  btRigidBody* const held = bodies[body];
  pin_ = std::make_unique<btPoint2PointConstraint>(*held,
                                                   held->getCenterOfMassTransform().inverse() * at);
  pin_->m_setting.m_impulseClamp =
      kPinForce * held->getMass() * played_->world().time_step() / btScalar(substeps_);
  pin_->setParam(BT_CONSTRAINT_STOP_ERP, kPinErp);
  held->activate(true);
  played_->world().bullet()->addConstraint(pin_.get());
}

void Player::Move(const btVector3& to) {
  if (!pin_) return;
  pin_->setPivotB(to);
  pin_->getRigidBodyA().activate(true);
}

void Player::Release() {
  if (!pin_) return;
  played_->world().bullet()->removeConstraint(pin_.get());
  pin_.reset();
}

int Player::Pick(const btVector3& from, const btVector3& to, btVector3* at) const {
  btCollisionWorld::ClosestRayResultCallback hit(from, to);
  world().bullet()->rayTest(from, to, hit);
  if (!hit.hasHit()) return -1;
  const auto bodies = world().dynamic_bodies();
  const auto found = std::find(bodies.begin(), bodies.end(), hit.m_collisionObject);
  *at = hit.m_hitPointWorld;
  return found == bodies.end() ? -1 : static_cast<int>(found - bodies.begin());
}

void Player::SaveNext(const std::string& path) {
  saved_ = "this is a recording already";
  if (played_->recorded() != nullptr) return;
  saved_ = path;
  writer_.Ask(path, frame_, cairn(), watched_.get());
}

const Settings* Player::settings() {
  cli::FrameWorld* const recorded = played_->recorded();
  if (recorded == nullptr) return cairn() == nullptr ? nullptr : &cairn()->settings();
  return recorded->cairn() == nullptr ? nullptr : &recorded->cairn()->settings();
}

std::optional<IslandReport> Player::ReportOf(int body) {
  if (cli::FrameWorld* const recorded = played_->recorded()) {
    return recorded->ReportOf(*world().dynamic_bodies()[body]);
  }
  if (cairn() == nullptr || frame_ == 0) return {};
  const Report& report = cairn()->report();
  const auto place = static_cast<size_t>(cairn()->place_of(*world().dynamic_bodies()[body]));
  if (place >= report.island_of.size() || report.island_of[place] < 0) return {};
  return report.islands[report.island_of[place]];
}

btTransform Player::Pose(const btRigidBody& body, btScalar share) const {
  const btTransform& now = body.getWorldTransform();
  const auto index = static_cast<size_t>(body.getWorldArrayIndex());
  if (share >= 1 || index >= before_.size() || body.isStaticOrKinematicObject()) return now;
  const btTransform& then = before_[index];
  return btTransform(then.getRotation().slerp(now.getRotation(), share),
                     then.getOrigin().lerp(now.getOrigin(), share));
}

}  // namespace cairn::play
