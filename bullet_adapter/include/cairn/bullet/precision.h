// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <LinearMath/btScalar.h>

/// The precision of Bullet is part of the name of everything that sees its types. A program built
/// for one precision and linked with the adapter for the other is refused by the linker, which then
/// names the precision it was looking for.
#ifdef BT_USE_DOUBLE_PRECISION
#define CAIRN_BULLET_PRECISION for_float64_bullet
#else
#define CAIRN_BULLET_PRECISION for_float_bullet
#endif
