// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

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

/// Where the directions of a block of manifolds are in BlockData::directions.
inline std::size_t DirectionsOf(const simd::PairBlock& block) { return 2 * std::size_t{block.x}; }

/// Their impulses from its lines.
void WriteManifolds(const BlockPacker& packer, int block, const BlockData& blocks,
                    const Impulses& impulses);

}  // namespace cairn
