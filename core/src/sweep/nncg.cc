// SPDX-License-Identifier: MIT
#include "sweep/nncg.h"

#include <algorithm>
#include <tuple>
#include <type_traits>
#include <utility>

#include "runtime/in_parts.h"
#include "simd/flush_denormals.h"

namespace cairn {
namespace {

/// The island of what belongs to none, as in Plan::islands_of().
constexpr int kNone = -1;
/// Bodies of a Part, and of a group that one thread moves.
constexpr int kMostOfPart = 512;

}  // namespace

/// How far the last sweep went on in large groups; then their units and their bodies, and others
/// as a whole.
class Nncg::Pass final : public StagedWork {
 public:
  Pass(std::span<const GroupSweeps> groups, BlockFrame* frame, Nncg* nncg)
      : groups_(groups), plan_(frame->plan()), frame_(frame), nncg_(*nncg) {}

  int stages() const override { return nncg_.shared_.empty() ? 1 : 2; }
  int units(int stage) const override {
    return static_cast<int>(IsLast(stage) ? plan_.units().size() + plan_.groups().size()
                                          : nncg_.shared_.size());
  }
  bool GoOn(int stage) override {
    for (size_t g = 0; g < groups_.size() && stage > 0; ++g) {
      const bool alone = nncg_.MovesAlone(plan_.groups()[g]);
      if (groups_[g].active && !alone) nncg_.ForgetWhereGoneBack(static_cast<int>(g));
    }
    return true;
  }
  /// The beginning of the sweep that follows.
  SpanLabel label(int) const override {
    int sweep = 0;
    for (const GroupSweeps& group : groups_) sweep = group.active ? group.sweeps : sweep;
    return {SpanKind::kSweep, sweep};
  }
  void Do(int stage, int unit) override {
    if (!IsLast(stage)) {
      const int part = nncg_.shared_[unit];
      const int island = nncg_.parts_[part].island;
      if (groups_[plan_.islands()[island].group].active) nncg_.FindProgress(part, frame_);
      return;
    }
    const int blocks = static_cast<int>(plan_.units().size());
    const int group = unit < blocks ? plan_.units()[unit].group : unit - blocks;
    if (!groups_[group].active) return;
    const bool alone = nncg_.MovesAlone(plan_.groups()[group]);
    if (unit >= blocks) {
      if (alone) return nncg_.MoveGroupOn(group, frame_);
      nncg_.MoveBodies(plan_.groups()[group], frame_);
    } else if (!alone) {
      nncg_.MoveImpulses(plan_.units()[unit].first_block, plan_.units()[unit].blocks, frame_);
    }
  }

  /// All of it at once, where nobody shares it.
  void DoAll(SpanRecorder* recorder) {
    const SpanClock clock(recorder, 0, recorder != nullptr ? label(0) : SpanLabel{});
    for (size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].active) nncg_.MoveGroupOn(static_cast<int>(g), frame_);
    }
  }

 private:
  bool IsLast(int stage) const { return stage + 1 == stages(); }

  std::span<const GroupSweeps> groups_;
  const Plan& plan_;
  BlockFrame* frame_;
  Nncg& nncg_;
};

void Nncg::Begin(const BlockFrame& frame) {
  now_.momenta.assign(frame.plan().islands().size() + 1, {});
  now_.energies.assign(frame.plan().islands().size(), 0);
  known_ = false;
  if (plan_number_ == frame.plan_number()) return;
  plan_number_ = frame.plan_number();
  ReadPlan(frame.plan());
}

void Nncg::ReadPlan(const Plan& plan) {
  FindEnds(plan);
  island_of_slot_.clear();
  for (int body : plan.body_of_slot()) {
    island_of_slot_.push_back(body == kWorld ? kNone : plan.island_of_body()[body]);
  }
  FindParts(plan);
}

void Nncg::FindParts(const Plan& plan) {
  slots_.clear();
  parts_.clear();
  first_part_.clear();
  shared_.clear();
  const std::span<const int> bodies = plan.body_of_slot();
  for (const Group& group : plan.groups()) {
    first_part_.push_back(static_cast<int>(parts_.size()));
    const auto begin = static_cast<std::ptrdiff_t>(slots_.size());
    for (int slot = group.first_slot; slot < group.first_slot + group.slots; ++slot) {
      if (island_of_slot_[slot] != kNone) slots_.push_back(slot);
    }
    std::sort(slots_.begin() + begin, slots_.end(), [&](int a, int b) {
      return std::tuple(island_of_slot_[a], bodies[a], a) <
             std::tuple(island_of_slot_[b], bodies[b], b);
    });
    for (int i = static_cast<int>(begin); i < static_cast<int>(slots_.size()); ++i) {
      const int island = island_of_slot_[slots_[i]];
      const bool more = i > begin && parts_.back().island == island;
      if (!more || parts_.back().count == kMostOfPart) {
        if (!MovesAlone(group)) shared_.push_back(static_cast<int>(parts_.size()));
        parts_.push_back({island, i, 0});
      }
      ++parts_.back().count;
    }
  }
  first_part_.push_back(static_cast<int>(parts_.size()));
  progress_.resize(parts_.size());
}

void Nncg::FindEnds(const Plan& plan) {
  constexpr int kAll = simd::RowShape{}.max_sweeps;
  ends_.clear();
  newest_end_.assign(plan.islands().size(), kAll);
  for (int b = 0; b < static_cast<int>(plan.blocks().size()); ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    int before = kAll;  // rows of a block mostly end together, as do those of an island
    for (const simd::RowShape& row : std::span(block.rows, block.row_count)) {
      if (std::exchange(before, row.max_sweeps) == row.max_sweeps || row.max_sweeps == kAll)
        continue;
      for (int l = 0; l < block.lanes; ++l) {
        const int island = plan.island_of(b, l);
        const int newest = std::exchange(newest_end_[island], row.max_sweeps);
        if (newest == row.max_sweeps) continue;
        ends_.push_back({plan.islands()[island].group, row.max_sweeps, island});
      }
    }
  }
  std::sort(ends_.begin(), ends_.end());
  ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
}

void Nncg::ForgetWhereRowsEnd(int group, int sweeps) {
  const auto [first, last] = std::equal_range(
      ends_.begin(), ends_.end(), End{group, sweeps, 0}, [](const End& a, const End& b) {
        return std::pair(a.group, a.sweeps) < std::pair(b.group, b.sweeps);
      });
  for (auto end = first; end != last; ++end) Forget(end->island);
}

void Nncg::Forget(int island) {
  MomentumOf(island) = {};
  now_.energies[island] = 0;
}

void Nncg::ForgetAll() {
  std::fill(now_.momenta.begin(), now_.momenta.end(), simd::Momentum{});
  std::fill(now_.energies.begin(), now_.energies.end(), 0);
}

void Nncg::Copy(const Plan& plan, const Group& group, const Course& from, Course* to) {
  const auto copy = [](const auto& some, int first, int count, auto* others) {
    if (others->size() < some.size()) others->resize(some.size());
    std::copy_n(some.begin() + first, count, others->begin() + first);
  };
  for (const int i : plan.islands_in(group)) {
    copy(from.momenta, i + 1, 1, &to->momenta);
    copy(from.energies, i, 1, &to->energies);
  }
  copy(from.last.x, group.first_x, group.x_lines, &to->last.x);
  copy(from.direction.x, group.first_x, group.x_lines, &to->direction.x);
  copy(from.last.bodies, group.first_slot, group.slots, &to->last.bodies);
  copy(from.direction.bodies, group.first_slot, group.slots, &to->direction.bodies);
}

void Nncg::Keep(const Plan& plan, const Group& group) {
  kept_known_ = known_;
  if (known_) Copy(plan, group, now_, &kept_);
}

void Nncg::GoBack(const Plan& plan, const Group& group) {
  if (kept_known_) return Copy(plan, group, kept_, &now_);
  for (const int i : plan.islands_in(group)) Forget(i);
}

void Nncg::See(int island, double energy) {
  const double before = std::exchange(now_.energies[island], energy);
  const double ratio = before == 0 ? 0 : energy / before;
  const bool shrinks = ratio <= 1;
  MomentumOf(island) = {.beta = shrinks ? static_cast<float>(ratio * ratio) : 0,
                        .keep = shrinks ? 1.0f : 0.0f};
}

void Nncg::Remember(const BlockData& now, Crew* crew) {
  constexpr int kLinesOfPart = 1024;
  // resize() alone would copy what is overwritten anyway
  const auto make_room = [](size_t size, auto* numbers) {
    if (numbers->size() < size) numbers->clear();
    numbers->resize(size);
  };
  const auto copy = [crew](const auto& from, auto* to, auto* cleared) {
    const auto part = [&](int first, int count) {
      std::copy_n(from.begin() + first, count, to->begin() + first);
      std::fill_n(cleared->begin() + first, count,
                  typename std::decay_t<decltype(from)>::value_type{});
    };
    InParts(static_cast<int>(from.size()), kLinesOfPart, crew, part, {SpanKind::kSweep, 0, -1});
  };
  make_room(now.x.size(), &now_.last.x);
  make_room(now.x.size(), &now_.direction.x);
  make_room(now.bodies.size(), &now_.last.bodies);
  make_room(now.bodies.size(), &now_.direction.bodies);
  copy(now.x, &now_.last.x, &now_.direction.x);
  copy(now.bodies, &now_.last.bodies, &now_.direction.bodies);
}

bool Nncg::StartsFrom(const BlockData& now, Crew* crew) {
  if (known_) return false;
  Remember(now, crew);
  known_ = true;
  return true;
}

void Nncg::MoveImpulses(int first_block, int blocks, BlockFrame* frame) {
  const Plan& plan = frame->plan();
  frame->lane_kernels().move_blocks(
      &MomentumOf(0), &plan.blocks()[first_block], plan.islands_of(first_block), blocks,
      {frame->blocks().x.data(), now_.last.x.data(), now_.direction.x.data()});
}

void Nncg::MoveBodies(const Group& group, BlockFrame* frame) {
  const auto of_group = [&](auto& bodies) { return bodies.data() + group.first_slot; };
  frame->lane_kernels().move_bodies(&MomentumOf(0), of_group(island_of_slot_), group.slots,
                                    {of_group(frame->blocks().bodies), of_group(now_.last.bodies),
                                     of_group(now_.direction.bodies)});
}

bool Nncg::MovesAlone(const Group& group) { return group.slots <= kMostOfPart; }

void Nncg::FindProgress(int part, BlockFrame* frame) {
  const auto [island, first, count] = parts_[part];
  if (MomentumOf(island).beta == 0) return;
  progress_[part] = frame->lane_kernels().find_progress(
      slots_.data() + first, count,
      {frame->blocks().bodies.data(), now_.last.bodies.data(), now_.direction.bodies.data()});
}

void Nncg::ForgetWhereGoneBack(int group) {
  for (int part = first_part_[group], end = part; part < first_part_[group + 1]; part = end) {
    const int island = parts_[part].island;
    double progress = 0;
    for (; end < first_part_[group + 1] && parts_[end].island == island; ++end) {
      progress += progress_[end];
    }
    if (MomentumOf(island).beta != 0 && progress < 0) MomentumOf(island) = {};
  }
}

void Nncg::MoveGroupOn(int group, BlockFrame* frame) {
  const simd::FlushDenormals flush;  // one for all kernels
  for (int part = first_part_[group]; part < first_part_[group + 1]; ++part) {
    FindProgress(part, frame);
  }
  ForgetWhereGoneBack(group);
  const Group& of = frame->plan().groups()[group];
  MoveImpulses(of.first_block, of.blocks, frame);
  MoveBodies(of, frame);
}

void Nncg::MoveOn(std::span<const GroupSweeps> groups, Crew* crew, BlockFrame* frame) {
  if (StartsFrom(frame->blocks(), crew)) return;
  Pass pass(groups, frame, this);
  if (crew->alone()) return pass.DoAll(crew->recorder());
  crew->Run(&pass);
}

}  // namespace cairn
