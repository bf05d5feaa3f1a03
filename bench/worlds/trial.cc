// SPDX-License-Identifier: MIT
#include "worlds/trial.h"

#include <cairn/bullet/constraint_solver.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenes/facts.h"
#include "support/machine/stopwatch.h"
#include "worlds/momentum.h"

namespace cairn::bench {
namespace {

/// Keeps NaN, which every comparison hides.
void RaiseTo(double value, double* largest) {
  if (std::isnan(*largest)) return;
  if (!(value <= *largest)) *largest = value;
}

bool AnyAwake(const World& world) {
  return std::any_of(world.dynamic_bodies().begin(), world.dynamic_bodies().end(),
                     [](const btRigidBody* body) { return body->isActive(); });
}

/// One run, frame by frame.
class Run {
 public:
  Run(const TrialOptions& options, const Variant& variant)
      : options_(options),
        solver_(variant.make()),
        cairn_(dynamic_cast<bullet::ConstraintSolver*>(solver_.get())),
        random_(options.world, solver_.get()) {
    if (variant.iterations > 0) {
      random_.world().solver_info().m_numIterations = variant.iterations;
    }
    if (cairn_ != nullptr) cairn_->settings().threads = options.threads;
    const bool kept = !options.world.locks && !options.world.played && !options.world.dragged &&
                      !options.world.pressed;
    if (random_.kind().floats && kept) momentum_.emplace().Listen(&random_.world());
  }

  Trial Finish() {
    const cli::Stopwatch stopwatch(cli::SolverClock::kThreadCpu);
    const int frames = random_.Frames(options_.seconds);
    for (int frame = 0; frame < frames && !hopeless_; ++frame) Step(frame, frames);
    trial_.cpu_seconds = 1e-3 * stopwatch.Read();
    const World& world = random_.world();
    trial_.bodies = static_cast<int>(world.dynamic_bodies().size());
    trial_.joints = static_cast<int>(world.joints().size());
    trial_.energy = TotalEnergy(world) / (options_.world.unit * options_.world.unit);
    trial_.hash = StateHash(world);
    if (momentum_ && !InParts()) {
      trial_.linear_drift = momentum_->linear();
      trial_.angular_drift = momentum_->angular();
    }
    if (random_.rules().sleeping) {
      trial_.asleep_at = AnyAwake(world) ? HUGE_VAL : last_awake_;
    }
    return trial_;
  }

 private:
  void Step(int frame, int frames) {
    if (frame == options_.record_frame && cairn_ != nullptr) {
      cairn_->RecordNext(options_.record_path, frame);
    }
    if (momentum_) momentum_->Begin(random_.world());
    random_.Step();
    ++trial_.frames;
    const World& world = random_.world();
    const double unit = options_.world.unit;
    const double speed = LargestSpeed(world) / unit, gap = LargestJointGap(world) / unit;
    RaiseTo(speed, &trial_.fastest);
    if (frame >= frames - frames / 4) RaiseTo(speed, &trial_.late_fastest);
    if (!std::isnan(gap)) RaiseTo(gap, &trial_.gap);
    RaiseTo(MaxPenetration(world) / unit, &trial_.penetration);
    if (!(speed <= Trial::kTooFast) && trial_.wild_frame < 0) trial_.wild_frame = frame;
    hopeless_ = !(speed <= Trial::kHopeless);
    if (hopeless_) trial_.late_fastest = trial_.fastest;
    if (momentum_) momentum_->End(world, random_.time_step());
    if (random_.rules().sleeping && AnyAwake(world)) last_awake_ = random_.time();
    if (cairn_ != nullptr) Look(frame);
  }

  /// Impulses of the whole step are sums: those of a part were found in a problem of its own, with
  /// bodies where they were then.
  bool InParts() const { return cairn_ != nullptr && cairn_->settings().substeps > 1; }

  /// At what the solver says, and at what its impulses do.
  void Look(int frame) {
    const Report& report = cairn_->report();
    trial_.steps_kept += report.steps_accepted;
    trial_.steps_undone += report.steps_restored;
    if (InParts() || options_.audit_every == 0 || frame % options_.audit_every != 0) return;
    const Audit audit = AuditEnergy(cairn_->problem(), cairn_->impulses());
    ++trial_.audits;
    if (audit.violated()) ++trial_.audits_violated;
    const Audit& worst = trial_.worst_audit;
    if (audit.merit - audit.tolerance <= worst.merit - worst.tolerance) return;
    trial_.worst_audit = audit;
    trial_.worst_frame = frame;
  }

  TrialOptions options_;
  std::unique_ptr<btConstraintSolver> solver_;
  bullet::ConstraintSolver* cairn_;
  std::optional<MomentumWatch> momentum_;  ///< outlives the world, which writes to it
  RandomWorld random_;
  Trial trial_;
  double last_awake_ = 0;
  bool hopeless_ = false;
};

}  // namespace

Trial RunTrial(const TrialOptions& options, const Variant& variant) {
  return Run(options, variant).Finish();
}

}  // namespace cairn::bench
