// SPDX-License-Identifier: MIT
// Bytes of recordings, taken apart and put together by the page of the format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cairn/detail/recording.h"

namespace cairn::test {

using Bytes = std::vector<std::byte>;

/// @pre the recording can be encoded
Bytes EncodeAll(const Recording& recording);

/// Numbers of @p size bytes, lowest byte first. @pre they are inside
std::uint64_t NumberAt(const Bytes& bytes, std::size_t at, int size);
void PutNumber(std::uint64_t value, std::size_t at, int size, Bytes* bytes);

/// Where the entry of a section is in the table. @pre it is there
std::size_t TableEntryOf(const Bytes& bytes, const std::string& section);
/// Where its data begins.
std::size_t DataOf(const Bytes& bytes, const std::string& section);

/// Makes all checksums right again that can be found, so that readers go on to what is behind them.
void RepairChecksums(Bytes* bytes);

}  // namespace cairn::test
