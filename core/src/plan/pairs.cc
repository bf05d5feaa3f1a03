// SPDX-License-Identifier: MIT
#include "plan/pairs.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "problem/islands.h"

namespace cairn {
namespace {

constexpr int kMostShapes = 1024;

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

/// It may bound the friction of another row.
bool MayBound(const RowKind& parent, const RowKind& row) {
  const bool same =
      (parent.a == row.a && parent.b == row.b) || (parent.a == row.b && parent.b == row.a);
  return parent.parent == kNoRow && same;
}

}  // namespace

int ShapeTable::Intern(std::span<const simd::RowShape> rows, RowSource source) {
  // few shapes exist at a time, and neighbours mostly have the same: a search from the newest
  for (int shape = size() - 1; shape >= 0; --shape) {
    const auto known = this->rows(shape);
    if (sources_[shape] != source) continue;
    if (std::equal(known.begin(), known.end(), rows.begin(), rows.end())) return shape;
  }
  rows_.insert(rows_.end(), rows.begin(), rows.end());
  begin_.push_back(static_cast<int>(rows_.size()));
  sources_.push_back(source);
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
  sources_.clear();
}

namespace {

/// Shapes of the joints or manifolds of a list that came last: few kinds take turns.
template <class Source>
class RecentShapes {
 public:
  /// That of a source; make() if it is not known.
  template <class Make>
  int Of(const Source& source, const Make& make) {
    for (int i = 0; i < std::min(made_, kMost); ++i) {
      if (IsOfKindOf(source, *sources_[i])) return shapes_[i];
    }
    const int place = made_++ % kMost;
    sources_[place] = &source;
    return shapes_[place] = make();
  }

 private:
  static constexpr int kMost = 8;
  const Source* sources_[kMost];
  int shapes_[kMost];
  int made_ = 0;
};

simd::PairForm FormOf(const MovableBodies& movable, const Pair& pair) {
  if (pair.b == kWorld) return simd::PairForm::kSingle;
  const bool even = movable[pair.a] == kMovedEvenly && movable[pair.b] == kMovedEvenly;
  return even ? simd::PairForm::kContact : simd::PairForm::kJoint;
}

}  // namespace

Mobility MobilityOf(const Body& body) {
  if (!CanMove(body)) return kUnmoved;
  const bool even = body.inv_mass > 0 && body.linear_factor == Vector3(1, 1, 1);
  return even ? kMovedEvenly : kMoved;
}

int PairFinder::Look(int a, int b, bool contact) {
  const size_t mask = table_.size() - 1;
  for (size_t at = Hash(a, b, contact) & mask;; at = (at + 1) & mask) {
    if (table_[at] == 0) {
      list_->pairs.push_back(
          {a, b, 0, 0, 0, 0, simd::PairForm::kJoint, contact, 0, RowSource::kRows, 0});
      table_[at] = static_cast<int>(list_->pairs.size());
      return table_[at] - 1;
    }
    const Pair& known = list_->pairs[table_[at] - 1];
    if (Joins(known, a, b) && known.contact == contact) return table_[at] - 1;
  }
}

int PairFinder::PairOf(const RowKind& kind, size_t index) {
  if (kind.parent != kNoRow) return pair_of_row_[kind.parent];
  const auto moves = [this](int body) { return body != kWorld && (*movable_)[body] != kUnmoved; };
  int a = moves(kind.a) ? kind.a : kWorld, b = moves(kind.b) ? kind.b : kWorld;
  if (a == kWorld) std::swap(a, b);

  // the neighbour's: limits of a joint only push, too, and follow its other rows
  const bool contact = kind.shape.bound == simd::RowBound::kPush;
  if (index > 0) {
    const Pair& last = list_->pairs[pair_of_row_[index - 1]];
    if (Joins(last, a, b) && (!last.contact || contact)) return pair_of_row_[index - 1];
  }
  return Look(a, b, contact);
}

bool PairFinder::Find(std::span<const RowKind> kinds, const ContactProblem& problem,
                      const MovableBodies& movable, ShapeTable* shapes, PairList* list) {
  row_kinds_ = kinds;
  movable_ = &movable;
  list_ = list;
  list_->pairs.clear();
  pair_of_row_.resize(kinds.size());
  size_t capacity = 64;
  while (capacity < 2 * kinds.size()) capacity *= 2;
  table_.assign(capacity, 0);

  for (size_t i = 0; i < kinds.size(); ++i) {
    const RowKind& kind = kinds[i];
    if (kind.parent != kNoRow) {
      const bool earlier = kind.parent >= 0 && kind.parent < static_cast<int>(i);
      if (!earlier || !MayBound(kinds[kind.parent], kind)) return false;
    }
    const int index = pair_of_row_[i] = PairOf(kind, i);
    Pair& pair = list_->pairs[index];
    if (pair.rows++ == 0) {
      pair.row_a = kind.a;
      pair.row_b = kind.b;
      pair.form = FormOf(movable, pair);
    }
    if (pair.form == simd::PairForm::kContact && !kind.opposite) {
      pair.form = simd::PairForm::kJoint;
    }
  }
  HandOutRows();
  FindShapes(shapes);
  AddJoints(problem.joints, shapes);
  AddManifolds(problem.manifolds, shapes);
  return true;
}

int PairFinder::ShapeOf(const Joint& joint, ShapeTable* shapes) {
  scratch_.clear();
  for (int i = 0; i < joint.rows; ++i) {
    scratch_.push_back({.bound = joint.is_bounded(i) ? simd::RowBound::kOwn : simd::RowBound::kFree,
                        .soft = joint.soft,
                        .angular = joint.is_angular(i),
                        .max_sweeps = joint.host.max_sweeps});
  }
  return shapes->Intern(scratch_, RowSource::kJoint);
}

void PairFinder::AddJoints(std::span<const Joint> joints, ShapeTable* shapes) {
  RecentShapes<Joint> recent;
  for (size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    const int shape = recent.Of(joint, [&] { return ShapeOf(joint, shapes); });
    Add({.a = joint.body_a,
         .b = joint.body_b,
         .row_a = joint.body_a,
         .row_b = joint.body_b,
         .first = 0,
         .rows = joint.rows,
         .form = simd::PairForm::kJoint,
         .contact = false,
         .shape = shape,
         .source = RowSource::kJoint,
         .index = static_cast<int>(i)},
        joint.opposite);
  }
}

void PairFinder::Add(const Pair& added, bool opposite) {
  const auto moves = [this](int body) { return body != kWorld && (*movable_)[body] != kUnmoved; };
  Pair& pair = list_->pairs.emplace_back(added);
  if (!moves(pair.a)) pair.a = kWorld;
  if (!moves(pair.b)) pair.b = kWorld;
  if (pair.a == kWorld) std::swap(pair.a, pair.b);
  if (pair.b == kWorld || opposite) pair.form = FormOf(*movable_, pair);
}

int PairFinder::ShapeOf(const Manifold& manifold, ShapeTable* shapes) {
  scratch_.assign(manifold.points, {.bound = simd::RowBound::kPush,
                                    .soft = manifold.soft,
                                    .max_sweeps = manifold.host.max_sweeps});
  for (int p = 0; p < manifold.points; ++p) {
    scratch_.resize(scratch_.size() + manifold.tangents, {.bound = simd::RowBound::kFriction,
                                                          .parent = static_cast<std::int16_t>(p),
                                                          .max_sweeps = manifold.host.max_sweeps});
  }
  for (int p = 0; p < manifold.points && manifold.twists; ++p) {
    scratch_.resize(scratch_.size() + Manifold::kTwistRows,
                    {.bound = simd::RowBound::kCutFriction,
                     .angular = true,
                     .parent = static_cast<std::int16_t>(p),
                     .max_sweeps = manifold.host.max_sweeps});
  }
  return shapes->Intern(scratch_, RowSource::kManifold);
}

void PairFinder::AddManifolds(std::span<const Manifold> manifolds, ShapeTable* shapes) {
  RecentShapes<Manifold> recent;
  for (size_t i = 0; i < manifolds.size(); ++i) {
    const Manifold& manifold = manifolds[i];
    const int shape = recent.Of(manifold, [&] { return ShapeOf(manifold, shapes); });
    Add({.a = manifold.body_a,
         .b = manifold.body_b,
         .row_a = manifold.body_a,
         .row_b = manifold.body_b,
         .first = 0,
         .rows = manifold.rows(),
         .form = simd::PairForm::kJoint,
         .contact = true,
         .shape = shape,
         .source = RowSource::kManifold,
         .index = static_cast<int>(i)},
        true);
  }
}

void PairFinder::HandOutRows() {
  const size_t rows = pair_of_row_.size();
  int first = 0;
  for (Pair& pair : list_->pairs) {
    pair.first = first;
    first += std::exchange(pair.rows, 0);
  }
  list_->rows.resize(rows);
  place_.resize(rows);
  for (size_t i = 0; i < rows; ++i) {
    Pair& pair = list_->pairs[pair_of_row_[i]];
    place_[i] = pair.rows++;
    list_->rows[pair.first + place_[i]] = static_cast<int>(i);
  }
}

void PairFinder::FindShapes(ShapeTable* shapes) {
  // a caller that changes settings of single rows must not fill the memory with shapes
  if (shapes->size() > kMostShapes) shapes->Clear();

  for (Pair& pair : list_->pairs) {
    scratch_.clear();
    for (int row : list_->rows_of(pair)) {
      scratch_.push_back(row_kinds_[row].shape);
      const int parent = row_kinds_[row].parent;
      if (parent != kNoRow) scratch_.back().parent = static_cast<std::int16_t>(place_[parent]);
    }
    pair.shape = shapes->Intern(scratch_, RowSource::kRows);
  }
}

}  // namespace cairn
