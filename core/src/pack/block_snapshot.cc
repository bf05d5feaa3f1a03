// SPDX-License-Identifier: MIT
#include "pack/block_snapshot.h"

#include <algorithm>

namespace cairn {
namespace {

using Lines = Array<simd::Line>;
using Bodies = Array<simd::BodyLane>;

/// Impulses and bodies of an island, which may share its lines with others.
void Copy(const Plan& plan, int island, const Lines& x_from, const Bodies& bodies_from, Lines* x,
          Bodies* bodies) {
  const Group& group = plan.groups()[plan.islands()[island].group];
  if (group.islands == 1) {
    std::copy_n(x_from.begin() + group.first_x, group.x_lines, x->begin() + group.first_x);
    std::copy_n(bodies_from.begin() + group.first_slot, group.slots,
                bodies->begin() + group.first_slot);
    return;
  }
  for (const int at : plan.lanes_of(island)) {
    const simd::PairBlock& block = plan.blocks()[at / simd::kLanes];
    const int lane = at % simd::kLanes;
    for (int k = 0; k < block.row_count; ++k) {
      (*x)[block.x + k].lane[lane] = x_from[block.x + k].lane[lane];
    }
    for (const int seen : {block.a[lane], block.b[lane]}) {
      const int slot = plan.own_slot(seen);
      if (slot != 0) (*bodies)[slot] = bodies_from[slot];
    }
  }
}

}  // namespace

void BlockSnapshot::Reserve(const BlockData& blocks) {
  if (x_.size() < blocks.x.size()) x_.resize(blocks.x.size());
  if (bodies_.size() < blocks.bodies.size()) bodies_.resize(blocks.bodies.size());
}

void BlockSnapshot::Take(const Plan& plan, int island, const BlockData& blocks) {
  Reserve(blocks);
  Copy(plan, island, blocks.x, blocks.bodies, &x_, &bodies_);
}

void BlockSnapshot::Restore(const Plan& plan, int island, BlockData* blocks) const {
  Copy(plan, island, x_, bodies_, &blocks->x, &blocks->bodies);
}

}  // namespace cairn
