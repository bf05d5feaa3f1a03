// SPDX-License-Identifier: MIT
#include "cairn/detail/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/core/support/recording_problems.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

/// A folder that is empty at first.
std::string FreshFolder(const std::string& name) {
  const std::string folder = testing::TempDir() + "/" + name;
  fs::remove_all(folder);
  return folder;
}

std::vector<std::string> FilesIn(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), folder).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void Play(Recorder* recorder, int frames) {
  for (int i = 0; i < frames; ++i) {
    Recording frame = test::RandomRecording(i);
    if (recorder->Begin(frame.problem(), frame.impulses())) recorder->End(frame.settings, Report{});
    recorder->NextFrame();
  }
}

FrameChoice Frames(const char* text) {
  FrameChoice frames;
  EXPECT_TRUE(frames.Parse(text));
  return frames;
}

TEST(FrameChoice, TakesNumbersAndRanges) {
  EXPECT_TRUE(FrameChoice().Contains(7));
  const FrameChoice frames = Frames("3,10-12,40");
  EXPECT_EQ(frames.last(), 40);
  for (const int frame : {3, 10, 11, 12, 40}) EXPECT_TRUE(frames.Contains(frame));
  for (const int frame : {0, 2, 4, 9, 13, 39, 41}) EXPECT_FALSE(frames.Contains(frame));
  for (const char* bad :
       {"", "a", "3,", ",3", "3-", "5-4", "-1", "3;4", "3 4", "99999999999999999999"}) {
    FrameChoice none;
    EXPECT_FALSE(none.Parse(bad)) << bad;
    EXPECT_FALSE(none.Contains(3));
  }
}

TEST(Recorder, WritesTheFramesThatAreWantedAndNothingElse) {
  const std::string folder = FreshFolder("recorder_frames");
  Recorder recorder("test");
  recorder.RecordTo(folder, Frames("1,3-4"));
  Play(&recorder, 6);
  EXPECT_THAT(FilesIn(folder),
              ElementsAre("world-1/frame-000001.cairn", "world-1/frame-000003.cairn",
                          "world-1/frame-000004.cairn"));
  EXPECT_EQ(recorder.files().written, 3);
  EXPECT_EQ(recorder.files().failed, 0);
  Recording read;
  ASSERT_TRUE(Load(recorder.files().last_file, &read).ok());
  EXPECT_EQ(read.frame, 4);
  EXPECT_EQ(read.source, "test");
  EXPECT_EQ(read.row_impulses, test::RandomRecording(4).row_impulses);
}

// In parts, and relaxed, the clock decides more than a replay holds.
TEST(Recorder, KeepsAReplayOnlyOfWhatCanBeMadeAgain) {
  const std::string path = testing::TempDir() + "cairn_recorder_replay.cairn";
  for (const bool relax : {false, true}) {
    for (const int substeps : {1, 2}) {
      Recorder recorder("test");
      recorder.RecordNext(path);
      const Body body{.inv_mass = 1};
      recorder.Begin({.bodies = {&body, 1}}, {});
      recorder.End({.substeps = substeps,
                    .relax = relax,
                    .budget = Budget::Time(std::chrono::milliseconds(1))},
                   {});
      Recording recording;
      ASSERT_TRUE(Load(path, &recording).ok());
      EXPECT_EQ(recording.replay.has_value(), substeps == 1 && !relax);
    }
  }
}

TEST(Recorder, OfAnotherWorldOverwritesNothing) {
  const std::string folder = FreshFolder("recorder_worlds");
  for (int i = 0; i < 2; ++i) {
    Recorder recorder("test");
    recorder.RecordTo(folder, {});
    Play(&recorder, 1);
  }
  EXPECT_THAT(FilesIn(folder),
              ElementsAre("world-1/frame-000000.cairn", "world-2/frame-000000.cairn"));
}

TEST(Recorder, IsAskedByTheEnvironment) {
  const std::string folder = FreshFolder("recorder_environment");
  unsetenv("CAIRN_RECORD");
  EXPECT_EQ(Recorder::FromEnvironment("test"), nullptr);
  setenv("CAIRN_RECORD", folder.c_str(), 1);
  setenv("CAIRN_RECORD_FRAMES", "2", 1);
  Play(Recorder::FromEnvironment("test").get(), 4);
  EXPECT_THAT(FilesIn(folder), ElementsAre("world-1/frame-000002.cairn"));
  setenv("CAIRN_RECORD_FRAMES", "two", 1);
  const auto recorder = Recorder::FromEnvironment("test");
  Play(recorder.get(), 4);
  EXPECT_EQ(recorder->files().written, 0);
  EXPECT_THAT(recorder->files().last_failure, HasSubstr("CAIRN_RECORD_FRAMES='two'"));
  unsetenv("CAIRN_RECORD");
  unsetenv("CAIRN_RECORD_FRAMES");
}

/// Frames of a game until it is killed, which it is so many microseconds after it began.
void PlayUntilKilled(const std::string& folder, useconds_t time) {
  const pid_t game = fork();
  ASSERT_GE(game, 0);
  if (game == 0) {
    Recorder recorder("test");
    recorder.RecordTo(folder, {});
    Play(&recorder, 1 << 20);
    _exit(0);
  }
  usleep(time);
  kill(game, SIGKILL);
  waitpid(game, nullptr, 0);
}

TEST(Recorder, OfAGameThatWasKilledCanBeReadUpToTheLastWholeFrame) {
  constexpr int kGames = 20;
  constexpr useconds_t kLongest = 20'000'000;  // of a machine that does much else
  int games_with_frames = 0, games = 0;
  // later and later, until most games have come to write
  for (useconds_t time = 1000; time < kLongest && (games < kGames || games_with_frames == 0);
       time += games < kGames ? 2900 : time, ++games) {
    const std::string folder = FreshFolder("recorder_killed");
    PlayUntilKilled(folder, time);
    int frames = 0;
    for (const std::string& file :
         fs::exists(folder) ? FilesIn(folder) : std::vector<std::string>()) {
      if (file.ends_with(".part")) continue;  // of the frame that was being written
      Recording read;
      const RecordingStatus status = Load(folder + "/" + file, &read);
      EXPECT_TRUE(status.ok()) << file << ": " << status.message;
      EXPECT_EQ(read.frame, frames++) << "frames are missing before the last one";
    }
    games_with_frames += frames > 0;
  }
  EXPECT_GT(games_with_frames, 0);
}

TEST(Recorder, CountsWhatCannotBeWritten) {
  const std::string folder = FreshFolder("recorder_failure");
  std::ofstream(folder) << "a file where a folder is to be";
  Recorder recorder("test");
  recorder.RecordTo(folder, {});
  Play(&recorder, 3);
  EXPECT_EQ(recorder.files().written, 0);
  EXPECT_EQ(recorder.files().failed, 1);  // it does not ask again
  EXPECT_THAT(recorder.files().last_failure, HasSubstr(folder));

  Recorder other("test");
  other.RecordNext(folder + "/none/a.cairn");
  Play(&other, 2);
  EXPECT_EQ(other.files().failed, 1);
}

}  // namespace
}  // namespace cairn
