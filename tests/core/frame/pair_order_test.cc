// SPDX-License-Identifier: MIT
// The order of a sweep from call to call: sorted, and nobody moves without need.
#include "plan/pair_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

namespace cairn {
namespace {

using testing::ElementsAre;

constexpr PairKeyCounts kCounts = {.groups = 4, .colours = 10, .shapes = 6};

/// Pairs that are known by a name, as a game would have them.
class Named {
 public:
  struct Entry {
    int name;
    PairKey key;
  };

  /// The names in the order of a sweep.
  std::vector<int> Update(const std::vector<Entry>& entries) {
    std::vector<int> before;
    const std::span<PairKey> keys = order_.Begin(static_cast<int>(entries.size()));
    for (size_t i = 0; const Entry& entry : entries) {
      keys[i++] = entry.key;
      const auto known = places_.find(entry.name);
      before.push_back(known == places_.end() ? -1 : known->second);
    }
    order_.End(before, kCounts, &crew_);
    places_.clear();
    std::vector<int> names;
    for (int place : order_.order()) names.push_back(entries[place].name);
    for (size_t i = 0; i < entries.size(); ++i) places_[entries[i].name] = static_cast<int>(i);
    return names;
  }

 private:
  Crew crew_{3};
  PairOrder order_;
  std::map<int, int> places_;
};

/// So many pairs of one key, named from 0.
std::vector<Named::Entry> Alike(int count) {
  std::vector<Named::Entry> entries;
  for (int i = 0; i < count; ++i) entries.push_back({i, {.group = 0, .colour = 1, .shape = 0}});
  return entries;
}

TEST(PairOrder, SortsByGroupThenColourThenShapeThenPlace) {
  Named named;
  EXPECT_THAT(named.Update({{0, {1, 0, 0}},
                            {1, {0, 1, 0}},
                            {2, {0, 0, 1}},
                            {3, {0, 0, 0}},
                            {4, {0, 0, 1}},
                            {5, {0, 0, 0}}}),
              ElementsAre(3, 5, 2, 4, 1, 0));
}

TEST(PairOrder, PutsWhatBeginsBehindThoseOfItsKeyAndMovesNobodyElse) {
  Named named;
  std::vector<Named::Entry> entries = Alike(20);
  std::vector<int> expected = named.Update(entries);
  entries.insert(entries.begin() + 3, {100, {0, 1, 0}});
  entries.insert(entries.begin(), {101, {0, 0, 0}});
  expected.push_back(100);
  expected.insert(expected.begin(), 101);
  EXPECT_EQ(named.Update(entries), expected);
}

TEST(PairOrder, ClosesTheRanksWhereAPairEnds) {
  Named named;
  std::vector<Named::Entry> entries = Alike(20);
  std::vector<int> expected = named.Update(entries);
  // as a game does it: the last one takes the place
  entries[4] = entries.back();
  entries.pop_back();
  std::erase(expected, 4);
  EXPECT_EQ(named.Update(entries), expected);
}

TEST(PairOrder, MovesAPairThatLooksDifferentNow) {
  Named named;
  std::vector<Named::Entry> entries = Alike(20);
  std::vector<int> expected = named.Update(entries);
  entries[7].key.shape = 3;
  std::erase(expected, 7);
  expected.push_back(7);
  EXPECT_EQ(named.Update(entries), expected);
}

/// The order that few moved pairs lead to, as PairOrder says it: those that are kept stay, the
/// others go behind all of their key.
std::vector<int> Moved(const std::vector<int>& names, const std::map<int, PairKey>& keys_before,
                       const std::vector<Named::Entry>& entries) {
  std::map<int, PairKey> keys;
  for (const Named::Entry& entry : entries) keys[entry.name] = entry.key;
  const auto kept = [&](int name) {
    const auto now = keys.find(name);
    const auto before = keys_before.find(name);
    return now != keys.end() && before != keys_before.end() && now->second == before->second;
  };
  std::vector<int> order;
  for (const int name : names) {
    if (kept(name)) order.push_back(name);
  }
  for (const Named::Entry& entry : entries) {
    if (!kept(entry.name)) order.push_back(entry.name);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return keys.at(a) < keys.at(b); });
  return order;
}

TEST(PairOrder, OfManyPairsIsThatOfOneThread) {
  std::mt19937 random(3);
  const auto below = [&random](int most) { return static_cast<int>(random() % most); };
  const auto any_key = [&] { return PairKey{below(2), below(5), below(3)}; };
  Named named;
  std::vector<Named::Entry> entries;
  int next = 0;
  while (next < 30000) entries.push_back({next++, any_key()});
  std::vector<int> names = named.Update(entries);
  for (const int events : {0, 1, 100, 3000, 200, 1000}) {
    std::map<int, PairKey> keys_before;
    for (const Named::Entry& entry : entries) keys_before[entry.name] = entry.key;
    for (int event = 0; event < events; ++event) {
      const int at = below(static_cast<int>(entries.size()));
      if (event % 3 == 0) entries[at].key = any_key();
      if (event % 3 == 1) entries[at] = {next++, any_key()};
      if (event % 3 == 2) entries.erase(entries.begin() + at);
    }
    const std::vector<int> expected = Moved(names, keys_before, entries);
    names = named.Update(entries);
    EXPECT_EQ(names, expected) << events;
  }
  // none is left of a whole part
  std::map<int, PairKey> keys_before;
  for (const Named::Entry& entry : entries) keys_before[entry.name] = entry.key;
  std::erase_if(entries, [](const Named::Entry& entry) { return entry.key.group == 0; });
  entries.push_back({next++, {0, 0, 0}});
  entries.push_back({next++, {1, 9, 5}});
  EXPECT_EQ(named.Update(entries), Moved(names, keys_before, entries));
}

TEST(PairOrder, IsSortedAndWholeAfterEventsOfAllKinds) {
  std::mt19937 random(7);
  const auto below = [&random](int most) { return static_cast<int>(random() % most); };
  const auto any_key = [&] { return PairKey{below(4), below(10), below(6)}; };
  for (const int events : {0, 1, 5, 40, 300}) {
    Named named;
    std::vector<Named::Entry> entries;
    int next = 0;
    while (next < 200) entries.push_back({next++, any_key()});
    for (int call = 0; call < 50; ++call) {
      const std::vector<int> names = named.Update(entries);
      std::map<int, PairKey> keys;
      for (const Named::Entry& entry : entries) keys[entry.name] = entry.key;
      std::vector<int> once = names;
      std::sort(once.begin(), once.end());
      EXPECT_EQ(std::unique(once.begin(), once.end()), once.end());
      ASSERT_EQ(names.size(), entries.size());
      EXPECT_TRUE(std::is_sorted(names.begin(), names.end(),
                                 [&](int a, int b) { return keys.at(a) < keys.at(b); }));
      for (int event = 0; event < events; ++event) {
        const int at = below(static_cast<int>(entries.size()));
        const int kind = below(4);
        if (kind == 0) entries[at].key = any_key();
        if (kind == 1) entries.insert(entries.begin() + at, {next++, any_key()});
        if (kind == 2 && entries.size() > 10) entries.erase(entries.begin() + at);
        if (kind == 3) std::swap(entries[at], entries.back());
      }
    }
  }
}

TEST(PairOrder, OfNothingIsEmpty) {
  Named named;
  EXPECT_THAT(named.Update({}), ElementsAre());
  named.Update(Alike(3));
  EXPECT_THAT(named.Update({}), ElementsAre());
  EXPECT_THAT(named.Update(Alike(2)), ElementsAre(0, 1));
}

}  // namespace
}  // namespace cairn
