// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstddef>
#include <span>
#include <string>
#include <system_error>

namespace cairn {

/// Writes a file so that its name stands for the old content or for the new one, whatever happens:
/// beside it (PATH.part), down to the disk, and then renamed. What is left of a program that was
/// killed is a PATH.part, which the next one overwrites. What is no file of its own, such as a
/// device or a pipe, is written as it is.
/// @return what went wrong, and then the old content is still there; otherwise no error
[[nodiscard]] std::error_code WriteWholeFile(const std::string& path,
                                             std::span<const std::byte> bytes);

/// Whether that could be begun: for those who work long for what they write. Leaves nothing behind.
[[nodiscard]] std::error_code TryWholeFile(const std::string& path);

}  // namespace cairn
