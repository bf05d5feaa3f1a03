// SPDX-License-Identifier: MIT
#include "plan/pairs.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

#include "problem/islands.h"
#include "runtime/in_parts.h"

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

int ShapeTable::Find(std::span<const simd::RowShape> rows, RowSource source) const {
  // few shapes exist at a time, and neighbours mostly have the same: a search from the newest
  for (int shape = size() - 1; shape >= 0; --shape) {
    const auto known = this->rows(shape);
    if (sources_[shape] != source) continue;
    if (std::equal(known.begin(), known.end(), rows.begin(), rows.end())) return shape;
  }
  return -1;
}

int ShapeTable::Intern(std::span<const simd::RowShape> rows, RowSource source) {
  const int known = Find(rows, source);
  if (known >= 0) return known;
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
                      const MovableBodies& movable, Crew* crew, ShapeTable* shapes,
                      PairList* list) {
  row_kinds_ = kinds;
  movable_ = &movable;
  list_ = list;
  list_->rows.clear();
  // a caller that changes settings of single rows must not fill the memory with shapes
  if (shapes->size() > kMostShapes) shapes->Clear();
  size_t first = 0;
  if (!kinds.empty()) {
    list_->pairs.clear();
    if (!AddRows(kinds)) return false;
    HandOutRows();
    FindShapes(shapes);
    first = list_->pairs.size();
  }
  // those of the last call are written over
  list_->pairs.resize(first + problem.joints.size() + problem.manifolds.size());
  AddAll(problem.joints, first, crew, shapes);
  AddAll(problem.manifolds, first + problem.joints.size(), crew, shapes);
  return true;
}

bool PairFinder::AddRows(std::span<const RowKind> kinds) {
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
      pair.form = FormOf(*movable_, pair);
    }
    if (pair.form == simd::PairForm::kContact && !kind.opposite) {
      pair.form = simd::PairForm::kJoint;
    }
  }
  return true;
}

namespace {

/// Joints and manifolds of which one thread makes pairs at a time.
constexpr int kSourcesOfPart = 512;

constexpr int kMostRowsOfPair =
    std::max<int>(Joint::kMostRows, Manifold::kMostPoints*(1 + 2 + Manifold::kTwistRows));

/// add(shape) for each row.
template <class Add>
void ListShapes(const Joint& joint, const Add& add) {
  for (int i = 0; i < joint.rows; ++i) {
    add({.bound = joint.is_bounded(i) ? simd::RowBound::kOwn : simd::RowBound::kFree,
         .soft = joint.soft,
         .angular = joint.is_angular(i),
         .max_sweeps = joint.host.max_sweeps});
  }
}
template <class Add>
void ListShapes(const Manifold& manifold, const Add& add) {
  const auto add_all = [&](int of_point, simd::RowShape shape) {
    shape.max_sweeps = manifold.host.max_sweeps;
    for (int p = 0; p < manifold.points; ++p) {
      if (shape.bound != simd::RowBound::kPush) shape.parent = static_cast<std::int16_t>(p);
      for (int k = 0; k < of_point; ++k) add(shape);
    }
  };
  add_all(1, {.bound = simd::RowBound::kPush, .soft = manifold.soft});
  add_all(manifold.tangents, {.bound = simd::RowBound::kFriction});
  const int twists = manifold.twists ? Manifold::kTwistRows : 0;
  add_all(twists, {.bound = simd::RowBound::kCutFriction, .angular = true});
}

constexpr RowSource SourceOf(const Joint&) { return RowSource::kJoint; }
constexpr RowSource SourceOf(const Manifold&) { return RowSource::kManifold; }
int RowsOf(const Joint& joint) { return joint.rows; }
int RowsOf(const Manifold& manifold) { return manifold.rows(); }
bool PushesOppositely(const Joint& joint) { return joint.opposite; }
bool PushesOppositely(const Manifold&) { return true; }

}  // namespace

template <class Source>
void PairFinder::AddAll(std::span<const Source> sources, size_t first, Crew* crew,
                        ShapeTable* shapes) {
  const auto add = [&](int from, int count, const auto& shape_of) {
    RecentShapes<Source> recent;
    for (int i = from; i < from + count; ++i) {
      const Source& source = sources[i];
      const int shape = recent.Of(source, [&] { return shape_of(source); });
      Put({.a = source.body_a,
           .b = source.body_b,
           .row_a = source.body_a,
           .row_b = source.body_b,
           .first = 0,
           .rows = RowsOf(source),
           .form = simd::PairForm::kJoint,
           .contact = SourceOf(source) == RowSource::kManifold,
           .shape = shape,
           .source = SourceOf(source),
           .index = i},
          PushesOppositely(source), first + i);
    }
  };
  const int count = static_cast<int>(sources.size());
  if (count > kSourcesOfPart) {
    // shapes that are new get their numbers in the order of the list
    std::atomic<bool> all_known{true};
    const auto find = [&](const Source& source) {
      std::array<simd::RowShape, kMostRowsOfPair> rows;
      size_t listed = 0;
      ListShapes(source, [&](const simd::RowShape& row) { rows[listed++] = row; });
      const int shape = shapes->Find(std::span(rows).first(listed), SourceOf(source));
      if (shape < 0) all_known.store(false, std::memory_order_relaxed);
      return shape;
    };
    InParts(count, kSourcesOfPart, crew, [&](int from, int of_part) { add(from, of_part, find); });
    if (all_known) return;
  }
  add(0, count, [&](const Source& source) {
    scratch_.clear();
    ListShapes(source, [this](const simd::RowShape& row) { scratch_.push_back(row); });
    return shapes->Intern(scratch_, SourceOf(source));
  });
}

void PairFinder::Put(const Pair& put, bool opposite, size_t place) {
  const auto moves = [this](int body) { return body != kWorld && (*movable_)[body] != kUnmoved; };
  Pair& pair = list_->pairs[place] = put;
  if (!moves(pair.a)) pair.a = kWorld;
  if (!moves(pair.b)) pair.b = kWorld;
  if (pair.a == kWorld) std::swap(pair.a, pair.b);
  if (pair.b == kWorld || opposite) pair.form = FormOf(*movable_, pair);
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
