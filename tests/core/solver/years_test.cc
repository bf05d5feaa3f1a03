// SPDX-License-Identifier: MIT
// A long life of one solver. CAIRN_LIFE_FRAMES and CAIRN_LIFE_SEED ask for another length and
// another life than these; tests/long.sh does. A program of its own: it decides where all memory
// comes from.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>

#include "tests/core/solver/core_life.h"
#include "tests/core/support/recycling.h"

namespace cairn::test {
namespace {

constexpr int kFewFrames = 2400, kManyFrames = 50'000;
/// Time is looked at in so many frames together, the shortest of which counts.
constexpr int kWindow = 100;

int FromEnvironment(const char* name, int otherwise) {
  const char* const value = std::getenv(name);
  return value == nullptr ? otherwise : std::stoi(value);
}

int Frames() { return FromEnvironment("CAIRN_LIFE_FRAMES", kFewFrames); }

double Seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of one third of a life.
struct Third {
  size_t most_bytes = 0;
  double row_time = std::numeric_limits<double>::infinity();  ///< CPU time per row, at best [s]
};

struct Lived {
  Third thirds[3];
  std::uint64_t hash = 0;
  int failures = 0, most_rows = 0, sleepers = 0, reused_ids = 0;
};

Lived Live(Recycling recycling, int frames) {
  SetRecycling(recycling);
  Lived lived;
  Solver solver(Settings{.max_sweeps = 10, .threads = 2});
  CoreLife life(static_cast<std::uint64_t>(FromEnvironment("CAIRN_LIFE_SEED", 1)), &solver);
  double begin = Seconds();
  std::size_t rows = 0;
  for (int frame = 0; frame < frames; ++frame) {
    life.Frame();
    rows += life.rows();
    Third& third = lived.thirds[std::min(2, 3 * frame / frames)];
    // what is given back late makes long lists, and all of them are gone through to count it
    if (recycling == Recycling::kByTheSystem) {
      third.most_bytes = std::max(third.most_bytes, BytesInUse());
    }
    if (frame % kWindow != kWindow - 1) continue;
    const double end = Seconds();
    if (rows > 0)
      third.row_time = std::min(third.row_time, (end - begin) / static_cast<double>(rows));
    begin = end;
    rows = 0;
  }
  lived.hash = life.hash();
  lived.failures = life.failures();
  lived.most_rows = life.most_rows();
  lived.sleepers = life.sleepers();
  lived.reused_ids = life.reused_ids();
  return lived;
}

TEST(Years, NeedTheSameMemoryAndTimePerRowToTheEnd) {
  const Lived lived = Live(Recycling::kByTheSystem, Frames());
  EXPECT_EQ(lived.failures, 0);
  // everything that the life is for did happen
  EXPECT_GT(lived.most_rows, 4096) << "rows that are worth threads";
  EXPECT_GT(lived.sleepers, Frames() / 50);
  EXPECT_GT(lived.reused_ids, Frames() / 50);
  const auto& [first, second, last] = lived.thirds;
  // what is remembered is bounded by the largest world, which comes again each 1,200 frames
  const size_t before = std::max(first.most_bytes, second.most_bytes);
  EXPECT_LT(last.most_bytes, before * 21 / 20 + 65536);
  // worlds differ from one window of frames to the next, and few of them do not tell; what grows
  // with time would not stop there
  const double most = Frames() < kManyFrames ? 5 : 1.5;
  EXPECT_LT(last.row_time, most * std::min(first.row_time, second.row_time));
  RecordProperty("bytes", std::to_string(last.most_bytes));
  RecordProperty("row_ns_first", std::to_string(1e9 * first.row_time));
  RecordProperty("row_ns_last", std::to_string(1e9 * last.row_time));
}

TEST(Years, DoNotDependOnAddresses) {
  const int frames = Frames();
  const std::uint64_t expected = Live(Recycling::kByTheSystem, frames).hash;
  EXPECT_EQ(Live(Recycling::kAtOnce, frames).hash, expected);
  EXPECT_EQ(Live(Recycling::kLate, frames).hash, expected);
}

}  // namespace
}  // namespace cairn::test
