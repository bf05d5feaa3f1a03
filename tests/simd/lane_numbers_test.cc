// SPDX-License-Identifier: MIT
// Passes over numbers of lanes against loops written out, on every target.
#include "simd/lane_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "pair_blocks.h"

namespace cairn::simd {
namespace {

using test::Random;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class Numbers>
float* At(std::vector<Numbers>* numbers, size_t i) {
  return reinterpret_cast<float*>(numbers->data()) + i;
}

/// Numbers of a state, its last one and the direction.
template <class Numbers>
struct State {
  std::vector<Numbers> now, last, direction;

  State(size_t count, Random* random) {
    for (auto* part : {&now, &last, &direction}) {
      part->resize(count);
      for (size_t i = 0; i < count * sizeof(Numbers) / sizeof(float); ++i) {
        *At(part, i) = static_cast<float>(random->Uniform(-1, 1));
      }
    }
  }
  Moving<Numbers> moving() { return {now.data(), last.data(), direction.data()}; }
  void Move(size_t i, const Momentum& momentum) {
    const float moved = *At(&now, i) + momentum.beta * *At(&direction, i);
    *At(&direction, i) = momentum.keep * (moved - *At(&last, i));
    *At(&now, i) = *At(&last, i) = moved;
  }
  void Copy(size_t i, State* to) {
    *At(&to->now, i) = *At(&now, i);
    *At(&to->last, i) = *At(&last, i);
    *At(&to->direction, i) = *At(&direction, i);
  }
  bool SameBits(const State& other) const {
    const auto same = [](const std::vector<Numbers>& a, const std::vector<Numbers>& b) {
      return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Numbers)) == 0;
    };
    return same(now, other.now) && same(last, other.last) && same(direction, other.direction);
  }
};

// The first momentum is of lanes and slots that belong to no island.
const std::vector<Momentum> kWays = {{0, 0}, {0.25f, 1}, {0.9f, 1}, {0, 0}, {0.5f, 1}};

TEST(LaneNumbers, MoveBlocksInTheWayOfEveryLane) {
  // rows and lanes of each; what lies between blocks is left alone
  constexpr std::pair<int, int> kBlocks[] = {{0, 16}, {1, 16}, {12, 16}, {12, 13},
                                             {12, 8}, {12, 5}, {12, 4},  {12, 1}};
  constexpr int kBetween = 1;
  std::vector<PairBlock> blocks;
  int lines = 0;
  for (const auto& [rows, lanes] : kBlocks) {
    PairBlock& block = blocks.emplace_back();
    block.x = static_cast<std::uint32_t>(lines);
    block.row_count = rows;
    block.lanes = lanes;
    lines += rows + kBetween;
  }
  const int count = static_cast<int>(blocks.size());
  for (const Target target : SupportedTargets()) {
    Random random(3);
    State<Line> state(static_cast<size_t>(lines), &random);
    State<Line> expected = state;
    std::vector<std::int32_t> of_lane(static_cast<size_t>(count * kLanes), -1);
    for (int b = 0; b < count; ++b) {
      const PairBlock& block = blocks[static_cast<size_t>(b)];
      const auto island = [&](int l) -> std::int32_t& {
        return of_lane[static_cast<size_t>(b * kLanes + l)];
      };
      for (int l = 0; l < block.lanes; ++l) island(l) = random.Index(4);
      const int first = static_cast<int>(block.x) * kLanes;
      for (int i = 0; i < block.row_count * kLanes; ++i) {
        if (i % kLanes >= block.lanes) continue;
        expected.Move(static_cast<size_t>(first + i),
                      kWays[static_cast<size_t>(island(i % kLanes) + 1)]);
      }
    }
    LaneKernelsFor(target).move_blocks(&kWays[1], blocks.data(), of_lane.data(), count,
                                       state.moving());
    for (int b = 0; b < count; ++b) {
      const PairBlock& block = blocks[static_cast<size_t>(b)];
      for (int i = 0; i < block.row_count * kLanes; ++i) {
        const size_t at = static_cast<size_t>(block.x) * kLanes + static_cast<size_t>(i);
        if (i % kLanes >= block.lanes) state.Copy(at, &expected);
      }
    }
    EXPECT_TRUE(state.SameBits(expected)) << TargetName(target);
  }
}

TEST(LaneNumbers, MoveBodiesOfEveryIslandInItsWay) {
  for (const Target target : SupportedTargets()) {
    for (const int count : {0, 1, 7, 30}) {
      Random random(4);
      State<BodyLane> state(static_cast<size_t>(count), &random);
      State<BodyLane> expected = state;
      std::vector<std::int32_t> of_body(static_cast<size_t>(count));
      for (std::int32_t& island : of_body) island = random.Index(5) - 1;
      for (int i = 0; i < 8 * count; ++i) {
        expected.Move(static_cast<size_t>(i),
                      kWays[static_cast<size_t>(of_body[static_cast<size_t>(i / 8)] + 1)]);
      }
      LaneKernelsFor(target).move_bodies(&kWays[1], of_body.data(), count, state.moving());
      EXPECT_TRUE(state.SameBits(expected)) << TargetName(target) << ", " << count << " bodies";
    }
  }
}

TEST(LaneNumbers, FindProgressOfTheBodiesThatAreNamedInTheirOrder) {
  Random random(6);
  State<BodyLane> state(30, &random);
  for (const std::vector<std::int32_t>& slots :
       {std::vector<std::int32_t>{}, {4}, {7, 3, 29}, {0, 2, 4, 6, 8, 10, 12, 14, 16}}) {
    double sums[8] = {};
    for (const std::int32_t slot : slots) {
      for (size_t k = 0; k < 8; ++k) {
        const size_t i = 8 * static_cast<size_t>(slot) + k;
        const float done = *At(&state.now, i) - *At(&state.last, i);
        sums[k] += static_cast<double>(done) * static_cast<double>(*At(&state.direction, i));
      }
    }
    const double expected =
        ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
    for (const Target target : SupportedTargets()) {
      EXPECT_EQ(expected, LaneKernelsFor(target).find_progress(
                              slots.data(), static_cast<int>(slots.size()), state.moving()))
          << TargetName(target) << ", " << slots.size() << " bodies";
    }
  }
}

/// Errors of blocks with 1 to 16 lanes in use, and something in the others that counts for nothing.
struct Errors {
  std::vector<PairBlock> blocks;
  std::vector<BlockError> errors;

  Errors(int count, float unused, unsigned seed = 5) : blocks(count), errors(count) {
    Random random(seed);
    for (size_t b = 0; b < blocks.size(); ++b) {
      blocks[b].lanes = 1 + random.Index(kLanes);
      for (int l = 0; l < kLanes; ++l) {
        for (Line* line : {&errors[b].max, &errors[b].max_angular, &errors[b].energy}) {
          const auto number = static_cast<float>(random.Uniform(0, 1));
          line->lane[l] = l < blocks[b].lanes ? number : unused;
        }
      }
    }
  }
  int count() const { return static_cast<int>(blocks.size()); }
};

TEST(LaneNumbers, FindTheLargestErrorOfEveryLane) {
  for (const Target target : SupportedTargets()) {
    for (const float unused : {0.0f, 7.0f, kNaN, kInfinity}) {
      Errors errors(9, unused);
      errors.blocks[2].lanes = kLanes;
      errors.errors[2].max.lane[3] = kNaN;  // passed over
      errors.errors[2].energy.lane[15] = kInfinity;
      BlockError expected = {}, largest = {};
      expected.max.lane[0] = largest.max.lane[0] = 2;  // of blocks before
      for (size_t b = 0; b < errors.blocks.size(); ++b) {
        for (int l = 0; l < errors.blocks[b].lanes; ++l) {
          const BlockError& error = errors.errors[b];
          const auto raise = [l](const Line& from, Line* to) {
            to->lane[l] = std::max(to->lane[l], from.lane[l]);
          };
          raise(error.max, &expected.max);
          raise(error.max_angular, &expected.max_angular);
          raise(error.energy, &expected.energy);
        }
      }
      LaneKernelsFor(target).find_largest(errors.blocks.data(), errors.errors.data(),
                                          errors.count(), &largest);
      EXPECT_EQ(std::memcmp(&largest, &expected, sizeof(largest)), 0)
          << TargetName(target) << ", " << unused << " in unused lanes";
    }
  }
}

// In whatever order lanes come, a sum of whole numbers is the same.
TEST(LaneNumbers, AddEnergiesAsWholeNumbers) {
  constexpr double kScale = 1 << 29;
  for (const Target target : SupportedTargets()) {
    const Errors errors(11, kNaN);
    double sums[kLanes] = {}, expected = 0;
    for (size_t b = 0; b < errors.blocks.size(); ++b) {
      for (int l = 0; l < errors.blocks[b].lanes; ++l) {
        expected += std::nearbyint(kScale * static_cast<double>(errors.errors[b].energy.lane[l]));
      }
    }
    LaneKernelsFor(target).add_energies(errors.blocks.data(), errors.errors.data(), errors.count(),
                                        kScale, sums);
    double sum = 0;
    for (int l = kLanes - 1; l >= 0; --l) sum += sums[l];
    EXPECT_EQ(sum, expected) << TargetName(target);
  }
}

TEST(LaneNumbers, RoundWhatIsNoNumberToItself) {
  EXPECT_EQ(Rounded(0), 0);
  EXPECT_EQ(Rounded(2.4), 2);
  EXPECT_EQ(Rounded(1e300), 1e300);
  EXPECT_TRUE(std::isinf(Rounded(static_cast<double>(kInfinity))));
  EXPECT_TRUE(std::isnan(Rounded(static_cast<double>(kNaN))));
}

}  // namespace
}  // namespace cairn::simd
