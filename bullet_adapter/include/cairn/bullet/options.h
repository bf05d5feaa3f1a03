// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include "cairn/bullet/precision.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

/// Who turns Bullet's joints and contacts into rows, and writes the results back.
enum class Mode {
  /// Cairn. Friction and joints start from the impulses of the substep before. A group that this
  /// cannot take is left to kReference; ConstraintSolver::fell_back() tells.
  kFast,
  /// btSequentialImpulseConstraintSolver, the base class, which is slower. Without steps friction
  /// of what lifts off keeps its impulse, as Bullet's does, whatever Tuning::lifted_friction says.
  kReference,
};

/// Who says when an island has had enough.
enum class Effort {
  kAuto,  ///< kIterations without a budget, kSettings with one.
  /// btContactSolverInfo: m_numIterations, m_leastSquaresResidualThreshold, and what joints
  /// override, instead of Settings::max_sweeps and Settings::tolerance. A budget is kept.
  kIterations,
  /// Settings::max_sweeps, Settings::tolerance and the budget. None of the above is read.
  kSettings,
};

/// How joints and contacts go to the solver in Mode::kFast.
enum class ContactForm {
  /// As cairn::Joint and cairn::Manifold, if they fit (docs/bullet.md): faster.
  kManifolds,
  kRows,  ///< All as rows; also wherever sweeps are made in double precision.
};

/// How the adapter works; how hard the solver tries is in cairn::Settings.
struct Options {
  Mode mode = Mode::kFast;
  Effort effort = Effort::kAuto;
  ContactForm contacts = ContactForm::kManifolds;
  /// Friction starts from impulses in the points, if SOLVER_USE_WARMSTARTING is set. Mode::kFast.
  bool warm_start_friction = true;
  bool warm_start_joints = true;    ///< So do joints, if this solver made the last substep.
  bool geometric_stiffness = true;  ///< As Settings::geometric_stiffness; both must be on. kFast.
  /// Contacts that have lasted for 2 s become gentle: they rest .1 g h^2 deep, m_erp2 counts for
  /// 3/4. Not with m_linearSlop, or a CFM, ERP, stiffness of points; docs/tuning.md. kFast.
  bool resting_slop = true;
  /// Two directions of friction, of which the second holds less where a point slides; with one,
  /// towers fall. Not without steps, or with SOLVER_ENABLE_FRICTION_DIRECTION_CACHING. kFast.
  bool two_friction_directions = true;
};

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
