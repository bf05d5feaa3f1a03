// SPDX-License-Identifier: MIT
// Every public header includes this first: an old language level is named before anything that it
// does not understand.
#pragma once

// MSVC keeps the truth in _MSVC_LANG; an unknown name is 0 here.
#if __cplusplus <= 201703L && _MSVC_LANG + 0 <= 201703L
#error "Cairn needs C++20: compile with -std=c++20 (CMake: set CMAKE_CXX_STANDARD to 20)."
#endif
