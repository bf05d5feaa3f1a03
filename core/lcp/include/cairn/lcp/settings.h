// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include "cairn/budget.h"
#include "cairn/executor.h"
#include "cairn/report.h"

namespace cairn::lcp {

enum class Method {
  kPgs,            ///< Projected Gauss-Seidel: sweeps only.
  kPsor,           ///< The same with over-relaxation Settings::omega.
  kPgsSm,          ///< Sweeps and reduced solves, made robust; see docs/matrix.md.
  kPgsSmLiteral,   ///< Sweeps and reduced solves exactly as the paper states them, unguarded.
  kInteriorPoint,  ///< Mehrotra's predictor-corrector; rows without bounds stay equations.
};

/// The order in which rows are swept.
enum class SweepOrder {
  kAutomatic,  ///< kColoured for many rows (20,000) of few colours (8), else kForward.
  kForward,    ///< Row 0 first.
  kReverse,    ///< Row 0 last.
  kSymmetric,  ///< Forward and reverse in turn.
  kColoured,   ///< Colour by colour, on all threads: rows of a colour share no entry of M. Same
               ///< bits for any number of threads.
};

/// How hard to try. Plain data; Solve() rejects values out of range, and Report::bad_setting names
/// the first.
struct Settings {
  Method method = Method::kPgsSm;
  SweepOrder order = SweepOrder::kAutomatic;
  int k_gs = 5;  ///< Sweeps before each subspace phase, >= 1.
  /// Reduced solves in one phase at most, in [0, 1000]; 0 makes every method but kInteriorPoint
  /// plain sweeps. kPgsSm goes on beyond it while the predicted set settles.
  int k_sm = 2;
  int max_sweeps = 1000;    ///< In one Solve() at most, >= 0.
  double tolerance = 1e-3;  ///< Done when LcpResidual::relative is no more, >= 0; 0 means never.
  /// Also done when a sweep moved x by no more: sqrt(sum d_i (change of x_i)^2), >= 0; at 0
  /// only one that changed nothing.
  double min_progress = 0;
  Budget budget = Budget::Unlimited();
  int min_sweeps = 1;  ///< Made even if the budget is spent before them, >= 0.
  /// That may work on one Solve(), the caller included, in [1, 1024]; used by coloured sweeps.
  int threads = 1;
  Executor* executor =
      nullptr;       ///< Of the other threads; nullptr: as in Settings. Must outlive Solve().
  double omega = 1;  ///< Over-relaxation of kPsor, in (0, 2). 1 is Gauss-Seidel.
  /// Of kPgsSm: a reduced solve after every k_gs sweeps, even where sweeps alone are predicted to
  /// get there for less.
  bool always_solve = false;
  /// A row belongs to the predicted free set if it is further than this from its bounds, unit of x,
  /// >= 0; the paper's tol.
  double active_tolerance = 0;
};

/// The first setting that is out of its range, if any.
[[nodiscard]] BadSetting FindBadSetting(const Settings& settings);

}  // namespace cairn::lcp
