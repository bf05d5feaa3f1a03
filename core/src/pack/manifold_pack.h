// SPDX-License-Identifier: MIT
#pragma once

#include "pack/block_pack.h"

namespace cairn {

/// The numbers of a body that kernels make rows of joints and contacts with. @p motion: instead of
/// its own, or nullptr.
simd::ContactBody ContactBodyOf(const Body& body, const WhitenedBody& whitened,
                                const ContactMotion* motion);

/// The manifolds of a block into its lines, with their start impulses.
/// @pre the block is one of manifolds
PackResult PackManifolds(const BlockPacker& packer, int block, const Impulses& start,
                         BlockData* blocks);

/// Their impulses from its lines.
void WriteManifolds(const BlockPacker& packer, int block, const BlockData& blocks,
                    const Impulses& impulses);

}  // namespace cairn
