// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace cairn {

/// CRC-32 as of IEEE 802.3, zlib and PNG: any change of up to 32 bits in a row is noticed.
/// @param before  that of the bytes before these, 0 if there are none
std::uint32_t Crc32(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace cairn
