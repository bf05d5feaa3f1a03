// SPDX-License-Identifier: MIT
#include "block_merit.h"

namespace cairn {
namespace {

/// x (E x / 2 - target) of all rows of each lane.
struct LaneSums {
  double lane[simd::kLanes] = {};

  void Add(const simd::PairBlock& block, const simd::Line* lines, const simd::Line* x) {
    lines += simd::PairLines(block.form);
    for (int i = 0; i < block.row_count; ++i) {
      const simd::RowShape& row = block.rows[i];
      const simd::Line* const target = lines + simd::JacobianLines(block.form);
      for (int l = 0; l < simd::kLanes; ++l) {
        const double impulse = static_cast<double>(x[i].lane[l]);
        const double soft = row.soft ? static_cast<double>(target[2].lane[l]) : 0;
        lane[l] += impulse * (0.5 * soft * impulse - static_cast<double>(target->lane[l]));
      }
      lines += simd::RowLines(block.form, row);
    }
  }
};

}  // namespace

void FindMerits(const Plan& plan, const Group& group, const BlockData& blocks,
                std::span<double> merits) {
  for (int i : plan.islands_of_groups().subspan(group.first_island, group.islands)) merits[i] = 0;
  for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    LaneSums sums;
    sums.Add(block, blocks.data.data() + block.data, blocks.x.data() + block.x);
    for (int l = 0; l < block.lanes; ++l) merits[plan.island_of(b, l)] += sums.lane[l];
  }
  for (int slot = group.first_slot; slot < group.first_slot + group.slots; ++slot) {
    const int body = plan.body_of_slot()[slot];
    if (body == kWorld) continue;
    double squares = 0;
    for (float u : blocks.bodies[slot].u)
      squares += static_cast<double>(u) * static_cast<double>(u);
    merits[plan.island_of_body()[body]] += 0.5 * squares;
  }
}

}  // namespace cairn
