// SPDX-License-Identifier: Apache-2.0
// Whatever is done to a map, an address once given stays where it is and becomes nobody else's.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <random>

#include <fmt/format.h>

#include "coupler/map/lock/lock.hpp"
#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

/// A map that is edited at random: 200 edits a seed.
class EditedMap {
 public:
  explicit EditedMap(unsigned seed) : random_(seed) {}

  void edit() {
    switch (points_.empty() ? 0 : below(6)) {
      case 0:
      case 1: points_.push_back({"p" + std::to_string(below(60)), pick(), explicit_address()}); break;
      case 2: points_.erase(points_.begin() + below(points_.size())); break;
      case 3: any().kind = pick(); break;
      case 4: any().address = explicit_address(); break;
      default: std::shuffle(points_.begin(), points_.end(), random_); break;
    }
    // A name is once in a map: the youngest stays.
    std::map<std::string, Drawn> by_name;
    for (const Drawn& point : points_) by_name.insert_or_assign(point.name, point);
    points_.erase(std::remove_if(points_.begin(), points_.end(),
                                 [&](const Drawn& point) { return by_name.erase(point.name) == 0; }),
                  points_.end());
  }

  void remove(std::string_view name) {
    points_.erase(
        std::remove_if(points_.begin(), points_.end(), [&](const Drawn& p) { return p.name == name; }),
        points_.end());
  }

  std::string text() const {
    std::string tables[2];
    for (const Drawn& point : points_) {
      const std::string address = point.address.empty() ? "" : "address: " + point.address + ", ";
      tables[point.kind.table] += "    " + point.name + ": {" + address + point.kind.options + "}\n";
    }
    std::string text =
        "name: m\nreserve:\n  - {table: coils, from: 5, to: 11}\n"
        "  - {table: holding_registers, from: 7, to: 9}\nmapping:\n";
    if (!tables[0].empty()) text += "  coils:\n" + tables[0];
    if (!tables[1].empty()) text += "  holding_registers:\n" + tables[1];
    return tables[0].empty() && tables[1].empty() ? text + "  {}\n" : text;
  }

 private:
  struct Kind {
    std::size_t table;
    std::string options;
  };
  struct Drawn {
    std::string name;
    Kind kind;
    std::string address;
  };

  std::size_t below(std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_);
  }
  Drawn& any() { return points_[below(points_.size())]; }
  /// Mostly none. They are far from what is allocated, and may overlap each other.
  std::string explicit_address() { return below(8) == 0 ? std::to_string(1000 + 4 * below(200)) : ""; }

  Kind pick() {
    static const std::vector<Kind> kinds{{0, ""},
                                         {0, "count: 3"},
                                         {1, "type: INT"},
                                         {1, "type: DINT"},
                                         {1, "type: LREAL"},
                                         {1, "type: REAL, count: 3"},
                                         {1, "type: BOOL"},
                                         {1, "type: SINT"},
                                         {1, "type: BOOL, bit: 3"},
                                         {1, "type: USINT, offset: low"},
                                         {1, "type: STRING, length: 7"}};
    return kinds[below(kinds.size())];
  }

  std::mt19937 random_;
  std::vector<Drawn> points_;
};

/// The name in "'name' …".
std::string named_in(const Diagnostic& problem) {
  return problem.what.substr(1, problem.what.find('\'', 1) - 1);
}

lock::Lock parsed(const std::string& text) {
  lock::Parsed result = lock::parse(text, "m.lock");
  EXPECT_EQ(test::text_of(result.diagnostics), "");  // this also says that no two places overlap
  return std::move(result.lock);
}

LoadResult load(const std::string& text, const std::string& lock, LockUse use) {
  return load_map_with_lock(text, "m", {"m.lock", lock, use});
}

/// What moved from one lock to the next; empty: nothing.
std::string moved(const lock::Lock& before, const lock::Lock& after) {
  const lock::Names names(after);
  for (const lock::Entry& entry : before) {
    const lock::Entry* now = names.find(entry.place.table, entry.name);
    if (now == nullptr || !(now->place == entry.place)) return entry.name;
  }
  return {};
}

bool is_reserved(const Point& point) {
  const bool coils = point.table == Table::coils;
  return range(point).overlaps(coils ? modbus::Range::of(5, 7) : modbus::Range::of(7, 3));
}

bool stands_in(const Point& point, const lock::Entry& entry) {
  const unsigned mask = holds_bits(point.table) ? lock::whole : codec::mask(point.format);
  return !entry.retired && range(point).start() == entry.place.range.start() &&
         entry.place.range.contains(range(point)) && (mask & entry.place.mask) == mask;
}

/// A point that is not where the lock says; empty: there is none.
std::string misplaced(const Map& map, const lock::Lock& lock) {
  const lock::Names names(lock);
  for (const Point& point : map.points) {
    if (point.address >= 1000) continue;
    const lock::Entry* entry = names.find(point.table, point.name);
    if (entry == nullptr || !stands_in(point, *entry) || is_reserved(point)) return std::string(point.name);
  }
  return {};
}

/// The new lock, which is `lock` if nothing changed.
std::string expect_kept(const std::string& text, const LoadResult& result, const std::string& lock) {
  std::string now = result.lock.text.empty() ? lock : result.lock.text;
  const lock::Lock after = parsed(now);
  EXPECT_EQ(moved(parsed(lock), after), "");
  EXPECT_EQ(misplaced(result.map->map(), after), "");
  const LoadResult exact = load(text, now, LockUse::exact);
  const LoadResult served = load_map(result.map->map().text, "m");
  EXPECT_TRUE(exact.map && served.map)
      << test::text_of(exact.diagnostics) << test::text_of(served.diagnostics);
  if (exact.map && served.map) {
    EXPECT_EQ(served.map->map().fingerprint, exact.map->map().fingerprint);
  }
  return now;
}

/// The number of edits after which the map was good.
int run(unsigned seed) {
  EditedMap map(seed);
  std::string lock = "coupler lock 1\n";
  int good = 0;
  for (int edits = 0; edits < 200 && !testing::Test::HasFailure(); ++edits) {
    map.edit();
    const std::string text = map.text();
    SCOPED_TRACE(fmt::format("seed {}, edit {}\n{}{}", seed, edits, text, lock));
    const LoadResult result = load(text, lock, LockUse::renew);
    if (result.map) {
      lock = expect_kept(text, result, lock);
      ++good;
      continue;
    }
    // Outgrown, or addresses of the file that overlap: told, never mended by moving.
    EXPECT_TRUE(result.lock.text.empty());
    for (const Diagnostic& problem : result.diagnostics)
      if (problem.severity == Diagnostic::Severity::error) map.remove(named_in(problem));
  }
  return good;
}

/// A test for each seed, since all of them take a minute under ThreadSanitizer.
class PlacementPropertyOfSeed : public testing::TestWithParam<unsigned> {};

TEST_P(PlacementPropertyOfSeed, No_edit_moves_an_address_or_gives_it_to_another_point) {
  EXPECT_GT(run(GetParam()), 100);
}

INSTANTIATE_TEST_SUITE_P(, PlacementPropertyOfSeed, testing::Range(1U, 11U));

TEST(PlacementProperty, Ten_thousand_points_get_their_addresses_fast) {
  std::string text = "name: m\nmapping:\n  holding_registers:\n";
  for (const char* type : {"INT", "DINT", "SINT", "BOOL", "LREAL"})
    for (int i = 0; i < 2000; ++i)
      text += "    " + std::string(type) + std::to_string(i) + ": {type: " + type + "}\n";
  const auto begin = std::chrono::steady_clock::now();
  const LoadResult first = load(text, "coupler lock 1\n", LockUse::renew);
  const auto middle = std::chrono::steady_clock::now();
  const LoadResult second = load(text, first.lock.text, LockUse::exact);
  const auto end = std::chrono::steady_clock::now();
  ASSERT_NE(first.map, nullptr);
  ASSERT_NE(second.map, nullptr);
  const LoadResult served = load_map(first.map->map().text, "m");
  const auto told = std::chrono::steady_clock::now();
  ASSERT_NE(served.map, nullptr);
  const auto ms = [](auto time) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(time).count();
  };
  std::printf(
      "10,000 points: %lld ms to read and allocate, %lld ms with a lock, %lld ms with their addresses\n",
      static_cast<long long>(ms(middle - begin)), static_cast<long long>(ms(end - middle)),
      static_cast<long long>(ms(told - end)));
  EXPECT_EQ(first.map->map().fingerprint, second.map->map().fingerprint);
}

}  // namespace
}  // namespace coupler
