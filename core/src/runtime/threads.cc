// SPDX-License-Identifier: MIT
#include "cairn/detail/threads.h"

#include "runtime/crew.h"

namespace cairn::detail {
namespace {

class OneStage final : public StagedWork {
 public:
  OneStage(int parts, PartedWork* work, SpanLabel label)
      : parts_(parts), work_(work), label_(label) {}
  int stages() const override { return 1; }
  int units(int) const override { return parts_; }
  void Do(int, int unit) override { work_->Do(unit); }
  SpanLabel label(int) const override { return label_; }

 private:
  int parts_;
  PartedWork* work_;
  SpanLabel label_;
};

}  // namespace

Threads::Threads() : crew_(std::make_unique<Crew>(1)) {}
Threads::~Threads() = default;

void Threads::Follow(int threads, Executor* executor) { crew_->Follow(threads, executor); }
void Threads::Call(int most) { crew_->Call(most); }
void Threads::Dismiss() { crew_->Dismiss(); }
bool Threads::several() const { return crew_->threads() > 1; }
void Threads::RecordTo(SpanRecorder* recorder) { crew_->RecordTo(recorder); }
SpanRecorder* Threads::recorder() const { return crew_->recorder(); }

void Threads::Do(int parts, PartedWork* work, SpanLabel label) {
  OneStage stage(parts, work, label);
  crew_->RunWithThoseHere(&stage);
}

}  // namespace cairn::detail
