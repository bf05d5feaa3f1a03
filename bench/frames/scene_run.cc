// SPDX-License-Identifier: MIT
#include "frames/scene_run.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

namespace cairn::frames {
namespace {

using Pair = std::tuple<std::uint64_t, std::uint64_t, int>;  // two ids, rows

std::set<Pair> PairsOf(const bench::ContactFrame& frame) {
  const auto id = [&](int body) { return body == kWorld ? 0 : frame.bodies[body].id; };
  std::map<std::pair<std::uint64_t, std::uint64_t>, int> rows;
  for (const Row& row : frame.rows) ++rows[std::minmax({id(row.body_a), id(row.body_b)})];
  std::set<Pair> pairs;
  for (const auto& [bodies, count] : rows) pairs.emplace(bodies.first, bodies.second, count);
  return pairs;
}

}  // namespace

SceneChoice ParseScene(const std::string& text) {
  SceneChoice choice;
  const size_t end = text.find_first_of(":@");
  choice.name = text.substr(0, end);
  if (bench::FindScene(choice.name) == nullptr) {
    throw std::invalid_argument("no scene is called '" + choice.name + "'");
  }
  for (size_t at = end; at < text.size();) {
    int* const number = text[at] == ':' ? &choice.size : &choice.frame;
    const auto [rest, error] =
        std::from_chars(text.data() + at + 1, text.data() + text.size(), *number);
    at = static_cast<size_t>(rest - text.data());
    const bool goes_on = at == text.size() || text[at] == ':' || text[at] == '@';
    if (error != std::errc{} || *number < 0 || !goes_on) {
      throw std::invalid_argument("'" + text + "' is not NAME, NAME:SIZE or NAME@FRAME");
    }
  }
  return choice;
}

SceneRun::SceneRun(const SceneChoice& choice)
    : recorder_(std::make_unique<bench::RowRecorder>()),
      world_(std::make_unique<bench::World>(recorder_.get())),
      scene_(bench::Make(*bench::FindScene(choice.name))) {
  scene_->Build(world_.get(), {.size = choice.size});
  // islands would be solved in several groups, where the adapter makes one problem of all
  world_->solver_info().m_minimumSolverBatchSize = std::numeric_limits<int>::max();
}

SceneRun::~SceneRun() = default;

void SceneRun::Step() {
  scene_->BeforeStep(world_.get(), frame_++);
  world_->Step();
}

void SceneRun::Skip(int frames) {
  for (int i = 0; i < frames; ++i) Step();
}

bench::ContactFrame SceneRun::Next() {
  bench::ContactFrame frame;
  recorder_->RecordTo(&frame);
  Step();
  recorder_->RecordTo(nullptr);
  if (frame.rows.empty()) throw std::runtime_error("nothing touches in this frame");
  return frame;
}

int ChangedPairs(const bench::ContactFrame& a, const bench::ContactFrame& b) {
  const std::set<Pair> of_a = PairsOf(a), of_b = PairsOf(b);
  std::vector<Pair> changed;
  std::set_symmetric_difference(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                                std::back_inserter(changed));
  return static_cast<int>(changed.size());
}

}  // namespace cairn::frames
