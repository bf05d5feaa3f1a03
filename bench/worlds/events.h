// SPDX-License-Identifier: MIT
#pragma once

#include "worlds/draft.h"

namespace cairn::bench {

/// One to four things that happen to any world: a joint or a body goes, a body comes from above,
/// two bodies near each other are pinned, gravity turns, all are kicked.
/// @pre the bodies are there
void DrawEvents(Draft* draft);

}  // namespace cairn::bench
