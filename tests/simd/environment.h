// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string>

namespace cairn::test {

/// Sets a variable of the environment; one without characters is taken out.
inline void SetVariable(const char* name, const std::string& value) {
#if defined(_WIN32)
  _putenv_s(name, value.c_str());
#else
  value.empty() ? unsetenv(name) : setenv(name, value.c_str(), 1);
#endif
}

}  // namespace cairn::test
