// SPDX-License-Identifier: MIT
#include "pairs.h"

#include <algorithm>
#include <utility>

#include "islands.h"
#include "validate.h"

namespace cairn {
namespace {

/// The same for (a, b) and (b, a).
std::uint64_t Hash(int a, int b, bool contact) {
  const std::uint64_t low = static_cast<std::uint32_t>(std::min(a, b));
  const std::uint64_t high = static_cast<std::uint32_t>(std::max(a, b));
  const std::uint64_t mixed = (high << 32 | low) * 0x9e3779b97f4a7c15u;
  return (mixed >> 32) + (contact ? 1 : 0);
}

bool Joins(const Pair& pair, int a, int b) {
  return (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a);
}

simd::RowBound BoundOf(const Row& row) {
  const bool below = row.lo > -kInfinity, above = row.hi < kInfinity;
  if (row.parent != kNoRow) {
    return below || above ? simd::RowBound::kCutFriction : simd::RowBound::kFriction;
  }
  if (!below && !above) return simd::RowBound::kFree;
  return row.lo == 0 && !above ? simd::RowBound::kPush : simd::RowBound::kOwn;
}

bool IsAngular(const Row& row) {
  const auto zero = [](const Eigen::Vector3d& v) { return v.x() == 0 && v.y() == 0 && v.z() == 0; };
  return zero(row.linear_a) && zero(row.linear_b);
}

}  // namespace

int ShapeTable::Intern(std::span<const simd::RowShape> rows) {
  // few shapes exist at a time, and neighbours mostly have the same: a search from the newest
  for (int shape = size() - 1; shape >= 0; --shape) {
    const auto known = this->rows(shape);
    if (std::equal(known.begin(), known.end(), rows.begin(), rows.end())) return shape;
  }
  rows_.insert(rows_.end(), rows.begin(), rows.end());
  begin_.push_back(static_cast<int>(rows_.size()));
  return size() - 1;
}

std::span<const simd::RowShape> ShapeTable::rows(int shape) const {
  return {rows_.data() + begin_[shape], rows_.data() + begin_[shape + 1]};
}

int ShapeTable::lines(simd::PairForm form, int shape) const {
  int lines = 0;
  for (const simd::RowShape& row : rows(shape)) lines += simd::RowLines(form, row);
  return lines;
}

void ShapeTable::Clear() {
  rows_.clear();
  begin_.resize(1);
}

bool HasShape(const Row& row, double omega, const simd::RowShape& shape) {
  return BoundOf(row) == shape.bound && (row.compliance > 0) == shape.soft &&
         (omega * row.relaxation != 1) == shape.relaxed && IsAngular(row) == shape.angular &&
         row.max_sweeps == shape.max_sweeps;
}

simd::RowShape ShapeOf(const Row& row, double omega) {
  return {.bound = BoundOf(row),
          .soft = row.compliance > 0,
          .relaxed = omega * row.relaxation != 1,
          .angular = IsAngular(row),
          .parent = -1,
          .max_sweeps = row.max_sweeps};
}

namespace {

simd::PairForm FormOf(const MovableBodies& movable, const Pair& pair) {
  if (pair.b == kWorld) return simd::PairForm::kSingle;
  const bool even = movable[pair.a] == kMovedEvenly && movable[pair.b] == kMovedEvenly;
  return even ? simd::PairForm::kContact : simd::PairForm::kJoint;
}

}  // namespace

Mobility MobilityOf(const Body& body) {
  if (!CanMove(body)) return kUnmoved;
  const bool even = body.inv_mass > 0 && body.linear_factor == Eigen::Vector3d::Ones();
  return even ? kMovedEvenly : kMoved;
}

int PairFinder::Look(int a, int b, bool contact) {
  const size_t mask = table_.size() - 1;
  for (size_t at = Hash(a, b, contact) & mask;; at = (at + 1) & mask) {
    if (table_[at] == 0) {
      list_.pairs.push_back({a, b, 0, 0, 0, 0, simd::PairForm::kJoint, contact, 0});
      table_[at] = static_cast<int>(list_.pairs.size());
      return table_[at] - 1;
    }
    const Pair& known = list_.pairs[table_[at] - 1];
    if (Joins(known, a, b) && known.contact == contact) return table_[at] - 1;
  }
}

int PairFinder::PairOf(const Row& row, int index) {
  if (row.parent != kNoRow) return pair_of_row_[row.parent];
  const auto moves = [this](int body) { return body != kWorld && (*movable_)[body] != kUnmoved; };
  int a = moves(row.body_a) ? row.body_a : kWorld, b = moves(row.body_b) ? row.body_b : kWorld;
  if (a == kWorld) std::swap(a, b);

  // the neighbour's: limits of a joint only push, too, and follow its other rows
  const bool contact = BoundOf(row) == simd::RowBound::kPush;
  if (index > 0) {
    const Pair& last = list_.pairs[pair_of_row_[index - 1]];
    if (Joins(last, a, b) && (!last.contact || contact)) return pair_of_row_[index - 1];
  }
  return Look(a, b, contact);
}

bool PairFinder::Find(const ContactProblem& problem, std::span<const double> impulses,
                      const MovableBodies& movable, double omega, ShapeTable* shapes) {
  movable_ = &movable;
  list_.pairs.clear();
  const size_t rows = problem.rows.size();
  pair_of_row_.resize(rows);
  size_t capacity = 64;
  while (capacity < 2 * rows) capacity *= 2;
  table_.assign(capacity, 0);

  // all that is wanted of a row, in one look at it: rows are large
  row_shapes_.resize(rows);
  parent_.resize(rows);
  for (size_t i = 0; i < rows; ++i) {
    if (ValidateRow(problem, static_cast<int>(i), impulses[i]) != Status::kOk) return false;
    const Row& row = problem.rows[i];
    const int index = pair_of_row_[i] = PairOf(row, static_cast<int>(i));
    Pair& pair = list_.pairs[index];
    if (pair.rows++ == 0) {
      pair.row_a = row.body_a;
      pair.row_b = row.body_b;
      pair.form = FormOf(movable, pair);
    }
    if (pair.form == simd::PairForm::kContact && !ActsOpposite(row)) {
      pair.form = simd::PairForm::kJoint;
    }
    row_shapes_[i] = ShapeOf(row, omega);
    parent_[i] = row.parent;
  }
  HandOutRows();
  FindShapes(shapes);
  return true;
}

void PairFinder::HandOutRows() {
  const size_t rows = pair_of_row_.size();
  int first = 0;
  for (Pair& pair : list_.pairs) {
    pair.first = first;
    first += std::exchange(pair.rows, 0);
  }
  list_.rows.resize(rows);
  place_.resize(rows);
  for (size_t i = 0; i < rows; ++i) {
    Pair& pair = list_.pairs[pair_of_row_[i]];
    place_[i] = pair.rows++;
    list_.rows[pair.first + place_[i]] = static_cast<int>(i);
  }
}

void PairFinder::FindShapes(ShapeTable* shapes) {
  // a caller that changes settings of single rows must not fill the memory with shapes
  constexpr int kMostShapes = 1024;
  if (shapes->size() > kMostShapes) shapes->Clear();

  for (Pair& pair : list_.pairs) {
    scratch_.clear();
    for (int row : list_.rows_of(pair)) {
      scratch_.push_back(row_shapes_[row]);
      const int parent = parent_[row];
      if (parent != kNoRow) scratch_.back().parent = static_cast<std::int16_t>(place_[parent]);
    }
    pair.shape = shapes->Intern(scratch_);
  }
}

}  // namespace cairn
