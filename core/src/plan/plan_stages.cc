// SPDX-License-Identifier: MIT
// Which blocks threads may take at a time: stages of units, one after the other.
#include "plan/plan.h"

namespace cairn {
namespace {

/// A claim of a thread: a few microseconds of work.
constexpr int kUnitRows = 1024;
/// The budget is looked at between stages: at most about 50 us of work each, on slow targets too.
constexpr int kStageRows = 8192;
/// Colours smaller than this are not worth waiting for each other: one thread takes several, up to
/// so many rows.
constexpr int kTinyColour = 512;
constexpr int kTinyColoursRows = 2048;

}  // namespace

int Plan::RowsOf(int first_block, int end_block) const {
  int rows = 0;
  for (int b = first_block; b < end_block; ++b) rows += blocks_[b].lanes * blocks_[b].row_count;
  return rows;
}

void Plan::AddStage(Follows follows) {
  const int stage = static_cast<int>(stages_.size()), unit = static_cast<int>(units_.size());
  if (follows == Follows::kNothing) phases_.push_back({.first_stage = stage, .first_unit = unit});
  stages_.push_back({.first_unit = unit});
  ++phases_.back().stages;
}

void Plan::AddUnit(const Unit& unit) {
  units_.push_back(unit);
  ++stages_.back().units;
  stages_.back().rows += unit.rows;
  ++phases_.back().units;
}

void Plan::AddUnits(int first_block, int end_block, int group) {
  // blocks of one colour, a stage at a time
  for (int b = first_block; b < end_block;) {
    AddStage(b == first_block ? Follows::kNothing : Follows::kLastPhase);
    while (b < end_block && stages_.back().rows < kStageRows) {
      Unit unit{.first_block = b, .group = group};
      for (; b < end_block && unit.rows < kUnitRows; ++b) unit.rows += RowsOf(b, b + 1);
      unit.blocks = b - unit.first_block;
      AddUnit(unit);
    }
  }
}

/// @pre the group is large
int Plan::ColourOf(const Group& group, int block) const {
  return colour_of_run_[group.first_run + block - group.first_block];
}

void Plan::StagesOf(int g) {
  const Group& group = groups_[g];
  const int end = group.first_block + group.blocks;
  bool tail = false;  // the last unit is one of tiny colours, and may be continued
  for (int b = group.first_block; b < end;) {
    int next = b + 1;
    while (next < end && ColourOf(group, next) == ColourOf(group, b)) ++next;
    const int rows = RowsOf(b, next);
    const bool overflow = Colour::IsOverflow(ColourOf(group, b));
    if (!overflow && rows >= kTinyColour) {
      AddUnits(b, next, g);
      tail = false;
      b = next;
      continue;
    }
    // one thread: blocks of the overflow, and of tiny colours
    for (; b < next; ++b) {
      const int more = RowsOf(b, b + 1);
      if (!tail || units_.back().rows + more > kTinyColoursRows) {
        AddStage(Follows::kNothing);
        AddUnit({.first_block = b, .group = g});
        tail = true;
      }
      ++units_.back().blocks;
      units_.back().rows += more;
      stages_.back().rows += more;
    }
  }
}

void Plan::FindStages() {
  units_.clear();
  stages_.clear();
  phases_.clear();
  bool whole = false;     // the last stage is one of whole groups
  int rows = kStageRows;  // of the last stage of whole groups
  for (int g = 0; g < static_cast<int>(groups_.size()); ++g) {
    const Group& group = groups_[g];
    if (group.rows > Group::kSharedRows) {
      StagesOf(g);
      whole = false;
      continue;
    }
    if (rows >= kStageRows || !whole) {
      AddStage(whole ? Follows::kLastPhase : Follows::kNothing);
      whole = true;
      rows = 0;
    }
    AddUnit({.first_block = group.first_block,
             .blocks = group.blocks,
             .group = g,
             .rows = static_cast<int>(group.rows)});
    rows += static_cast<int>(group.rows);
  }
}

}  // namespace cairn
