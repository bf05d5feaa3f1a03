// SPDX-License-Identifier: MIT
#pragma once

#include "pack/block_pack.h"

namespace cairn {

/// Takes bodies with locked axes out of those rows of a packed block that leave them alone, and
/// puts the steps of those that do not; see LookAtLocked(). A row that moves nothing asks for
/// nothing.
void ApplyLocks(const BlockPacker& packer, int block, BlockData* blocks);

}  // namespace cairn
