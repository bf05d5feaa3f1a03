// SPDX-License-Identifier: MIT
// What App does for a file of commands.
#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>
#include <sstream>

#include "play/view/app.h"
#include "scenes/facts.h"
#include "support/failure.h"
#include "support/output_file.h"

namespace cairn::play {
namespace {

using cli::Failure;
using cli::kUsage;
using nlohmann::json;

/// What solver and world were told, read from them.
json Applied(Player& player) {
  const bench::World& world = player.world();
  json applied = {{"solver", player.solver().name},
                  {"iterations", world.bullet()->getSolverInfo().m_numIterations},
                  {"time_step", world.time_step()},
                  {"bodies", world.dynamic_bodies().size()},
                  {"constraints", world.bullet()->getNumConstraints()},
                  {"frame", player.frame()},
                  {"hash", fmt::format("{:016x}", bench::StateHash(world))},
                  {"failure", player.failure()},
                  {"saved", player.saved()}};
  if (const Settings* const settings = player.settings()) {
    const bool timed = settings->budget.kind() == Budget::Kind::kTime;
    applied["budget_ms"] = timed ? 1e-6 * double(settings->budget.time().count()) : -1.0;
    applied["threads"] = settings->threads;
    applied["steps"] = settings->steps;
    applied["acceleration"] = settings->acceleration == Acceleration::kNncg;
    applied["max_sweeps"] = settings->max_sweeps;
  }
  if (player.history().empty()) return applied;
  const Sample& last = player.history().back();
  applied["last"] = {{"solver_ms", last.solver_ms},     {"world_ms", last.world_ms},
                     {"residual", last.residual},       {"energy", last.energy},
                     {"penetration", last.penetration}, {"joint_gap", last.joint_gap},
                     {"steps_kept", last.steps_kept},   {"steps_undone", last.steps_undone},
                     {"guarded", last.guarded},         {"asleep", last.asleep}};
  return applied;
}

}  // namespace

std::string App::State() {
  json state;
  for (const Field& field : Fields(&session_.controls())) {
    std::visit([&](const auto* value) { state["controls"][field.name] = *value; }, field.value);
  }
  for (int side = 0; side < session_.worlds(); ++side) {
    state["worlds"].push_back(Applied(session_.player(side)));
  }
  for (const auto& [name, place] : panels_->widgets()) state["widgets"].push_back(name);
  state["camera"] = {camera_.yaw, camera_.pitch, camera_.distance};
  state["picture"] = {{"number", picture_},
                      {"ms", facts_.picture_ms},
                      {"draw_ms", facts_.draw_ms},
                      {"bodies", renderer_->bodies_drawn()},
                      {"draw_calls", renderer_->calls()}};
  state["hovered"] = {{"world", facts_.side}, {"body", facts_.body}};
  state["message"] = facts_.message;
  return state.dump(1) + "\n";
}

void App::ReadCommands() {
  if (options_.commands.empty()) return;
  while (!done_) {
    if (mouse_.size() > 1 || waiting_ > 0 || last_picture_ < live_) {
      waiting_ = std::max(0, waiting_ - 1);
      return;
    }
    if (commands_.empty()) {
      done_ = options_.frames == 0;
      return;
    }
    const std::string line = commands_.front();
    commands_.pop_front();
    try {
      Command(line);
    } catch (const Failure& failure) {
      throw Failure(failure.code(),
                    fmt::format("{}: '{}': {}", options_.commands, line, failure.what()));
    }
  }
}

void App::Command(const std::string& line) {
  std::istringstream words(line);
  std::string verb, name, text;
  words >> verb >> std::ws;
  std::getline(words, text);  // all that follows: a path may have spaces
  words = std::istringstream(text);
  const auto numbers = [&words](auto*... values) {
    if (!(words >> ... >> *values)) throw Failure(kUsage, "numbers are missing");
  };
  if (verb.empty() || verb.starts_with("#")) return;
  if (verb == "set") {
    words >> name >> std::ws;
    if (!std::getline(words, text)) text.clear();
    for (const Field& field : Fields(&session_.controls())) {
      if (field.name == name) return Set(field, text);
    }
    throw Failure(kUsage, fmt::format("there is no control '{}'", name));
  } else if (verb == "preset") {
    words >> name >> text;
    if (name != "left" && name != "right") throw Failure(kUsage, "write left or right");
    UsePreset(text, name == "right", &session_.controls());
  } else if (verb == "frames") {
    numbers(&waiting_);
  } else if (verb == "restart" || verb == "step" || verb == "view" || verb == "shoot") {
    Obey({verb});
  } else if (verb == "live") {
    numbers(&live_);
    live_ += last_picture_;
  } else if (verb == "camera") {
    numbers(&camera_.yaw, &camera_.pitch, &camera_.distance);
  } else if (verb == "click") {
    const auto place = panels_->widgets().find(text);
    if (place == panels_->widgets().end()) throw Failure(kUsage, "no such widget is shown");
    const auto [x, y] = place->second;
    mouse_ = {{x, y}, {x, y, 0}, {x, y, 0}, {x, y}, {x, y}, {x, y}};  // what opens is there then
  } else if (verb == "mouse") {
    Mouse mouse;
    numbers(&mouse.x, &mouse.y);
    words >> name;
    mouse.button = name == "left" ? 0 : name == "right" ? 1 : name == "middle" ? 2 : -1;
    mouse_ = {mouse};
    waiting_ = 1;
  } else if (verb == "wheel") {
    numbers(&wheel_);
    waiting_ = 1;
  } else if (verb == "key") {
    key_ = text == "space" ? ' ' : text.size() == 1 ? std::toupper(text[0]) : 0;
    if (key_ == 0) throw Failure(kUsage, "write space or a letter");
    waiting_ = 2;  // pressed, and not any more
  } else if (verb == "save") {
    session_.Save(text);
    session_.Step();
  } else if (verb == "screenshot") {
    WritePng(text, renderer_->picture());
  } else if (verb == "state") {
    session_.Apply();
    cli::WriteFile(text, State());
  } else {
    throw Failure(kUsage, "unknown command; docs/play.md has all of them");
  }
}

}  // namespace cairn::play
