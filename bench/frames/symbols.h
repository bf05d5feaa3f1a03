// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace cairn::frames {

/// Names of the functions of this process, as `nm` and the dynamic linker know them.
class Symbols {
 public:
  Symbols();

  /// Without arguments. The name of the library where the function has none.
  std::string NameAt(std::uint64_t address) const;

 private:
  std::map<std::uint64_t, std::string> own_;  ///< Of the program itself, by address.
  std::uint64_t end_ = 0;                     ///< Of the program.
};

}  // namespace cairn::frames
