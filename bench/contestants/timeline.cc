// SPDX-License-Identifier: MIT
#include "contestants/timeline.h"

#include <LinearMath/btQuickprof.h>

#include <algorithm>
#include <thread>

#include "support/duration.h"

namespace cairn::cli {
namespace {

constexpr int kMostSpans = 1 << 16;
constexpr size_t kMostZones = 1 << 15;

/// The recorder whose frame it is. Bullet's hooks are plain functions without an argument of ours.
TimelineRecorder* active = nullptr;
std::thread::id active_thread;
btEnterProfileZoneFunc* enter_before = nullptr;
btLeaveProfileZoneFunc* leave_before = nullptr;

TimelineSpan ToTimeline(const Span& span, Span::Clock::time_point origin) {
  TimelineSpan result{.name = std::string(Describe(span.label.kind)),
                      .kind = std::string(Describe(span.label.kind)),
                      .begin = Milliseconds(span.begin - origin),
                      .end = Milliseconds(span.end - origin)};
  if (span.label.kind != SpanKind::kSweep) return result;
  result.sweep = span.label.number;
  result.colour = span.label.part;
  return result;
}

}  // namespace

TimelineRecorder::TimelineRecorder(int workers) : spans_(workers, kMostSpans) {
  zones_.reserve(kMostZones);
  open_.reserve(kMostZones);
}

void TimelineRecorder::Enter(const char* name) {
  if (active == nullptr || std::this_thread::get_id() != active_thread) return;
  TimelineRecorder& recorder = *active;
  recorder.bullet_has_zones_ = true;
  if (recorder.zones_.size() == kMostZones) {
    ++recorder.dropped_;
    recorder.open_.push_back(kMostZones);
    return;
  }
  recorder.open_.push_back(recorder.zones_.size());
  recorder.zones_.push_back({name, Span::Clock::now(), {}, false});
}

void TimelineRecorder::Leave() {
  if (active == nullptr || std::this_thread::get_id() != active_thread) return;
  TimelineRecorder& recorder = *active;
  if (recorder.open_.empty()) return;
  const size_t zone = recorder.open_.back();
  recorder.open_.pop_back();
  if (zone < recorder.zones_.size()) recorder.zones_[zone].end = Span::Clock::now();
}

void TimelineRecorder::Begin() {
  spans_.Clear();
  zones_.clear();
  open_.clear();
  dropped_ = 0;
  active = this;
  active_thread = std::this_thread::get_id();
  enter_before = btGetCurrentEnterProfileZoneFunc();
  leave_before = btGetCurrentLeaveProfileZoneFunc();
  btSetCustomEnterProfileZoneFunc(&Enter);
  btSetCustomLeaveProfileZoneFunc(&Leave);
  begin_ = Span::Clock::now();
}

void TimelineRecorder::End() {
  btSetCustomEnterProfileZoneFunc(enter_before);
  btSetCustomLeaveProfileZoneFunc(leave_before);
  active = nullptr;
}

void TimelineRecorder::AddOwn(const char* name, Span::Clock::time_point begin) {
  if (zones_.size() == kMostZones) return;
  zones_.push_back({name, begin, Span::Clock::now(), true});
}

Timeline TimelineRecorder::Read(int frame, double time) const {
  Timeline timeline{.frame = frame, .time = time, .workers = {}, .dropped = 0};
  timeline.dropped = dropped_ + spans_.dropped();
  for (int worker = 0; worker < spans_.workers(); ++worker) {
    std::vector<TimelineSpan>& spans = timeline.workers.emplace_back();
    for (const Span& span : spans_.spans(worker)) spans.push_back(ToTimeline(span, begin_));
  }
  for (const Zone& zone : zones_) {
    timeline.workers.front().push_back({.name = zone.name,
                                        .kind = zone.own ? "tool" : "Bullet",
                                        .begin = Milliseconds(zone.begin - begin_),
                                        .end = Milliseconds(zone.end - begin_)});
  }
  for (auto& spans : timeline.workers) {
    // what contains comes before what it contains
    std::stable_sort(spans.begin(), spans.end(), [](const auto& a, const auto& b) {
      return a.begin != b.begin ? a.begin < b.begin : a.end > b.end;
    });
  }
  while (timeline.workers.size() > 1 && timeline.workers.back().empty()) {
    timeline.workers.pop_back();
  }
  return timeline;
}

}  // namespace cairn::cli
