// SPDX-License-Identifier: MIT
#include "tests/core/solver/core_life.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace cairn::test {
namespace {

constexpr int kFewestGroups = 1, kMostGroups = 16;
constexpr int kPeriod = 1200;  // frames from one crowd to the next
constexpr int kCrowdFrames = 8, kCrowd = 110;
constexpr int kShortestLife = 20, kLongestLife = 400;  // of a group, in frames
constexpr int kPauseEvery = 700, kPause = 20;          // frames in which nobody is there

/// FNV-1a.
void FoldBytes(const void* from, std::size_t size, std::uint64_t* hash) {
  const auto* const bytes = static_cast<const unsigned char*>(from);
  for (std::size_t i = 0; i < size; ++i) *hash = (*hash ^ bytes[i]) * 0x100000001b3u;
}

template <class T>
void FoldAll(const std::vector<T>& from, std::uint64_t* hash) {
  if (!from.empty()) FoldBytes(from.data(), from.size() * sizeof(T), hash);
}

/// In the numbers of another scene; the world stays what it is.
int Moved(int body, int by) { return body == kWorld ? kWorld : body + by; }

}  // namespace

std::uint64_t CoreLife::NewId() {
  if (free_ids_.empty()) return next_id_++;
  const std::uint64_t id = free_ids_.back();
  free_ids_.pop_back();
  ++reused_ids_;
  return id;
}

void CoreLife::AddGroup() {
  Group group;
  const auto seed = static_cast<std::uint64_t>(random_.Index(1 << 20));
  const int size = 2 + random_.Index(6);
  switch (random_.Index(4)) {
    case 0:
    case 1:
      group.scene = ManifoldTower(size);
      break;
    case 2:
      group.scene = RollingManifolds(size, 2 * size, seed);
      break;
    default:
      group.scene = RandomManifolds(size, size, seed);
      AddJoints(size, seed, &group.scene);
  }
  group.scene.motions.clear();
  group.scene.twists.resize(group.scene.points.size());
  group.scene.twist_impulses.resize(group.scene.points.size());
  const Scene pile = RandomPile({.bodies = size, .contacts = random_.Index(3)}, seed);
  group.scene.rows = pile.rows;
  group.scene.row_impulses.assign(pile.rows.size(), 0.0);
  for (Body& body : group.scene.bodies) body.id = NewId();
  group.last_frame = frame_ + kShortestLife + random_.Index(kLongestLife - kShortestLife);
  groups_.push_back(std::move(group));
}

void CoreLife::RemoveGroup(int index) {
  for (const Body& body : groups_[index].scene.bodies) free_ids_.push_back(body.id);
  groups_.erase(groups_.begin() + index);
}

void CoreLife::ChangeSettings() {
  Settings& settings = solver_->settings();
  settings.max_sweeps = 5 + random_.Index(15);
  settings.tolerance = random_.Index(2) == 0 ? 1e-3 : 0;
  settings.k_sm = random_.Index(3);
  settings.step_policy = random_.Index(4) == 0 ? StepPolicy::kAlways : StepPolicy::kMeasured;
  const bool limited = random_.Index(3) == 0;
  settings.budget = limited ? Budget::Work(100 * random_.Index(200)) : Budget::Unlimited();
}

void CoreLife::ChangeGroups() {
  for (int i = static_cast<int>(groups_.size()) - 1; i >= 0; --i) {
    if (groups_[i].last_frame < frame_) RemoveGroup(i);
  }
  const int phase = frame_ % kPeriod;
  const double wave = 0.5 + 0.5 * std::sin(frame_ * 0.01);
  int wanted = kFewestGroups + static_cast<int>(wave * (kMostGroups - kFewestGroups));
  if (phase < kCrowdFrames) wanted = kCrowd;
  while (static_cast<int>(groups_.size()) > std::max(wanted, kMostGroups)) {
    RemoveGroup(random_.Index(static_cast<int>(groups_.size())));
  }
  if (frame_ % kPauseEvery < kPause) {
    while (!groups_.empty()) RemoveGroup(0);
    return;
  }
  while (static_cast<int>(groups_.size()) < wanted) AddGroup();
  for (Group& group : groups_) {
    if (random_.Index(60) != 0) continue;
    group.asleep = !group.asleep;
    sleepers_ += group.asleep;
  }
  if (random_.Index(50) == 0) ChangeSettings();
}

void CoreLife::Append(Group* group) {
  const ManifoldScene& from = group->scene;
  group->first_body = static_cast<int>(now_.bodies.size());
  group->first_point = static_cast<int>(now_.points.size());
  group->first_joint_row = static_cast<int>(now_.joint_rows.size());
  group->first_row = static_cast<int>(now_.rows.size());
  const auto add = [](const auto& more, auto* to) {
    to->insert(to->end(), more.begin(), more.end());
  };
  add(from.bodies, &now_.bodies);
  if (group->asleep) return;
  for (Row row : from.rows) {
    row.body_a = Moved(row.body_a, group->first_body);
    row.body_b = Moved(row.body_b, group->first_body);
    if (row.parent != kNoRow) row.parent += group->first_row;
    now_.rows.push_back(row);
  }
  for (Manifold manifold : from.manifolds) {
    manifold.body_a = Moved(manifold.body_a, group->first_body);
    manifold.body_b = Moved(manifold.body_b, group->first_body);
    manifold.first_point += group->first_point;
    now_.manifolds.push_back(manifold);
  }
  for (Joint joint : from.joints) {
    joint.body_a = Moved(joint.body_a, group->first_body);
    joint.body_b = Moved(joint.body_b, group->first_body);
    joint.first_row += group->first_joint_row;
    now_.joints.push_back(joint);
  }
  add(from.points, &now_.points);
  add(from.twists, &now_.twists);
  add(from.joint_rows, &now_.joint_rows);
  add(from.row_impulses, &now_.row_impulses);
  add(from.point_impulses, &now_.point_impulses);
  add(from.twist_impulses, &now_.twist_impulses);
  add(from.joint_impulses, &now_.joint_impulses);
}

void CoreLife::TakeImpulses(const ManifoldScene& frame, Group* group) {
  if (group->asleep) return;
  const auto take = [](const auto& from, int first, auto* to) {
    std::copy_n(from.begin() + first, to->size(), to->begin());
  };
  take(frame.row_impulses, group->first_row, &group->scene.row_impulses);
  take(frame.point_impulses, group->first_point, &group->scene.point_impulses);
  take(frame.twist_impulses, group->first_point, &group->scene.twist_impulses);
  take(frame.joint_impulses, group->first_joint_row, &group->scene.joint_impulses);
}

void CoreLife::Fold() {
  FoldBytes(&report_.status, sizeof report_.status, &hash_);
  FoldBytes(&report_.sweeps, sizeof report_.sweeps, &hash_);
  FoldBytes(&report_.work, sizeof report_.work, &hash_);
  FoldAll(now_.row_impulses, &hash_);
  FoldAll(now_.point_impulses, &hash_);
  FoldAll(now_.twist_impulses, &hash_);
  FoldAll(now_.joint_impulses, &hash_);
  FoldAll(velocities_, &hash_);
}

void CoreLife::Frame() {
  ChangeGroups();
  now_ = {};
  for (Group& group : groups_) Append(&group);
  velocities_.assign(now_.bodies.size(), Velocity{});
  solver_->Solve(now_.problem(), now_.impulses(), velocities_, &report_);
  const Status expected = now_.bodies.empty() ? Status::kEmptyProblem : Status::kOk;
  failures_ += report_.status != expected;
  Fold();
  for (Group& group : groups_) TakeImpulses(now_, &group);
  rows_ = AllRows(now_.problem());
  most_rows_ = std::max(most_rows_, static_cast<int>(rows_));
  ++frame_;
}

}  // namespace cairn::test
