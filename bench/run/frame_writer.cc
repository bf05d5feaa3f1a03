// SPDX-License-Identifier: MIT
#include "run/frame_writer.h"

#include <utility>

namespace cairn::cli {
namespace {

/// Bullet's solvers start friction and joints from nothing, and have no gentle contacts.
bullet::Options LikeBullet() {
  bullet::Options options;
  options.warm_start_friction = options.warm_start_joints = false;
  options.resting_slop = false;
  options.two_friction_directions = false;
  return options;
}

}  // namespace

void FrameWriter::Ask(const std::string& path, int frame, bullet::ConstraintSolver* cairn,
                      WatchedSolver* watched) {
  path_ = path;
  writer_ = cairn;
  if (cairn == nullptr) {
    beside_ = std::make_unique<bullet::ConstraintSolver>(Settings{}, LikeBullet());
    writer_ = beside_.get();
    watched->ProbeNext([this](bench::Substep* substep, const btContactSolverInfo& info) {
      substep->Restore();
      substep->SolveWith(writer_, info, nullptr);
    });
  }
  writer_->RecordNext(path, frame);
}

std::string FrameWriter::Take() {
  const std::string path = std::exchange(path_, "");
  const RecordedFiles& files = writer_->recorded();
  if (files.last_file == path) return "";
  return files.failed > 0 ? "cannot write " + files.last_failure : "nothing moves or touches";
}

}  // namespace cairn::cli
