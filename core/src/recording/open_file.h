// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <memory>

namespace cairn {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// A file that is open until this goes.
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

}  // namespace cairn
