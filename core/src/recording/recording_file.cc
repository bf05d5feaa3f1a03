// SPDX-License-Identifier: MIT
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "cairn/detail/recording.h"
#include "cairn/detail/whole_file.h"
#include "recording/open_file.h"
#include "recording/recording_format.h"

namespace cairn {
namespace {

RecordingStatus Because(RecordingFault fault, const char* what) {
  return {fault, std::string(what) + ": " + std::strerror(errno)};
}

/// Everything that is in the file. Of a large file that is no recording, only the beginning.
RecordingStatus ReadBytes(std::FILE* file, std::uintmax_t size, std::vector<std::byte>* bytes) {
  std::size_t wanted = kRecordingMagic.size();
  while (true) {
    const std::size_t has = bytes->size();
    bytes->resize(wanted);
    const std::size_t got = std::fread(bytes->data() + has, 1, wanted - has, file);
    bytes->resize(has + got);
    if (std::ferror(file) != 0) return Because(RecordingFault::kCannotOpen, "cannot be read");
    if (bytes->size() < wanted || wanted >= size) return {};
    const bool is_recording =
        std::memcmp(bytes->data(), kRecordingMagic.data(), kRecordingMagic.size()) == 0;
    if (!is_recording) return {};
    wanted = size;
  }
}

}  // namespace

RecordingStatus Save(const Recording& recording, const std::string& path) {
  std::vector<std::byte> bytes;
  if (RecordingStatus status = Encode(recording, &bytes); !status.ok()) return status;
  const std::error_code error = WriteWholeFile(path, bytes);
  if (!error) return {};
  return {RecordingFault::kCannotWrite, "cannot be written: " + error.message()};
}

RecordingStatus Load(const std::string& path, Recording* recording) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return {RecordingFault::kCannotOpen, "cannot be opened: " + error.message()};
  const OpenFile file(std::fopen(path.c_str(), "rb"));
  if (!file) return Because(RecordingFault::kCannotOpen, "cannot be opened");
  std::vector<std::byte> bytes;
  if (RecordingStatus status = ReadBytes(file.get(), size, &bytes); !status.ok()) return status;
  return Decode(bytes, recording);
}

}  // namespace cairn
