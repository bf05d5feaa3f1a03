// SPDX-License-Identifier: MIT
#include "runtime/crew.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <exception>
#include <thread>
#include <utility>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "runtime/own_threads.h"

namespace cairn {
namespace {

/// Looks at a counter this often before the core is offered to somebody else.
constexpr int kSpins = 4000;
/// Units of a stage that can be claimed one by one; more are claimed several at a time.
constexpr int kClaims = 256;
/// And for each thread: more would balance better than stages need, and cost more to claim.
constexpr int kClaimsOfThread = 16;
/// Threads that have a share of a stage of their own; others take from those.
constexpr int kShares = 64;

void Pause() {
#if defined(__SSE2__)
  _mm_pause();
#endif
}

/// One wait: pauses first, then yields.
class Patience {
 public:
  void Wait() {
    if (++waits_ < kSpins) return Pause();
    std::this_thread::yield();
  }

 private:
  int waits_ = 0;
};

/// A stage that helpers may work on: its number since the beginning of time, and its claims, cut
/// into shares.
struct Stage {
  std::uint64_t number;
  int claims, shares;

  static constexpr int kClaimBits = 9, kShareBits = 7;
  static_assert(kClaims < 1 << kClaimBits && kShares < 1 << kShareBits);

  std::uint64_t Packed() const {
    return (number << kClaimBits | static_cast<std::uint64_t>(claims)) << kShareBits |
           static_cast<std::uint64_t>(shares);
  }
  static Stage Unpack(std::uint64_t packed) {
    const auto low = [&packed](int bits) {
      const auto value = static_cast<int>(packed & ((std::uint64_t{1} << bits) - 1));
      packed >>= bits;
      return value;
    };
    const int shares = low(kShareBits), claims = low(kClaimBits);
    return {packed, claims, shares};
  }

  /// Where a share begins, and the one before it ends.
  int Begin(int share) const { return claims * share / shares; }
};

/// A part of the claims of a stage, which one thread takes first. It has a cache line of its own:
/// a thread that is undisturbed claims without a word to others.
class alignas(128) Share {
 public:
  /// The next claim of a stage that nobody has, of @p begin to @p end; -1: none is left.
  int Claim(std::uint64_t stage, int begin, int end) {
    std::uint64_t last = next_.load(std::memory_order_relaxed);
    for (;;) {
      const std::uint64_t at = last >> kBits;
      // a stage of a later number has been here: this one is done
      if (at > stage) return -1;
      const int claim = at < stage ? begin : static_cast<int>(last & kMask);
      if (claim >= end) return -1;
      const std::uint64_t next = stage << kBits | static_cast<std::uint64_t>(claim + 1);
      if (next_.compare_exchange_weak(last, next, std::memory_order_acq_rel,
                                      std::memory_order_relaxed)) {
        return claim;
      }
    }
  }

 private:
  static constexpr int kBits = Stage::kClaimBits;
  static constexpr std::uint64_t kMask = (1 << kBits) - 1;
  std::atomic<std::uint64_t> next_{0};  ///< number of a stage, then a claim
};

/// What helpers see. It lives until the last of them has gone, and nothing else is touched by a
/// helper that has claimed nothing.
class Board : public detail::Placed {
 public:
  void Release() {
    if (owners_.fetch_sub(1, std::memory_order_acq_rel) == 1) delete this;
  }
  /// A task is about to be submitted, by a helper that was counted.
  void AddTask() {
    owners_.fetch_add(1, std::memory_order_relaxed);
    // whoever takes it sees this board as it was made, whatever the executor says to its threads
    tasks_.fetch_add(1, std::memory_order_release);
  }
  /// What the executor runs. Once too often, while there is a crew, does nothing.
  void RunTask() {
    if (!TakeTask()) return;
    Help();
    Release();
  }
  /// The task will not be run.
  void DropTask() {
    if (!TakeTask()) return;
    helpers_.fetch_sub(1);
    Release();
  }

  /// Counts one more helper; false if enough are here or on their way.
  bool Expect() {
    int helpers = helpers_.load();
    while (helpers < most_helpers_.load(std::memory_order_relaxed)) {
      if (helpers_.compare_exchange_weak(helpers, helpers + 1)) return true;
    }
    return false;
  }

  void Open(int most_helpers) {
    caller_.store(std::this_thread::get_id(), std::memory_order_relaxed);
    most_helpers_.store(most_helpers, std::memory_order_relaxed);
    open_.store(true);
  }
  void Close() { open_.store(false, std::memory_order_release); }
  bool open() const { return open_.load(std::memory_order_relaxed); }
  int most_helpers() const { return most_helpers_.load(std::memory_order_relaxed); }

  /// The caller: does one stage with whoever is there.
  void DoStage(StagedWork* work, int stage) {
    const int units = work->units(stage);
    SpanRecorder* const recorder = recorder_.load(std::memory_order_relaxed);
    if (units <= 1 || !open()) {
      const SpanClock clock(recorder, 0, LabelOf(recorder, *work, stage), units);
      for (int unit = 0; unit < units; ++unit) work->Do(stage, unit);
      return;
    }
    const int threads = most_helpers() + 1;
    const int claims = std::min({units, kClaims, kClaimsOfThread * threads});
    work_.store(work, std::memory_order_relaxed);
    stage_.store(stage, std::memory_order_relaxed);
    units_.store(units, std::memory_order_relaxed);
    done_.store(0, std::memory_order_relaxed);
    const Stage now{++number_, claims, std::min(threads, kShares)};
    published_.store(now.Packed(), std::memory_order_release);
    Attend(now, 0);
    // what is claimed is being worked on by a running thread: this wait ends
    {
      const SpanClock clock(recorder, 0, {SpanKind::kWait});
      for (Patience patience; done_.load(std::memory_order_acquire) < claims;) patience.Wait();
    }
    if (!failed_.load(std::memory_order_relaxed)) return;
    failed_.store(false, std::memory_order_relaxed);
    std::rethrow_exception(std::exchange(failure_, nullptr));
  }

  /// A helper, already counted: works until the board is closed.
  void Help() {
    // what the caller wrote before it opened the board is seen from here on
    static_cast<void>(open_.load(std::memory_order_acquire));
    if (caller_.load(std::memory_order_relaxed) == std::this_thread::get_id()) {
      // it would wait for itself
      helpers_.fetch_sub(1);
      return;
    }
    const detail::MemoryScope scope(memory_);
    const int lane = TakeLane();
    do {
      HelpWhileOpen(lane);
      helpers_.fetch_sub(1);
      // opened again in between: whoever opened it may have counted on this helper
    } while (open_.load() && Expect());
    GiveBack(lane);
  }

  void RecordTo(SpanRecorder* recorder) { recorder_.store(recorder, std::memory_order_relaxed); }

 private:
  bool TakeTask() {
    int tasks = tasks_.load();
    while (tasks > 0 && !tasks_.compare_exchange_weak(tasks, tasks - 1)) continue;
    return tasks > 0;
  }

  /// A label costs a virtual call, so only where somebody wants it.
  static SpanLabel LabelOf(const SpanRecorder* recorder, const StagedWork& work, int stage) {
    return recorder != nullptr ? work.label(stage) : SpanLabel{};
  }

  /// The lowest lane that nobody has; one that is not recorded if all are taken. The caller has the
  /// first. A lane says whose share a helper begins with, so that it meets the same units in every
  /// sweep, and where what it does is recorded.
  int TakeLane() {
    std::uint64_t taken = lanes_.load(std::memory_order_relaxed);
    while (~taken != 0) {
      const int lane = std::countr_one(taken);
      const std::uint64_t with = taken | std::uint64_t{1} << lane;
      if (lanes_.compare_exchange_weak(taken, with, std::memory_order_acquire)) return lane;
    }
    return SpanRecorder::kMostWorkers;
  }
  void GiveBack(int lane) {
    if (lane >= SpanRecorder::kMostWorkers) return;
    lanes_.fetch_and(~(std::uint64_t{1} << lane), std::memory_order_release);
  }

  void HelpWhileOpen(int lane) {
    std::uint64_t seen = 0;
    Patience patience;
    while (open_.load(std::memory_order_acquire)) {
      const std::uint64_t packed = published_.load(std::memory_order_acquire);
      if (packed == seen) {
        patience.Wait();
        continue;
      }
      seen = packed;
      Attend(Stage::Unpack(packed), lane);
      patience = {};
    }
  }

  /// Does what is left of a stage, from its own share on.
  void Attend(const Stage& stage, int lane) {
    for (int i = 0; i < stage.shares; ++i) {
      const int share = (lane + i) % stage.shares;
      const int begin = stage.Begin(share), end = stage.Begin(share + 1);
      int done = 0;
      for (int claim; (claim = shares_[share].Claim(stage.number, begin, end)) >= 0; ++done) {
        try {
          DoClaim(claim, stage.claims, lane);
        } catch (...) {
          // the caller throws it, when nobody is at work any more
          if (!failed_.exchange(true, std::memory_order_relaxed)) {
            failure_ = std::current_exception();
          }
        }
      }
      // once a share: all who are here write to this counter
      if (done > 0) done_.fetch_add(done, std::memory_order_release);
    }
  }

  void DoClaim(int claim, int claims, int lane) {
    // stable now: the caller waits for what is claimed
    StagedWork* const work = work_.load(std::memory_order_relaxed);
    const int stage = stage_.load(std::memory_order_relaxed);
    const std::int64_t units = units_.load(std::memory_order_relaxed);
    const int begin = static_cast<int>(units * claim / claims);
    const int end = static_cast<int>(units * (claim + 1) / claims);
    SpanRecorder* const recorder = recorder_.load(std::memory_order_relaxed);
    const SpanClock clock(recorder, lane, LabelOf(recorder, *work, stage), end - begin);
    for (int unit = begin; unit < end; ++unit) work->Do(stage, unit);
  }

  Memory* const memory_ = detail::MemoryOfThread();  ///< of the crew, and what it takes
  std::atomic<int> owners_{1}, helpers_{0}, most_helpers_{0};
  std::atomic<int> tasks_{0};  ///< submitted, and not run yet
  std::atomic<std::thread::id> caller_{};
  std::uint64_t number_ = 0;
  std::atomic<StagedWork*> work_{nullptr};
  std::atomic<SpanRecorder*> recorder_{nullptr};
  std::atomic<std::uint64_t> lanes_{1};  ///< that are taken, a bit each
  std::atomic<int> stage_{0}, units_{0};
  std::array<Share, kShares> shares_;
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;  ///< of the first claim of a stage that threw
  alignas(128) std::atomic<bool> open_{false};
  alignas(128) std::atomic<std::uint64_t> published_{0};
  alignas(128) std::atomic<int> done_{0};
};

}  // namespace

bool StagedWork::GoOn(int) { return true; }

struct Crew::Impl : detail::Placed {
  ~Impl() {
    if (board == nullptr) return;
    board->Close();
    board->Release();
  }

  int asked;    ///< threads that the settings ask for
  int threads;  ///< that there can be
  Executor* given;
  std::unique_ptr<Executor> own;  ///< made when helpers are called first: small problems need none
  Memory* const memory = detail::MemoryOfThread();
  Board* board = nullptr;  ///< of the caller alone there is none: it takes nine kilobytes
};

Crew::Crew(int threads, Executor* executor)
    : impl_(std::make_unique<Impl>()), alone_(threads == 1) {
  impl_->asked = impl_->threads = threads;
  impl_->given = executor;
  if (threads == 1) return;
  impl_->board = new Board;
  if (executor != nullptr) return;
  impl_->threads = std::min(threads, MostOwnThreads());
}
Crew::~Crew() = default;
Crew::Crew(Crew&&) noexcept = default;
Crew& Crew::operator=(Crew&&) noexcept = default;

void Crew::Follow(int threads, Executor* executor) {
  const bool same = impl_->asked == threads && impl_->given == executor;
  if (same) return;
  const detail::MemoryScope scope(impl_->memory);  // hosts call this, too
  *this = Crew(threads, executor);
}

void Crew::RecordTo(SpanRecorder* recorder) {
  recorder_ = recorder;
  if (impl_->board != nullptr) impl_->board->RecordTo(recorder);
}

void Crew::Call(int most) {
  const int threads = std::min(most, impl_->threads);
  if (threads <= 1) return;
  if (impl_->given == nullptr && impl_->own == nullptr) {
    impl_->own = MakeOwnExecutor(impl_->threads);
  }
  Executor* const executor = impl_->given != nullptr ? impl_->given : impl_->own.get();
  Board* const board = impl_->board;
  board->Open(threads - 1);
  const auto task = [](void* what) { static_cast<Board*>(what)->RunTask(); };
  try {
    // those that return at once are not asked for again
    for (int i = 1; i < threads && board->Expect(); ++i) {
      board->AddTask();
      executor->Submit(task, board);
    }
  } catch (...) {
    // the one that was not taken
    board->DropTask();
    board->Close();
    throw;
  }
}

void Crew::Dismiss() {
  if (impl_->board != nullptr) impl_->board->Close();
}
bool Crew::called() const { return impl_->board != nullptr && impl_->board->open(); }
int Crew::threads() const { return called() ? impl_->board->most_helpers() + 1 : 1; }

namespace {

/// Closes a board in the end, whatever happens before.
class Closing {
 public:
  explicit Closing(Board* board) : board_(board) {}
  ~Closing() {
    if (board_ != nullptr) board_->Close();
  }
  Closing(const Closing&) = delete;
  Closing& operator=(const Closing&) = delete;

 private:
  Board* board_;
};

}  // namespace

void Crew::RunAlone(StagedWork* work) const {
  for (int stage = 0; stage < work->stages() && work->GoOn(stage); ++stage) {
    const int units = work->units(stage);
    const SpanClock clock(recorder_, 0, recorder_ != nullptr ? work->label(stage) : SpanLabel{},
                          units);
    for (int unit = 0; unit < units; ++unit) work->Do(stage, unit);
  }
}

void Crew::Run(StagedWork* work) {
  if (alone_) return RunAlone(work);
  const bool called_before = called();
  if (!called_before) Call();
  const Closing closing(called_before ? nullptr : impl_->board);
  RunWithThoseHere(work);
}

void Crew::RunWithThoseHere(StagedWork* work) {
  if (alone_) return RunAlone(work);
  for (int stage = 0; stage < work->stages() && work->GoOn(stage); ++stage) {
    impl_->board->DoStage(work, stage);
  }
}

}  // namespace cairn
