// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "tests/core/support/manifold_problems.h"

namespace cairn::test {

/// A world that grows and shrinks: groups of bodies come, sleep, which takes their rows away, wake
/// and go, and the names of the dead are given to those who come. The seed and nothing else
/// decides.
class CoreLife {
 public:
  CoreLife(std::uint64_t seed, Solver* solver) : random_(seed), solver_(solver) {}

  void Frame();

  /// Of all reports, impulses and velocities.
  std::uint64_t hash() const { return hash_; }
  /// Of the last frame.
  std::size_t rows() const { return rows_; }
  int failures() const { return failures_; }  ///< frames that were not solved, and should have been
  int most_rows() const { return most_rows_; }
  int sleepers() const { return sleepers_; }  ///< groups that fell asleep
  int reused_ids() const { return reused_ids_; }

 private:
  struct Group {
    ManifoldScene scene;
    int last_frame = 0;
    bool asleep = false;
    /// Places of what is its own in the frame.
    int first_body = 0, first_point = 0, first_joint_row = 0, first_row = 0;
  };

  void ChangeGroups();
  void AddGroup();
  void RemoveGroup(int index);
  void ChangeSettings();
  void Assemble();
  void Append(Group* group);
  void TakeImpulses(const ManifoldScene& frame, Group* group);
  void Fold();
  std::uint64_t NewId();

  Random random_;
  Solver* solver_;
  std::vector<Group> groups_;
  std::vector<std::uint64_t> free_ids_;
  std::uint64_t next_id_ = 1;
  int frame_ = 0;
  ManifoldScene now_;
  std::vector<Velocity> velocities_;
  Report report_;
  std::uint64_t hash_ = 0xcbf29ce484222325u;
  std::size_t rows_ = 0;
  int failures_ = 0, most_rows_ = 0, sleepers_ = 0, reused_ids_ = 0;
};

}  // namespace cairn::test
