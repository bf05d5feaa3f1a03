// SPDX-License-Identifier: MIT
#pragma once

#include "pack/block_pack.h"

namespace cairn {

/// Takes bodies with locked axes out of those rows of a packed block that leave them alone; see
/// IsLeftAlone(). A row that moves nothing then asks for nothing.
void LeaveLockedAlone(const BlockPacker& packer, int block, BlockData* blocks);

}  // namespace cairn
