// SPDX-License-Identifier: MIT
// Passes over numbers of lanes that relax nothing. Compiled once per target.
#if defined(CAIRN_SIMD_LANE_NUMBERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_LANE_NUMBERS_INL_H_
#undef CAIRN_SIMD_LANE_NUMBERS_INL_H_
#else
#define CAIRN_SIMD_LANE_NUMBERS_INL_H_
#endif

#include <hwy/highway.h>

#include "simd/flush_denormals.h"
#include "simd/lane_numbers.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace numbers {
namespace hn = hwy::HWY_NAMESPACE;

template <int most, class V>
HWY_INLINE void Move(hn::CappedTag<float, most> d, V beta, V keep, float* now, float* last,
                     float* direction) {
  const V along = hn::Load(d, direction);
  const V moved = hn::Add(hn::Load(d, now), hn::Mul(beta, along));
  hn::Store(hn::Mul(keep, hn::Sub(moved, hn::Load(d, last))), d, direction);
  hn::Store(moved, d, now);
  hn::Store(moved, d, last);
}

/// In registers of @p most lanes at most.
template <int most>
HWY_INLINE void MoveLanes(const Momentum* momenta, const std::int32_t* of_lane, int lanes,
                          int count, const Moving<Line>& numbers) {
  const hn::CappedTag<float, most> d;
  const hn::RebindToSigned<decltype(d)> d_index;
  constexpr int kWidth = static_cast<int>(hn::MaxLanes(d));
  for (int l = 0; l < lanes; l += kWidth) {
    auto beta = hn::Set(d, momenta[of_lane[l]].beta), keep = hn::Set(d, momenta[of_lane[l]].keep);
    // mostly all are of one island, and where they are not one by one is faster than gathering
    const auto used = hn::FirstN(d_index, static_cast<std::size_t>(lanes - l));
    const auto first = hn::Set(d_index, of_lane[l]);
    if (!hn::AllFalse(d_index, hn::And(used, hn::Ne(hn::LoadU(d_index, of_lane + l), first)))) {
      HWY_ALIGN float betas[kWidth] = {}, keeps[kWidth] = {};
      for (int k = 0; k < kWidth && l + k < lanes; ++k) {
        betas[k] = momenta[of_lane[l + k]].beta;
        keeps[k] = momenta[of_lane[l + k]].keep;
      }
      beta = hn::Load(d, betas);
      keep = hn::Load(d, keeps);
    }
    for (int i = 0; i < count; ++i) {
      Move<most>(d, beta, keep, numbers.now[i].lane + l, numbers.last[i].lane + l,
                 numbers.direction[i].lane + l);
    }
  }
}

inline void MoveBlocks(const Momentum* momenta, const PairBlock* blocks,
                       const std::int32_t* of_lane, int count, const Moving<Line>& numbers) {
  const FlushDenormals flush;
  for (int b = 0; b < count; ++b, of_lane += kLanes) {
    const int lanes = blocks[b].lanes, rows = blocks[b].row_count;
    const Moving<Line> of_block{numbers.now + blocks[b].x, numbers.last + blocks[b].x,
                                numbers.direction + blocks[b].x};
    if (lanes <= 4) {
      MoveLanes<4>(momenta, of_lane, lanes, rows, of_block);
    } else {
      MoveLanes<kLanes>(momenta, of_lane, lanes, rows, of_block);
    }
  }
}

inline void MoveBodies(const Momentum* momenta, const std::int32_t* of_body, int count,
                       const Moving<BodyLane>& numbers) {
  constexpr int kNumbers = 8;
  const FlushDenormals flush;
  const hn::CappedTag<float, kNumbers> d;
  for (int i = 0; i < count; ++i) {
    const Momentum& momentum = momenta[of_body[i]];
    const auto beta = hn::Set(d, momentum.beta), keep = hn::Set(d, momentum.keep);
    for (int k = 0; k < kNumbers; k += static_cast<int>(hn::MaxLanes(d))) {
      Move<kNumbers>(d, beta, keep, numbers.now[i].u + k, numbers.last[i].u + k,
                     numbers.direction[i].u + k);
    }
  }
}

/// In an order that suits any width of registers.
HWY_INLINE double SumOfEight(const double* numbers) {
  return ((numbers[0] + numbers[4]) + (numbers[2] + numbers[6])) +
         ((numbers[1] + numbers[5]) + (numbers[3] + numbers[7]));
}

/// Plain loops, which the compiler turns into vectors.
inline double FindProgress(const std::int32_t* slots, int count, const Moving<BodyLane>& numbers) {
  const FlushDenormals flush;
  double sums[8] = {};
  for (int i = 0; i < count; ++i) {
    const float* const now = numbers.now[slots[i]].u;
    const float* const last = numbers.last[slots[i]].u;
    const float* const direction = numbers.direction[slots[i]].u;
    for (int k = 0; k < 8; ++k) {
      sums[k] += static_cast<double>(now[k] - last[k]) * static_cast<double>(direction[k]);
    }
  }
  return SumOfEight(sums);
}

inline void FindLargest(const PairBlock* blocks, const BlockError* errors, int count,
                        BlockError* largest) {
  const hn::CappedTag<float, kLanes> d;
  for (int l = 0; l < kLanes; l += static_cast<int>(hn::MaxLanes(d))) {
    auto max = hn::Load(d, largest->max.lane + l);
    auto angular = hn::Load(d, largest->max_angular.lane + l);
    auto energy = hn::Load(d, largest->energy.lane + l);
    for (int b = 0; b < count; ++b) {
      const auto used =
          hn::FirstN(d, static_cast<size_t>(blocks[b].lanes > l ? blocks[b].lanes - l : 0));
      // comparisons with what is not a number are false
      const auto raise = [&](const Line& line, auto* to) HWY_ATTR {
        const auto number = hn::Load(d, line.lane + l);
        *to = hn::IfThenElse(hn::And(used, hn::Lt(*to, number)), number, *to);
      };
      raise(errors[b].max, &max);
      raise(errors[b].max_angular, &angular);
      raise(errors[b].energy, &energy);
    }
    hn::Store(max, d, largest->max.lane + l);
    hn::Store(angular, d, largest->max_angular.lane + l);
    hn::Store(energy, d, largest->energy.lane + l);
  }
}

/// A plain loop, which the compiler turns into vectors.
inline void AddEnergies(const PairBlock* blocks, const BlockError* errors, int count, double scale,
                        double* sums) {
  double all[kLanes];
  for (int l = 0; l < kLanes; ++l) all[l] = sums[l];
  for (int b = 0; b < count; ++b) {
    for (int l = 0; l < kLanes; ++l) {
      const float energy = l < blocks[b].lanes ? errors[b].energy.lane[l] : 0;
      all[l] += Rounded(static_cast<double>(energy) * scale);
    }
  }
  for (int l = 0; l < kLanes; ++l) sums[l] = all[l];
}

/// Of the first @p lanes lanes.
template <int lanes>
HWY_INLINE RowsOfBlock FindGainsOf(const PairBlock& block, const Line* lines, const Line* x,
                                   double* gain, double* square) {
  double gains[lanes] = {}, squares[lanes] = {};
  RowsOfBlock some;
  const Line* row = lines + PairLines(block.form);
  for (int i = 0; i < block.row_count; ++i) {
    const Line& target = row[JacobianLines(block.form)];
    for (int l = 0; l < lanes; ++l) {
      gains[l] += static_cast<double>(target.lane[l]) * static_cast<double>(x[i].lane[l]);
    }
    some.bounded = some.bounded || block.rows[i].bound == RowBound::kOwn;
    if (block.rows[i].soft) {
      some.soft = true;
      const Line& compliance = row[JacobianLines(block.form) + 2];
      for (int l = 0; l < lanes; ++l) {
        const double impulse = static_cast<double>(x[i].lane[l]);
        squares[l] += static_cast<double>(compliance.lane[l]) * impulse * impulse;
      }
    }
    row += RowLines(block.form, block.rows[i]);
  }
  for (int l = 0; l < kLanes; ++l) gain[l] = l < lanes && l < block.lanes ? gains[l] : 0;
  for (int l = 0; l < kLanes; ++l) square[l] = l < lanes && l < block.lanes ? squares[l] : 0;
  return some;
}

inline RowsOfBlock FindGains(const PairBlock& block, const Line* lines, const Line* x, double* gain,
                             double* square) {
  if (block.lanes <= 4) return FindGainsOf<4>(block, lines, x, gain, square);
  if (block.lanes <= 8) return FindGainsOf<8>(block, lines, x, gain, square);
  return FindGainsOf<kLanes>(block, lines, x, gain, square);
}

inline void FindSquares(const BodyLane* bodies, int count, double* squares) {
  for (int i = 0; i < count; ++i) {
    double products[8];
    for (int k = 0; k < 8; ++k) {
      products[k] = static_cast<double>(bodies[i].u[k]) * static_cast<double>(bodies[i].u[k]);
    }
    squares[i] = SumOfEight(products);
  }
}

/// Sums and maxima in eight places, the same on every target.
constexpr int kPlaces = 8;

inline double FindMost(const double* numbers, int count) {
  const hn::CappedTag<double, kPlaces> d;
  constexpr int kWidth = static_cast<int>(hn::MaxLanes(d));
  const auto larger = [](auto most, auto size)
                          HWY_ATTR { return hn::IfThenElse(hn::Lt(most, size), size, most); };
  auto most = hn::Zero(d);
  int i = 0;
  for (; i + kWidth <= count; i += kWidth) most = larger(most, hn::Abs(hn::LoadU(d, numbers + i)));
  double all = hn::GetLane(hn::MaxOfLanes(d, most));
  for (; i < count; ++i) {
    const double size = numbers[i] < 0 ? -numbers[i] : numbers[i];
    all = all < size ? size : all;
  }
  return all;
}

inline double AddRounded(const double* numbers, int count, double scale) {
  // whole numbers, so that their order does not matter
  double sums[kPlaces] = {};
  int i = 0;
  for (; i + kPlaces <= count; i += kPlaces) {
    for (int k = 0; k < kPlaces; ++k) sums[k] += Rounded(numbers[i + k] * scale);
  }
  for (int k = 0; i < count; ++i, ++k) sums[k] += Rounded(numbers[i] * scale);
  double all = 0;
  for (const double sum : sums) all += sum;
  return all;
}

constexpr LaneKernels kKernels = {MoveBlocks, MoveBodies,  FindProgress, FindLargest, AddEnergies,
                                  FindGains,  FindSquares, FindMost,     AddRounded};

}  // namespace numbers
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
