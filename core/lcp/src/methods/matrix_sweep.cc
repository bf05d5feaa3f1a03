// SPDX-License-Identifier: MIT
#include "methods/matrix_sweep.h"

#include <algorithm>
#include <numeric>

namespace cairn::lcp {
namespace {

/// Rows of a colour that a thread takes at a time: some microseconds of work.
constexpr int kBlockRows = 1024;

/// sum of the off-diagonal entries of the k-th row times x. They are read in the order in which
/// they are stored, or backwards: the last one read is the one that the sweep changed last.
template <Direction kDirection>
double OffDiagonal(const SweepRows& rows, int k, const double* x) {
  constexpr bool kForward = kDirection == Direction::kForward;
  constexpr int kStep = kForward ? 1 : -1;
  const int length = rows.begin[k + 1] - rows.begin[k];
  const int first = kForward ? rows.begin[k] : rows.begin[k + 1] - 1;
  const int* const column = rows.columns.data() + first;
  const double* const value = rows.values.data() + first;

  // four sums hide the latency of the additions in long rows
  double sum[4] = {0, 0, 0, 0};
  int e = 0;
  for (; e + 4 <= length; e += 4) {
    for (int l = 0; l < 4; ++l) sum[l] += value[kStep * (e + l)] * x[column[kStep * (e + l)]];
  }
  double rest = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  for (; e < length; ++e) rest += value[kStep * e] * x[column[kStep * e]];
  return rest;
}

/// Relaxes the k-th row. Returns d (change of x)^2.
template <Direction kDirection, bool kPlain>
inline double Relax(const SweepRows& rows, int k, double omega, double* x) {
  double& x_k = x[rows.row[k]];
  const double old = x_k;
  const double rest = OffDiagonal<kDirection>(rows, k, x) + rows.q[k];
  const double goal = kPlain ? -rest : (1 - omega) * old - omega * rest;
  x_k = std::min(std::max(goal, rows.lo[k]), rows.hi[k]);
  return rows.diagonal[k] * (x_k - old) * (x_k - old);
}

/// Relaxes rows begin to end - 1, or the other way round. Returns the sum of what they moved.
template <Direction kDirection, bool kPlain>
double SweepRange(const SweepRows& rows, int begin, int end, double omega, double* x) {
  double moved = 0;
  for (int k = 0; k < end - begin; ++k) {
    const int place = kDirection == Direction::kForward ? begin + k : end - 1 - k;
    moved += Relax<kDirection, kPlain>(rows, place, omega, x);
  }
  return moved;
}

/// Positions of the rows in the order of a sweep.
std::vector<int> SweepOrderOf(const std::vector<int>& colour_of, int n) {
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  if (!colour_of.empty()) {
    std::stable_sort(order.begin(), order.end(),
                     [&colour_of](int i, int j) { return colour_of[i] < colour_of[j]; });
  }
  return order;
}

int BlocksOf(int rows) { return (rows + kBlockRows - 1) / kBlockRows; }

}  // namespace

std::vector<int> ColourRows(const Eigen::SparseMatrix<double>& m, int most) {
  std::vector<int> colour_of(m.cols(), -1);
  std::vector<int> taken_by(most, -1);
  for (int i = 0; i < m.cols(); ++i) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(m, i); entry && entry.row() < i;
         ++entry) {
      taken_by[colour_of[entry.row()]] = i;
    }
    int colour = 0;
    while (colour < most && taken_by[colour] == i) ++colour;
    if (colour == most) return {};
    colour_of[i] = colour;
  }
  return colour_of;
}

SweepRows LayOut(const BoxedLcp& problem, const std::vector<int>& colour_of) {
  const int n = static_cast<int>(problem.size());
  SweepRows rows;
  rows.row = SweepOrderOf(colour_of, n);
  rows.begin.reserve(n + 1);
  rows.columns.reserve(problem.M.nonZeros());
  rows.values.reserve(problem.M.nonZeros());
  rows.begin.push_back(0);
  for (std::vector<double>* values : {&rows.diagonal, &rows.q, &rows.lo, &rows.hi}) {
    values->reserve(n);
  }

  const Eigen::VectorXd diagonal = problem.M.diagonal();

  // M is symmetric: its columns are its rows
  using Entry = Eigen::SparseMatrix<double>::InnerIterator;
  for (const int i : rows.row) {
    const double d = diagonal[i];
    const auto append = [&rows, d](const Entry& entry) {
      rows.columns.push_back(static_cast<int>(entry.row()));
      rows.values.push_back(entry.value() / d);
    };
    for (Entry entry(problem.M, i); entry; ++entry) {
      if (entry.row() > i) append(entry);
    }
    for (Entry entry(problem.M, i); entry && entry.row() < i; ++entry) append(entry);
    rows.begin.push_back(static_cast<int>(rows.columns.size()));
    rows.diagonal.push_back(d);
    rows.q.push_back(problem.q[i] / d);
    rows.lo.push_back(problem.lo[i]);
    rows.hi.push_back(problem.hi[i]);
  }
  for (int k = 0; k < n && !colour_of.empty(); ++k) {
    const bool next = k == 0 || colour_of[rows.row[k]] != colour_of[rows.row[k - 1]];
    if (next) rows.colours.push_back(k);
  }
  if (!colour_of.empty()) rows.colours.push_back(n);
  return rows;
}

double Sweep(const SweepRows& rows, double omega, Direction direction, double* x) {
  const bool forward = direction == Direction::kForward;
  const int end = rows.size();
  if (omega == 1) {
    return forward ? SweepRange<Direction::kForward, true>(rows, 0, end, omega, x)
                   : SweepRange<Direction::kReverse, true>(rows, 0, end, omega, x);
  }
  return forward ? SweepRange<Direction::kForward, false>(rows, 0, end, omega, x)
                 : SweepRange<Direction::kReverse, false>(rows, 0, end, omega, x);
}

namespace {

/// A sweep by colours; a block of a colour is relaxed and summed by one thread.
class ColourSweep final : public StagedWork {
 public:
  ColourSweep(const SweepRows& rows, double omega, double* x)
      : rows_(rows), omega_(omega), x_(x), first_block_{0} {
    for (int c = 0; c < stages(); ++c) first_block_.push_back(first_block_.back() + units(c));
    moved_.resize(first_block_.back());
  }

  int stages() const override { return static_cast<int>(rows_.colours.size()) - 1; }
  int units(int colour) const override {
    return BlocksOf(rows_.colours[colour + 1] - rows_.colours[colour]);
  }
  void Do(int colour, int block) override {
    const int begin = rows_.colours[colour] + block * kBlockRows;
    const int end = std::min(begin + kBlockRows, rows_.colours[colour + 1]);
    moved_[first_block_[colour] + block] =
        omega_ == 1 ? SweepRange<Direction::kForward, true>(rows_, begin, end, omega_, x_)
                    : SweepRange<Direction::kForward, false>(rows_, begin, end, omega_, x_);
  }

  /// Of all blocks, in their order.
  double moved() const { return std::accumulate(moved_.begin(), moved_.end(), 0.0); }

 private:
  const SweepRows& rows_;
  const double omega_;
  double* const x_;
  std::vector<int> first_block_;
  std::vector<double> moved_;
};

}  // namespace

double SweepColours(const SweepRows& rows, double omega, Crew* crew, double* x) {
  ColourSweep sweep(rows, omega, x);
  crew->Run(&sweep);
  return sweep.moved();
}

}  // namespace cairn::lcp
