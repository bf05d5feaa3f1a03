// SPDX-License-Identifier: MIT
#include "cairn/detail/start_memory.h"

#include <algorithm>

#include "cairn/detail/start.h"
#include "engine/room.h"

namespace cairn::detail {
namespace {

/// So many that are asleep are remembered; those that were removed are among them.
constexpr std::size_t kMostAsleep = 1 << 16;

}  // namespace

StartMemory::StartMemory(Memory* memory)
    : moving_(memory),
      added_(memory),
      kept_(memory),
      asleep_(memory),
      kept_impulses_(memory),
      asleep_impulses_(memory),
      spare_(memory) {}

void StartMemory::Begin(std::span<const float> impulses, std::span<const Body> bodies,
                        double time_step) {
  kept_.reserve(added_.size() + asleep_.size());
  asleep_.reserve(added_.size() + asleep_.size());
  for (Array<float>* const all : {&kept_impulses_, &asleep_impulses_, &spare_}) {
    all->reserve(impulses.size() + asleep_impulses_.size());
  }
  moving_.Look(bodies);
  kept_.clear();
  kept_impulses_.clear();
  const std::size_t asleep_before = asleep_.size();
  KeepLast(impulses);
  const bool fell_asleep = asleep_.size() > asleep_before;
  WakeUp();
  if (fell_asleep || asleep_.size() < asleep_before) SortAsleep();
  // of two with one name the first counts; a stable sort would allocate
  std::sort(kept_.begin(), kept_.end(), IsBefore);
  added_.clear();
  end_ = 0;
  time_step_ = time_step;
}

void StartMemory::KeepLast(std::span<const float> impulses) {
  for (Entry entry : added_) {
    // what could not move is asleep since before
    if (entry.key.id == 0 || !entry.moves) continue;
    const bool awake = moving_.AnyOf(entry.bodies);
    Array<float>& to = awake ? kept_impulses_ : asleep_impulses_;
    const auto from = impulses.subspan(static_cast<std::size_t>(entry.first),
                                       static_cast<std::size_t>(entry.count));
    entry.first = static_cast<int>(to.size());
    to.insert(to.end(), from.begin(), from.end());
    (awake ? kept_ : asleep_).push_back(entry);
  }
}

/// Those that wake are as those of the last frame: what is not added is forgotten.
void StartMemory::WakeUp() {
  const auto wakes = [this](const Entry& entry) {
    if (!moving_.AnyOf(entry.bodies)) return false;
    const float* const from = asleep_impulses_.data() + entry.first;
    kept_.push_back(entry);
    kept_.back().first = static_cast<int>(kept_impulses_.size());
    kept_impulses_.insert(kept_impulses_.end(), from, from + entry.count);
    return true;
  };
  asleep_.erase(std::remove_if(asleep_.begin(), asleep_.end(), wakes), asleep_.end());
}

void StartMemory::SortAsleep() {
  // those that fell asleep now are last; of the others some go
  if (asleep_.size() > kMostAsleep) {
    asleep_.erase(asleep_.begin(), asleep_.end() - static_cast<std::ptrdiff_t>(kMostAsleep / 2));
  }
  std::sort(asleep_.begin(), asleep_.end(), IsBefore);
  spare_.clear();
  for (Entry& entry : asleep_) {
    const float* const from = asleep_impulses_.data() + entry.first;
    entry.first = static_cast<int>(spare_.size());
    spare_.insert(spare_.end(), from, from + entry.count);
  }
  asleep_impulses_.swap(spare_);
}

void StartMemory::Reserve(std::size_t more) { MakeRoom(more, &added_); }

StartMemory::Start StartMemory::Add(const Key& key, int body_a, int body_b, int count) {
  Entry entry{key, end_, count, {}, true, time_step_};
  end_ += count;
  if (key.id == 0) {
    added_.push_back(entry);
    return {};
  }
  entry.bodies = moving_.PairOf(body_a, body_b);
  entry.moves = moving_.AnyOf(entry.bodies);
  added_.push_back(entry);
  const Start start = Find(kept_, kept_impulses_, key, count);
  if (start.impulses != nullptr || asleep_.empty()) return start;
  return Find(asleep_, asleep_impulses_, key, count);
}

StartMemory::Start StartMemory::Find(const Array<Entry>& entries, const Array<float>& impulses,
                                     const Key& key, int count) const {
  const auto found =
      std::lower_bound(entries.begin(), entries.end(), key,
                       [](const Entry& entry, const Key& wanted) { return entry.key < wanted; });
  if (found == entries.end() || found->key != key || found->count != count) return {};
  return {impulses.data() + found->first,
          static_cast<float>(ShareOfStart(found->time_step, time_step_))};
}

}  // namespace cairn::detail
