// SPDX-License-Identifier: MIT
// Frames allocate nothing once the solver has seen as much. Every allocation of the process is
// counted, on any thread: this program has a malloc of its own, which asks that of the C library.
// (oneTBB has an allocator beside malloc for its tasks: what that one takes is not seen.)
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/support/block_problems.h"
#include "tests/core/support/manifold_problems.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CAIRN_COUNTS_ALLOCATIONS 1
#else
#define CAIRN_COUNTS_ALLOCATIONS 0
#endif

namespace cairn {
namespace {

std::atomic<long> allocations{0};

void Count() { allocations.fetch_add(1, std::memory_order_relaxed); }

}  // namespace
}  // namespace cairn

#if CAIRN_COUNTS_ALLOCATIONS
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void __libc_free(void* memory);

void* malloc(size_t size) {
  cairn::Count();
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  cairn::Count();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) {
  cairn::Count();
  return __libc_realloc(memory, size);
}
void* memalign(size_t alignment, size_t size) {
  cairn::Count();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  cairn::Count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, size_t alignment, size_t size) {
  cairn::Count();
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? 12 : 0;
}
void free(void* memory) { __libc_free(memory); }
}
#endif

namespace cairn {
namespace {

using test::Coloured;
using test::Frame;
using test::Scene;

class NoAlloc : public testing::Test {
 protected:
  void SetUp() override {
    if (CAIRN_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "nothing counts here";
  }
};

/// Allocations of a piece of code, on all threads.
template <class Function>
long AllocationsOf(const Function& function) {
  const long before = allocations.load();
  function();
  return allocations.load() - before;
}

/// Frames of one game, and what they are solved into.
struct Frames {
  std::vector<Frame> frames;
  std::vector<std::vector<double>> impulses;
  std::vector<Velocity> velocities;
  Report report;

  Frames(const Scene& whole, int count) : velocities(whole.bodies.size()) {
    test::Game game(whole);
    for (int i = 0; i < count; ++i) {
      // the contacts of a Game change every few frames
      for (int skipped = 0; skipped < 3; ++skipped) (void)game.Next();
      frames.push_back(game.Next());
      impulses.push_back(frames.back().start);
    }
  }

  /// So many frames, in turn.
  void Solve(Solver* solver, int count) {
    for (int i = 0; i < count; ++i) {
      const size_t k = static_cast<size_t>(i) % frames.size();
      solver->Solve(frames[k].scene.problem(), impulses[k], velocities, &report);
      if (!report.ok()) std::abort();
    }
  }
};

TEST_F(NoAlloc, SeesEveryKindOfAllocationOnEveryThread) {
  const auto touch = [](void* memory) { asm volatile("" : : "r"(memory) : "memory"); };
  EXPECT_EQ(AllocationsOf([] {}), 0);
  EXPECT_EQ(AllocationsOf([&] {
              const auto number = std::make_unique<int>(1);
              touch(number.get());
            }),
            1);
  EXPECT_EQ(AllocationsOf([&] {
              void* const memory = std::malloc(10);
              touch(memory);
              std::free(memory);
            }),
            1);
  EXPECT_EQ(AllocationsOf([&] {
              std::vector<simd::Line> lines(3);
              touch(lines.data());
            }),
            1)
      << "aligned";
  long seen = 0;
  std::thread([&] {
    seen = AllocationsOf([&] {
      const auto number = std::make_unique<int>(1);
      touch(number.get());
    });
  }).join();
  EXPECT_EQ(seen, 1);
}

void ExpectNoneAfterWarmUp(const Scene& whole, Settings settings) {
  settings.method = Method::kPgs;
  settings.max_sweeps = 1000;
  // where the clock decides, a machine that is busy may put off until later what allocates
  const int rounds = settings.budget.kind() == Budget::Kind::kTime ? 5 : 1;
  for (const int threads : {1, 2}) {
    settings.threads = threads;
    Frames frames(whole, 5);
    Solver solver(settings);
    frames.Solve(&solver, 3 * 5);
    long allocations = -1;
    for (int round = 0; round < rounds && allocations != 0; ++round)
      allocations = AllocationsOf([&] { frames.Solve(&solver, 50); });
    EXPECT_EQ(allocations, 0) << threads << " threads";
  }
}

TEST_F(NoAlloc, OfAFixedNumberOfSweeps) {
  ExpectNoneAfterWarmUp(test::Wall(5, 5), Coloured(20));
  ExpectNoneAfterWarmUp(test::Wall(18, 17), Coloured(20));
}

TEST_F(NoAlloc, InSubsteps) {
  Settings settings = Coloured(5);
  settings.substeps = 3;
  ExpectNoneAfterWarmUp(test::Wall(5, 5), settings);
  ExpectNoneAfterWarmUp(test::HangingChain(9, 4), settings);
}

TEST_F(NoAlloc, WithinATimeBudgetWhileContactsBeginAndEnd) {
  for (const int us : {100, 1000, 4000}) {
    Settings settings = Coloured(1000);
    settings.budget = Budget::Time(std::chrono::microseconds(us));
    ExpectNoneAfterWarmUp(test::Wall(5, 5), settings);
    ExpectNoneAfterWarmUp(test::Wall(18, 17), settings);
    settings.tolerance = 1e-3;
    ExpectNoneAfterWarmUp(test::Together({test::Wall(14, 15), test::Tower(5), test::Tower(9),
                                          test::HangingChain(9, 4), test::Plate(60)}),
                          settings);
  }
}

// The same rows: a first frame that is at rest from the start, and one that takes many sweeps.
TEST_F(NoAlloc, InAHardFrameAfterEasyOnesOfTheSameSize) {
  for (const int threads : {1, 2}) {
    const Scene hard = test::Together({test::Wall(18, 17), test::Tower(5), test::Tower(9)});
    Scene easy = hard;
    for (Body& body : easy.bodies) View(body.impulse).setZero();
    Settings settings = Coloured(100);
    settings.tolerance = 1e-3;
    settings.threads = threads;
    Solver solver(settings);
    std::vector<double> impulses(hard.rows.size());
    std::vector<Velocity> velocities(hard.bodies.size());
    Report report;
    for (int i = 0; i < 5; ++i) solver.Solve(easy.problem(), impulses, velocities, &report);
    ASSERT_EQ(report.sweeps, 1);
    EXPECT_EQ(AllocationsOf([&] { solver.Solve(hard.problem(), impulses, velocities, &report); }),
              0);
    ASSERT_GT(report.sweeps, 10);
  }
}

// A pair ends where another begins, round and round.
TEST_F(NoAlloc, InTheThirdRoundOfChangingContacts) {
  const Scene tower = test::Tower(40);
  Solver solver(Coloured(10));
  std::vector<double> impulses(tower.rows.size());
  std::vector<Velocity> velocities(tower.bodies.size());
  Report report;
  for (int round = 0; round < 3; ++round) {
    Scene scene = tower;
    for (int box = 1; box < 40; ++box) {
      for (int row = 12 * box; row < 12 * box + 12; ++row) {
        scene.rows[row].body_b = (box + 7) % 40;
      }
      const auto solve = [&] { solver.Solve(scene.problem(), impulses, velocities, &report); };
      const long allocated = AllocationsOf(solve);
      EXPECT_TRUE(report.ok());
      if (round == 2) {
        EXPECT_EQ(allocated, 0) << box;
      }
    }
  }
}

TEST_F(NoAlloc, WhileManifoldsBeginAndEnd) {
  const test::ManifoldScene whole = test::RollingManifolds(400, 1200, 1);
  for (const int threads : {1, 2}) {
    Settings settings = Coloured(10);
    settings.threads = threads;
    Solver solver(settings);
    test::ManifoldScene scene = whole;
    std::vector<Velocity> velocities(scene.bodies.size());
    Report report;
    for (int frame = 0; frame < 30; ++frame) {
      scene.manifolds = whole.manifolds;
      scene.manifolds.erase(scene.manifolds.begin() + frame % 10 * 100);
      const ContactProblem problem = scene.problem();
      const Impulses impulses = scene.impulses();
      const auto solve = [&] { solver.Solve(problem, impulses, velocities, &report); };
      const long allocated = AllocationsOf(solve);
      EXPECT_TRUE(report.ok());
      if (frame >= 20) {
        EXPECT_EQ(allocated, 0) << frame;
      }
    }
  }
}

}  // namespace
}  // namespace cairn
