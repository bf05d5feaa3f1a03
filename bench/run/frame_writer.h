// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "cairn/bullet/constraint_solver.h"
#include "contestants/watched_solver.h"

namespace cairn::cli {

/// Writes what the solver of a world is given in its next substep to a file; of a solver of
/// Bullet's, what it would have been given in the adapter.
class FrameWriter {
 public:
  /// @param cairn  the solver, if it is Cairn's; else nullptr. Both must outlive the substep.
  void Ask(const std::string& path, int frame, bullet::ConstraintSolver* cairn,
           WatchedSolver* watched);
  /// Whether a file was asked for since the last Take().
  bool asked() const { return !path_.empty(); }
  /// After the substep: why there is no file, empty if there is.
  std::string Take();

 private:
  std::string path_;
  bullet::ConstraintSolver* writer_ = nullptr;
  std::unique_ptr<bullet::ConstraintSolver> beside_;
};

}  // namespace cairn::cli
