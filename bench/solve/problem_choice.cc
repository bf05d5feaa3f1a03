// SPDX-License-Identifier: MIT
#include "solve/problem_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <set>

#include "cairn/lcp/solver.h"
#include "problems/problem_folder.h"
#include "rigid/rigid_list.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/names.h"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using problems::Generator;
using problems::Parameter;
using problems::Problem;

/// A problem that was read once and is shown to every solver.
class ReadProblem : public problems::Source {
 public:
  explicit ReadProblem(std::shared_ptr<const Problem> problem) : problem_(std::move(problem)) {}
  const Problem& current() const override { return *problem_; }
  bool Advance(const Eigen::VectorXd&) override { return false; }

 private:
  std::shared_ptr<const Problem> problem_;
};

/// "--set name=value", taken apart.
struct Setting {
  std::string name;
  std::string value;
};

Setting ParseSetting(const std::string& word) {
  const size_t equals = word.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == word.size()) {
    throw Failure(kUsage, fmt::format("--set '{}': write name=value", word));
  }
  return {word.substr(0, equals), word.substr(equals + 1)};
}

constexpr const char* kRecordingEnding = ".cairn";

/// In the order of their names.
std::vector<fs::path> RecordingsIn(const fs::path& folder) {
  std::vector<fs::path> recordings;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == kRecordingEnding) recordings.push_back(entry.path());
  }
  std::sort(recordings.begin(), recordings.end());
  return recordings;
}

/// The folder of a problem that a file is a part of.
fs::path FolderOf(const fs::path& file) {
  const fs::path folder = file.parent_path().empty() ? "." : file.parent_path();
  const bool is_part = file.extension() == ".mtx" || file.filename() == "meta.json";
  if (is_part && problems::IsProblemFolder(folder)) return folder;
  throw Failure(kBadInput,
                fmt::format("'{}' is no problem: solve takes recordings (*{}), folders "
                            "with meta.json, and names ('cairn list problems' shows all)",
                            file.string(), kRecordingEnding));
}

std::vector<std::string> ParameterNames(const Generator& generator) {
  std::vector<std::string> names;
  for (const Parameter& parameter : generator.parameters) names.push_back(parameter.name);
  return names;
}

/// Collects the problems that were typed.
class Chooser {
 public:
  explicit Chooser(const ProblemWords& words) : words_(words) {
    for (const std::string& word : words.settings) settings_.push_back(ParseSetting(word));
  }

  ProblemChoices Choose() {
    for (const std::string& word : words_.names) Add(word);
    RefuseUnused();
    return std::move(choices_);
  }

 private:
  void Add(const std::string& word) {
    std::vector<std::string> names;
    for (const Generator& generator : KnownGenerators()) names.push_back(generator.name);
    const bool is_name = std::find(names.begin(), names.end(), word) != names.end();
    const bool is_path = word.find_first_of("/.") != std::string::npos;
    std::error_code ignored;
    if (!is_name && fs::exists(word, ignored)) return AddPath(word);
    if (is_path) {
      throw Failure(kBadInput, fmt::format("'{}': there is no such file or folder", word));
    }
    const size_t index = FindName(
        "problem", word, names, "'cairn list problems' shows all; no folder has that name either");
    AddGenerator(KnownGenerators()[index]);
  }

  void AddGenerator(const Generator& generator) {
    if (!seen_.insert(generator.name).second) return;
    ProblemChoice choice;
    choice.size = generator.size;
    if (!words_.size.empty()) {
      choice.size =
          static_cast<int>(ParseCount("--size", words_.size, generator.min_size, generator.max_size,
                                      generator.name + ": " + generator.size_help));
    }
    std::vector<double> values;
    for (const Parameter& parameter : generator.parameters) {
      double value = parameter.value;
      for (const Setting& setting : settings_) {
        if (setting.name != parameter.name) continue;
        value = ParseNumber(fmt::format("--set {} of {}", parameter.name, generator.name),
                            setting.value, parameter.min, parameter.max, parameter.help);
      }
      values.push_back(value);
      choice.parameters.emplace_back(parameter.name, value);
    }
    choice.make = [&generator, size = choice.size, values] { return generator.make(size, values); };
    choices_.problems.push_back(std::move(choice));
    generators_.push_back(&generator);
  }

  void AddPath(const fs::path& path) {
    if (!fs::is_directory(path)) {
      if (IsRecording(path.string()) || path.extension() == kRecordingEnding) {
        return AddRecording(path);
      }
      return AddFolder(FolderOf(path));
    }
    if (problems::IsProblemFolder(path)) return AddFolder(path);
    const std::vector<fs::path> recordings = RecordingsIn(path);
    for (const fs::path& recording : recordings) {
      AddAmongOthers(recording, [&] { AddRecording(recording); });
    }
    const std::vector<fs::path> folders = problems::ProblemFoldersIn(path);
    if (folders.empty() && recordings.empty()) {
      throw Failure(kBadInput,
                    fmt::format("'{}': holds neither meta.json nor folders that do, nor recordings "
                                "(*{})",
                                path.string(), kRecordingEnding));
    }
    for (const fs::path& folder : folders) {
      AddAmongOthers(folder, [&] {
        if (problems::ReadKind(folder) == "friction") {
          choices_.skipped.push_back(
              {folder.filename().string(), "kind friction: bounds that follow other unknowns"});
        } else {
          AddFolder(folder);
        }
      });
    }
  }

  /// What cannot be read leaves the others alone.
  void AddAmongOthers(const fs::path& path, const std::function<void()>& add) {
    try {
      add();
    } catch (const problems::FileError& error) {
      choices_.unread.push_back({path.string(), error.what()});
    } catch (const Failure& error) {
      choices_.unread.push_back({path.string(), error.what()});
    }
  }

  void AddRecording(const fs::path& path) {
    if (!seen_.insert(fs::weakly_canonical(path).string()).second) return;
    choices_.frames.push_back(LoadRowProblem(path.string()));
  }

  void AddFolder(const fs::path& folder) {
    if (!seen_.insert(fs::weakly_canonical(folder).string()).second) return;
    auto problem = std::make_shared<Problem>(problems::ReadProblemFolder(folder));
    const lcp::Report report = Validate(problem->lcp);
    if (!report.ok()) {
      const std::string row = report.bad_row < 0 ? "" : fmt::format(", row {}", report.bad_row + 1);
      throw Failure(kBadInput,
                    fmt::format("{}{}: {}", folder.string(), row, Describe(report.status)));
    }
    ProblemChoice choice;
    choice.make = [problem] { return std::make_unique<ReadProblem>(problem); };
    choices_.problems.push_back(std::move(choice));
  }

  /// What was typed must mean something to at least one of the problems.
  void RefuseUnused() const {
    if (generators_.empty() && !words_.size.empty()) {
      throw Failure(kUsage,
                    "--size is for generators: folders and recordings have the size they have");
    }
    if (generators_.empty() && !settings_.empty()) {
      throw Failure(kUsage, "--set is for generators: folders and recordings have no parameters");
    }
    std::vector<std::string> known;
    for (const Generator* generator : generators_) {
      for (const std::string& name : ParameterNames(*generator)) {
        if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
      }
    }
    for (const Setting& setting : settings_) {
      if (std::find(known.begin(), known.end(), setting.name) != known.end()) continue;
      if (known.empty()) {
        throw Failure(kUsage, fmt::format("--set {}: {} has no parameters", setting.name,
                                          generators_.front()->name));
      }
      const std::string near = DidYouMean(setting.name, known);
      throw Failure(kUsage, fmt::format("unknown parameter '{}': {}{} are {}", setting.name, near,
                                        near.empty() ? "there" : "There", fmt::join(known, ", ")));
    }
  }

  const ProblemWords& words_;
  std::vector<Setting> settings_;
  std::vector<const Generator*> generators_;
  std::set<std::string> seen_;
  ProblemChoices choices_;
};

}  // namespace

const std::vector<Generator>& KnownGenerators() {
  static const std::vector<Generator> generators = [] {
    std::vector<Generator> all = problems::Generators();
    std::vector<Generator> rigid = bench::RigidGenerators();
    std::move(rigid.begin(), rigid.end(), std::back_inserter(all));
    return all;
  }();
  return generators;
}

ProblemChoices ParseProblems(const ProblemWords& words) {
  try {
    return Chooser(words).Choose();
  } catch (const problems::FileError& error) {
    throw Failure(kBadInput, error.what());
  }
}

}  // namespace cairn::cli
