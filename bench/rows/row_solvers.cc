// SPDX-License-Identifier: MIT
#include "rows/row_solvers.h"

#include <vector>

#include "rows/bullet_row_solver.h"
#include "rows/cairn_row_solver.h"
#include "rows/ipm_row_solver.h"
#include "rows/mlcp_row_solver.h"

namespace cairn::cli {
namespace {

using enum Method;

template <Method method>
std::unique_ptr<RowSolver> MakeCairn(const LcpOptions& options) {
  return std::make_unique<CairnRowSolver>(method, options);
}

std::unique_ptr<RowSolver> MakeNncg(const LcpOptions& options) {
  LcpOptions without_steps = options;
  without_steps.k_sm = 0;
  return std::make_unique<CairnRowSolver>(kPgsSm, without_steps);
}

template <class Solver>
std::unique_ptr<RowSolver> Make(const LcpOptions&) {
  return std::make_unique<Solver>();
}

std::unique_ptr<RowSolver> MakeIpm(const LcpOptions& options) {
  return std::make_unique<IpmRowSolver>(options);
}

}  // namespace

std::span<const RowSolverEntry> RowSolvers() {
  static const std::vector<RowSolverEntry> solvers = {
      {"pgs", "Cairn: projected Gauss-Seidel", &MakeCairn<kPgs>},
      {"psor", "the same, over-relaxed (--omega)", &MakeCairn<kPsor>},
      {"pgs-nncg", "Cairn: sweeps that build on each other", &MakeNncg},
      {"pgs-sm", "Cairn: the same, and subspace steps where they pay", &MakeCairn<kPgsSm>},
      {"ipm", "Mehrotra's predictor-corrector, on frames without friction", &MakeIpm},
      {"bullet-si", "Bullet's sequential impulses, its own row kernels",
       &Make<BulletRowSolver<btSequentialImpulseConstraintSolver>>},
      {"bullet-nncg", "Bullet's nonlinear conjugate gradients on all rows",
       &Make<BulletRowSolver<btNNCGConstraintSolver>>},
      {"bullet-pgs-mlcp", "Bullet's projected Gauss-Seidel on a dense matrix, up to 1000 rows",
       &Make<PgsMlcpRowSolver>},
      {"bullet-dantzig", "Bullet's direct solver on a dense matrix, up to 1000 rows",
       &Make<DantzigRowSolver>},
  };
  return solvers;
}

}  // namespace cairn::cli
