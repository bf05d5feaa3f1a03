// SPDX-License-Identifier: MIT
#pragma once

#include "pack/block_pack.h"

namespace cairn {

/// The joints of a block into its lines, with their start impulses.
/// @pre the block is one of joints
PackResult PackJoints(const BlockPacker& packer, int block, const Impulses& start,
                      BlockData* blocks);

/// Their impulses from its lines.
void WriteJoints(const BlockPacker& packer, int block, const BlockData& blocks,
                 const Impulses& impulses);

}  // namespace cairn
