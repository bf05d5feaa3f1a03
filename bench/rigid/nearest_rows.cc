// SPDX-License-Identifier: MIT
#include "rigid/nearest_rows.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace cairn::bench {
namespace {

/// Contacts of each body that can move, in the order of the frame.
std::vector<std::vector<int>> ContactsOfBodies(const ContactFrame& frame) {
  std::vector<std::vector<int>> contacts(frame.bodies.size());
  for (int i = 0; i < static_cast<int>(frame.rows.size()); ++i) {
    const Row& row = frame.rows[i];
    if (row.parent != kNoRow || row.lo != 0 || row.hi != kInfinity) continue;
    for (const int body : {row.body_a, row.body_b}) {
      if (body != kWorld && frame.bodies[body].inv_mass > 0) contacts[body].push_back(i);
    }
  }
  return contacts;
}

/// Bodies with contacts, the heaviest first.
std::vector<int> TouchedBodies(const ContactFrame& frame,
                               const std::vector<std::vector<int>>& contacts) {
  std::vector<int> touched;
  for (int i = 0; i < static_cast<int>(frame.bodies.size()); ++i) {
    if (!contacts[i].empty()) touched.push_back(i);
  }
  std::stable_sort(touched.begin(), touched.end(), [&](int a, int b) {
    return frame.bodies[a].inv_mass < frame.bodies[b].inv_mass;
  });
  return touched;
}

/// All contacts, in the order in which walks from body to body reach them.
std::vector<int> Walk(const ContactFrame& frame) {
  const std::vector<std::vector<int>> contacts = ContactsOfBodies(frame);
  std::vector<bool> queued(frame.bodies.size()), taken(frame.rows.size());
  std::vector<int> queue, order;
  const auto enqueue = [&](int body) {
    if (body == kWorld || contacts[body].empty() || queued[body]) return;
    queued[body] = true;
    queue.push_back(body);
  };
  size_t head = 0;
  for (const int start : TouchedBodies(frame, contacts)) {
    enqueue(start);
    for (; head < queue.size(); ++head) {
      for (const int contact : contacts[queue[head]]) {
        if (taken[contact]) continue;
        taken[contact] = true;
        order.push_back(contact);
        enqueue(frame.rows[contact].body_a);
        enqueue(frame.rows[contact].body_b);
      }
    }
  }
  return order;
}

/// The first `count` of `from`.
std::vector<int> First(const std::vector<int>& from, int count, const char* kind) {
  if (static_cast<int>(from.size()) < count) {
    throw std::runtime_error("frame has " + std::to_string(from.size()) + " " + kind + ", not " +
                             std::to_string(count));
  }
  return {from.begin(), from.begin() + count};
}

}  // namespace

ContactFrame NearestRows(const ContactFrame& frame, const RowCount& wanted) {
  const std::vector<int> contacts = First(Walk(frame), wanted.contacts, "contacts");
  std::vector<std::vector<int>> frictions_of(frame.rows.size());
  for (int i = 0; i < static_cast<int>(frame.rows.size()); ++i) {
    if (frame.rows[i].parent != kNoRow) frictions_of[frame.rows[i].parent].push_back(i);
  }

  std::vector<int> frictions;
  for (const int contact : contacts) {
    frictions.insert(frictions.end(), frictions_of[contact].begin(), frictions_of[contact].end());
  }
  frictions = First(frictions, wanted.frictions, "friction rows");

  ContactFrame part{.bodies = frame.bodies, .rows = {}, .impulses = {}};
  std::vector<int> new_place(frame.rows.size(), kNoRow);
  for (const std::vector<int>& rows : {contacts, frictions}) {
    for (const int i : rows) {
      new_place[i] = static_cast<int>(part.rows.size());
      Row row = frame.rows[i];
      if (row.parent != kNoRow) row.parent = new_place[row.parent];
      part.rows.push_back(row);
      part.impulses.push_back(frame.impulses[i]);
    }
  }
  return part;
}

}  // namespace cairn::bench
