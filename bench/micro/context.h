// SPDX-License-Identifier: MIT
#pragma once

#include "micro/memory.h"

namespace cairn::micro {

/// Puts into the report where and with what it was made, and what speaks against its figures.
void AddContext(const Memory& memory);

}  // namespace cairn::micro
