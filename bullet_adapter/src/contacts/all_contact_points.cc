// SPDX-License-Identifier: MIT
// The manifolds of a group on several threads: whom they are between, then, where nobody was new,
// their points, each part into its place.

#include "cairn/detail/prefetch.h"
#include "contacts/contact_points.h"
#include "contacts/prefetch_manifold.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

constexpr int kManifoldsOfPart = 128;
/// Groups that are read one by one after one that had to be.
constexpr int kGroupsInOrder = 32;

}  // namespace

bool ContactPoints::AppendAll(std::span<btPersistentManifold* const> manifolds, BodyTable* bodies,
                              SplitImpulse* pushes, detail::Threads* threads) {
  if (!takes_any_ || in_order_-- > 0) return false;
  in_order_ = 0;
  constexpr SpanLabel kLabel{SpanKind::kRead};
  const int count = static_cast<int>(manifolds.size());
  const int parts = (count + kManifoldsOfPart - 1) / kManifoldsOfPart;
  if (static_cast<int>(parts_.size()) < parts) parts_.resize(parts);
  const auto find = [&](int first, int of_part) {
    FindEntries(manifolds.subspan(first, of_part), *bodies, &parts_[first / kManifoldsOfPart]);
  };
  threads->For(count, kManifoldsOfPart, find, kLabel);

  // those that were met before have moved: one by one then, which happens while a world grows
  if (EnterStrangers(std::span(parts_).first(parts), bodies)) return false;
  size_t points = 0, entries = 0;
  for (Part& part : std::span(parts_).first(parts)) {
    if (part.strange) MeetStrangers(bodies, &part);
    part.first_point = static_cast<int>(points);
    part.first_manifold = static_cast<int>(entries);
    points += part.points;
    entries += part.entries.size();
  }
  MakeRoom(points);
  if (manifolds_.size() < entries) manifolds_.resize(entries);

  const auto read = [&](int first, int of_parts) {
    for (int i = first; i < first + of_parts; ++i) ReadPart(&parts_[i]);
  };
  threads->For(parts, 1, read, kLabel);
  for (const Part& part : std::span(parts_).first(parts)) {
    if (part.written_out) in_order_ = kGroupsInOrder;
  }
  if (in_order_ > 0) return false;
  manifold_count_ = entries;
  count_ = points;
  for (const Part& part : std::span(parts_).first(parts)) ReadRest(part, *bodies, pushes);
  return true;
}

void ContactPoints::FindEntries(std::span<btPersistentManifold* const> manifolds,
                                const BodyTable& bodies, Part* part) const {
  part->entries.clear();
  part->rest.clear();
  part->points = 0;
  part->strange = part->written_out = false;
  for (size_t i = 0; i < manifolds.size(); ++i) {
    PrefetchAhead(manifolds, i);
    btPersistentManifold* const manifold = manifolds[i];
    if (manifold->getNumContacts() == 0) continue;
    const Entry entry{manifold, bodies.Find(*manifold->getBody0()),
                      bodies.Find(*manifold->getBody1())};
    if (entry.a == nullptr || entry.b == nullptr) {
      part->strange = true;
    } else if (!entry.a->reacts && !entry.b->reacts) {
      continue;
    }
    part->entries.push_back(entry);
    part->points += manifold->getNumContacts();
  }
}

bool ContactPoints::EnterStrangers(std::span<const Part> parts, BodyTable* bodies) {
  const int growths = bodies->growths();
  for (const Part& part : parts) {
    if (!part.strange) continue;
    for (const Entry& entry : part.entries) {
      if (entry.a == nullptr) bodies->EndOf(*entry.manifold->getBody0());
      if (entry.b == nullptr) bodies->EndOf(*entry.manifold->getBody1());
    }
  }
  return bodies->growths() != growths;
}

void ContactPoints::MeetStrangers(BodyTable* bodies, Part* part) const {
  std::erase_if(part->entries, [&](Entry& entry) {
    if (entry.a == nullptr) entry.a = &bodies->EndOf(*entry.manifold->getBody0());
    if (entry.b == nullptr) entry.b = &bodies->EndOf(*entry.manifold->getBody1());
    if (entry.a->reacts || entry.b->reacts) return false;
    part->points -= entry.manifold->getNumContacts();
    return true;
  });
}

void ContactPoints::ReadPart(Part* part) {
  constexpr size_t kAhead = 8;
  const std::vector<Entry>& entries = part->entries;
  size_t point = part->first_point;
  for (size_t i = 0; i < entries.size(); ++i) {
    if (i + kAhead < entries.size()) {
      btPersistentManifold& near = *entries[i + kAhead].manifold;
      Prefetch(&near.getContactPoint(0), near.getNumContacts() * sizeof(btManifoldPoint));
    }
    const Entry& entry = entries[i];
    const Ends ends{*entry.a, *entry.b};
    const Features found = ReadPoints(ends, entry.manifold, point);
    // each has its place, so all of their points have to count
    if (!Takes(ends, found) || found.points != entry.manifold->getNumContacts()) {
      part->written_out = true;
      return;
    }
    const int manifold = part->first_manifold + static_cast<int>(i);
    Describe(ends, found, point, &manifolds_[manifold]);
    if (found.pushed || found.rolls) {
      part->rest.push_back({manifold, entry, found.pushed, found.rolls});
    }
    point += found.points;
  }
}

void ContactPoints::ReadRest(const Part& part, const BodyTable& bodies, SplitImpulse* pushes) {
  for (const Rest& rest : part.rest) {
    const Manifold& manifold = manifolds_[rest.manifold];
    const Ends ends{*rest.entry.a, *rest.entry.b};
    for (size_t i = manifold.first_point; i < size_t{0} + manifold.first_point + manifold.points;
         ++i) {
      if (rest.pushed) AddPush(ends, *rest.entry.manifold, *sources_[i], bodies, pushes);
      if (rest.rolls) AddTwist(i);
    }
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
