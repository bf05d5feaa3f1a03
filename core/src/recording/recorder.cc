// SPDX-License-Identifier: MIT
#include "cairn/detail/recorder.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <new>
#include <system_error>

namespace cairn {
namespace {

constexpr int kMostWorlds = 100000;

/// A number at the front of the text, which is taken away; -1 if there is none.
std::int64_t TakeNumber(std::string_view* text) {
  std::int64_t number = -1;
  const char* const end = text->data() + text->size();
  const auto [rest, error] = std::from_chars(text->data(), end, number);
  if (error != std::errc{} || number < 0) return -1;
  text->remove_prefix(rest - text->data());
  return number;
}

bool Take(char letter, std::string_view* text) {
  if (text->empty() || text->front() != letter) return false;
  text->remove_prefix(1);
  return true;
}

}  // namespace

bool FrameChoice::Parse(std::string_view text) {
  all_ = false;
  ranges_.clear();
  do {
    const std::int64_t first = TakeNumber(&text);
    const std::int64_t last = Take('-', &text) ? TakeNumber(&text) : first;
    if (first < 0 || last < first) {
      ranges_.clear();
      return false;
    }
    ranges_.emplace_back(first, last);
  } while (Take(',', &text));
  if (!text.empty()) ranges_.clear();
  return text.empty();
}

bool FrameChoice::Contains(std::int64_t frame) const {
  return all_ || std::any_of(ranges_.begin(), ranges_.end(), [frame](const auto& range) {
           return range.first <= frame && frame <= range.second;
         });
}

std::int64_t FrameChoice::last() const {
  if (all_) return std::numeric_limits<std::int64_t>::max();
  std::int64_t last = -1;
  for (const auto& range : ranges_) last = std::max(last, range.second);
  return last;
}

std::unique_ptr<Recorder> Recorder::FromEnvironment(std::string source) {
  const char* const folder = std::getenv("CAIRN_RECORD");
  if (folder == nullptr || *folder == '\0') return nullptr;
  auto recorder = std::make_unique<Recorder>(std::move(source));
  FrameChoice frames;
  const char* const words = std::getenv("CAIRN_RECORD_FRAMES");
  if (words != nullptr && *words != '\0' && !frames.Parse(words)) {
    recorder->Fail("CAIRN_RECORD_FRAMES='" + std::string(words) +
                   "' is no list of frames, such as 40,90 or 40-49");
  }
  recorder->RecordTo(folder, std::move(frames));
  return recorder;
}

void Recorder::RecordTo(std::string folder, FrameChoice frames) {
  folder_ = std::move(folder);
  frames_ = std::move(frames);
  own_folder_.clear();
  in_folder_ = true;
}

void Recorder::RecordNext(std::string path, std::int64_t frame) {
  next_path_ = std::move(path);
  next_frame_ = frame;
}

bool Recorder::Begin(const ContactProblem& problem, const Impulses& start) {
  if (next_path_.empty() && !(in_folder_ && frames_.Contains(frame_))) return false;
  recording_.Assign(problem, start);
  return true;
}

void Recorder::End(const Settings& settings, const Report& report) {
  try {
    Write(settings, report);
  } catch (const std::bad_alloc&) {
    // the step is solved all the same
    Fail("out of memory");
  }
}

void Recorder::Write(const Settings& settings, const Report& report) {
  recording_.frame = next_path_.empty() ? frame_ : next_frame_;
  recording_.settings = settings;
  recording_.settings.tuning.spans = nullptr;
  recording_.settings.tuning.replay = nullptr;
  recording_.settings.executor = nullptr;
  recording_.settings.tuning.clock = nullptr;
  recording_.replay.reset();
  const bool at_once = settings.substeps == 1 && !settings.relax;
  if (settings.budget.kind() == Budget::Kind::kTime && at_once) recording_.replay = report.replay;

  std::string path = next_path_;
  if (path.empty()) {
    const std::string folder = OwnFolder();
    if (folder.empty()) return;
    char name[40];
    std::snprintf(name, sizeof name, "/frame-%06lld.cairn", static_cast<long long>(frame_));
    path = folder + name;
  }
  if (const RecordingStatus status = Save(recording_, path); !status.ok()) {
    return Fail("'" + path + "' " + status.message);
  }
  ++files_.written;
  files_.last_file = path;
}

void Recorder::NextFrame() {
  next_path_.clear();
  ++frame_;
}

void Recorder::Fail(std::string why) {
  ++files_.failed;
  files_.last_failure = std::move(why);
}

std::string Recorder::OwnFolder() {
  if (!own_folder_.empty()) return own_folder_;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  for (int i = 1; !error && i <= kMostWorlds; ++i) {
    // made by one world only, whatever other programs do
    const std::string folder = folder_ + "/world-" + std::to_string(i);
    if (std::filesystem::create_directory(folder, error)) return own_folder_ = folder;
  }
  Fail("'" + folder_ + "' cannot be created" + (error ? ": " + error.message() : ""));
  in_folder_ = false;  // asked once
  return "";
}

}  // namespace cairn
