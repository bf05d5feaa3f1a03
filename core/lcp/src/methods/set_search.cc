// SPDX-License-Identifier: MIT
#include "methods/set_search.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "methods/barrier.h"
#include "methods/face.h"
#include "methods/matrix_pgs.h"
#include "runtime/logarithm.h"

namespace cairn::lcp {
namespace {

/// A pass has to bring the changes of the set down to this share of the fewest before it ...
constexpr double kSettling = 0.7;
/// ... and may fail to do so this often, before the set counts as one that does not settle.
constexpr int kMostSetbacks = 2;

/// Changes in a solve from the prediction of the barrier, relative to the rows with bounds, above
/// which the prediction was wrong; and the share that each further solve has to leave.
constexpr double kGoodPrediction = 0.02, kFinishing = 0.3;
constexpr int kMostFinishing = 4;
/// The prediction is tried when two iterations agree but for this share of the rows, ...
constexpr double kAgreement = 0.01;
/// ... after a step of at least this length.
constexpr double kLongStep = 0.8;
/// What another solve with a set that does not change any more has to leave of the residual.
constexpr double kMostLeft = 0.5;

/// Moves the rows that break their law on the face over to the other side. Returns how many.
int Exchange(const BoxedLcp& problem, const Eigen::VectorXd& y, const Eigen::VectorXd& w,
             RowSet* set) {
  int changes = 0;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    Side& side = (*set)[i];
    Side next = side;
    if (side == Side::kFree) {
      if (y[i] < problem.lo[i]) next = Side::kLower;
      if (y[i] > problem.hi[i]) next = Side::kUpper;
    } else if (problem.lo[i] < problem.hi[i]) {
      if (side == Side::kLower ? w[i] < 0 : w[i] > 0) next = Side::kFree;
    }
    changes += next != side;
    side = next;
  }
  return changes;
}

class SetSearch {
 public:
  SetSearch(LcpState* state, SparseCholesky* reduced, SparseCholesky* whole)
      : state_(state), problem_(state->problem()), face_(state, reduced), whole_(whole) {}

  void Run();

 private:
  enum class Outcome { kDone, kContinue, kUnsettled, kIndefinite, kNoBudget };

  void SweepOnly();
  void SweepWhileItPays(double moved);
  Outcome SweepAndSolve();
  Outcome FinishFrom(RowSet set, Eigen::VectorXd y);
  Outcome Predict();
  /// One reduced solve and exchange; x becomes y brought inside the box. Returns the changes, or -1
  /// for an indefinite matrix.
  int Pass(RowSet* set, Eigen::VectorXd* y);

  LcpState* state_;
  const BoxedLcp& problem_;
  FaceSolver face_;
  SparseCholesky* whole_;
  int fewest_changes_ = std::numeric_limits<int>::max();
  int setbacks_ = 0;
  double factor_sweeps_ = 0;  ///< What a factorisation costs, in sweeps; 0: not known yet.
  double settled_residual_ = std::numeric_limits<double>::infinity();
};

int SetSearch::Pass(RowSet* set, Eigen::VectorXd* y) {
  if (!face_.Solve(*set, y)) return -1;
  const int changes = Exchange(problem_, *y, state_->Slack(*y), set);
  state_->x = *y;
  Clamp(problem_, &state_->x);
  const double residual = state_->Judge();
  if (changes == 0) {
    // the set is right, and solving once more has to be worth it
    if (residual > kMostLeft * settled_residual_) state_->End(StopReason::kStalled);
    settled_residual_ = residual;
  }
  return changes;
}

/// Sweeps on while they are predicted to solve the problem for less than one factorisation: the
/// distance that the rows move falls by the same factor in each batch, or by less.
void SetSearch::SweepWhileItPays(double moved) {
  const Settings& settings = state_->settings();
  if (settings.always_solve) return;
  while (!state_->done()) {
    const double before = std::exchange(moved, state_->SweepTimes(settings.k_gs));
    if (state_->done() || !(moved < before)) return;
    if (moved <= settings.tolerance && state_->Judge() <= settings.tolerance) return;
    const double batches = Log(moved / settings.tolerance) / Log(before / moved);
    if (!(batches * settings.k_gs < factor_sweeps_)) return;
  }
}

/// k_gs sweeps, the predicted set, and k_sm reduced solves, or more while the set settles.
SetSearch::Outcome SetSearch::SweepAndSolve() {
  const Settings& settings = state_->settings();
  const double moved = state_->SweepTimes(settings.k_gs);
  if (factor_sweeps_ > settings.k_gs) SweepWhileItPays(moved);
  state_->Judge();
  if (state_->done()) return Outcome::kDone;

  Eigen::VectorXd y = state_->x;
  RowSet set = SetByNaturalMap(problem_, y, state_->Slack(y), settings.active_tolerance);
  if (factor_sweeps_ == 0) {
    factor_sweeps_ = face_.CostInSweeps(set);
    return Outcome::kContinue;
  }
  bool settling = false;
  for (int k = 0; (k < settings.k_sm || settling) && !state_->done(); ++k) {
    if (!face_.Fits(set)) return Outcome::kNoBudget;
    const int changes = Pass(&set, &y);
    if (changes < 0) return Outcome::kIndefinite;
    state_->Show();
    if (changes == 0) break;

    settling = changes <= kSettling * fewest_changes_;
    if (!settling && ++setbacks_ >= kMostSetbacks) return Outcome::kUnsettled;
    fewest_changes_ = std::min(fewest_changes_, changes);
  }
  return Outcome::kContinue;
}

/// Reduced solves from a set that is thought to be all but right.
SetSearch::Outcome SetSearch::FinishFrom(RowSet set, Eigen::VectorXd y) {
  double most = kGoodPrediction * static_cast<double>(y.size());
  for (int k = 0; k < kMostFinishing; ++k) {
    if (!face_.Fits(set)) return Outcome::kNoBudget;
    const int changes = Pass(&set, &y);
    if (changes < 0) return Outcome::kIndefinite;
    if (state_->done() || changes == 0 || changes > most) break;
    most = kFinishing * changes;
  }
  return Outcome::kContinue;
}

/// Interior point iterations until the set that they predict solves the problem.
SetSearch::Outcome SetSearch::Predict() {
  state_->Restore();
  Barrier barrier(state_, whole_, state_->x);
  RowSet last;
  int wait = 0;
  while (!state_->done()) {
    if (!barrier.Fits()) return Outcome::kNoBudget;
    if (!barrier.Step()) return Outcome::kIndefinite;
    state_->x = barrier.Rounded();
    const double residual = state_->Judge();
    state_->Show(barrier.x());

    RowSet set = barrier.Predicted();
    int changes = static_cast<int>(set.size());
    if (!last.empty()) {
      changes = 0;
      for (size_t i = 0; i < set.size(); ++i) changes += set[i] != last[i];
    }
    last = set;
    const bool agree = changes <= kAgreement * static_cast<double>(set.size());
    if (!state_->done() && agree && barrier.step_length() >= kLongStep && wait-- <= 0) {
      const Outcome outcome = FinishFrom(std::move(set), barrier.x());
      if (outcome != Outcome::kContinue) return outcome;
      wait = 1;
    }

    if (!barrier.Advances(residual)) state_->End(StopReason::kStalled);
  }
  return Outcome::kDone;
}

/// What is left to do with a budget that no factorisation fits.
void SetSearch::SweepOnly() {
  state_->Restore();
  RunSweeps(state_);
}

void SetSearch::Run() {
  Outcome outcome = Outcome::kContinue;
  while (outcome == Outcome::kContinue && !state_->done()) outcome = SweepAndSolve();
  if (outcome == Outcome::kUnsettled) outcome = Predict();
  if (outcome == Outcome::kIndefinite) state_->Fail();
  if (outcome == Outcome::kNoBudget) SweepOnly();
}

}  // namespace

void RunSetSearch(LcpState* state, SparseCholesky* reduced, SparseCholesky* whole) {
  SetSearch(state, reduced, whole).Run();
}

}  // namespace cairn::lcp
