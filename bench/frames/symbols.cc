// SPDX-License-Identifier: MIT
#include "frames/symbols.h"

#include <stdexcept>

#if defined(__linux__)
#include <cxxabi.h>
#include <dlfcn.h>
#include <link.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <memory>
#endif

namespace cairn::frames {

#if defined(__linux__)

namespace {

std::string Demangled(const char* name) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> readable(
      abi::__cxa_demangle(name, nullptr, nullptr, &status), std::free);
  return status == 0 ? std::string(readable.get()) : std::string(name);
}

/// Where the program was loaded, and where it ends.
struct Place {
  std::uint64_t begin = 0, end = 0;
};

int FirstOnly(dl_phdr_info* info, size_t, void* data) {
  auto* place = static_cast<Place*>(data);
  place->begin = info->dlpi_addr;
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& header = info->dlpi_phdr[i];
    if (header.p_type == PT_LOAD) place->end = place->begin + header.p_vaddr + header.p_memsz;
  }
  return 1;
}

}  // namespace

Symbols::Symbols() {
  Place place;
  dl_iterate_phdr(&FirstOnly, &place);
  end_ = place.end;
  const std::unique_ptr<FILE, int (*)(FILE*)> names(popen("nm -n /proc/$PPID/exe", "r"), pclose);
  if (names == nullptr) throw std::runtime_error("footprint: nm does not run");
  std::array<char, 4096> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), names.get()) != nullptr) {
    unsigned long long address = 0;
    char kind = 0;
    std::array<char, 4096> name{};
    if (std::sscanf(line.data(), "%llx %c %4095s", &address, &kind, name.data()) != 3) continue;
    if (kind == 't' || kind == 'T' || kind == 'w' || kind == 'W' || kind == 'i') {
      own_[place.begin + address] = Demangled(name.data());
    }
  }
  if (own_.empty()) throw std::runtime_error("footprint: nm finds no names; is it installed?");
}

std::string Symbols::NameAt(std::uint64_t address) const {
  const auto after = own_.upper_bound(address);
  if (address < end_ && after != own_.begin()) return std::prev(after)->second;
  Dl_info info;
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the linker takes addresses as pointers
  if (dladdr(reinterpret_cast<void*>(address), &info) == 0) return "?";
  return info.dli_sname != nullptr ? Demangled(info.dli_sname) : std::string(info.dli_fname);
}

#else

Symbols::Symbols() { throw std::runtime_error("footprint: only on Linux"); }
std::string Symbols::NameAt(std::uint64_t) const { return "?"; }

#endif

}  // namespace cairn::frames
