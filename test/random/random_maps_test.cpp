// SPDX-License-Identifier: Apache-2.0
// Random maps: what is written at one end is read at the other, bit for bit, whether the ends were generated
// or read the map when they began.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <thread>

#include "coupler/map/loader/load.hpp"
#include "coupler/test_vectors/cases.hpp"
#include "test/generate/same_map.hpp"
#include "test/random/node_end.hpp"
#include "test/random/subject.hpp"

namespace coupler::random {
namespace {

using namespace std::chrono_literals;
using test_vectors::Case;

constexpr auto soon = 120s;  // tells hanging from working: 8 of them run at a time

std::string file_of(const Subject& subject) {
  const char* folder = std::getenv("RANDOM_MAPS");
  return (folder == nullptr ? std::string() : std::string(folder) + "/") + subject.name + ".yaml";
}

MapPtr load(const Subject& subject) { return load_map_file(file_of(subject)).map; }

/// The node's end: generated tables and hooks, or a loaded map.
struct Node {
  Node(const Subject& subject, const Map* loaded)
      : firmware(loaded == nullptr ? subject.firmware() : nullptr),
        end(loaded == nullptr ? *subject.map : *loaded, firmware ? &firmware->hooks() : nullptr) {}

  /// Makes the point have the value that a case says, as a firmware does, or where none is, as hardware does.
  void show(std::uint32_t index, const Point& point, const Case& shown) {
    if (firmware && !shown.only_read)
      EXPECT_TRUE(firmware->put(index, shown.values));
    else
      end.put(point, shown.raw);
  }

  std::unique_ptr<FirmwareEnd> firmware;
  NodeEnd end;
};

std::unique_ptr<ClientEnd> client_of(const Subject& subject, const Map* loaded, std::uint16_t port) {
  client::Options options;
  options.address = "127.0.0.1";
  options.port = port;
  if (loaded == nullptr) return subject.client(std::move(options));
  return std::make_unique<RunTimeClient>(*loaded, std::move(options));
}

/// The two ends of one map, and its vectors.
class Ends {
 public:
  /// A loaded map where the end is no generated one.
  Ends(const Subject& subject, const Map* of_client, const Map* of_node)
      : map_(*subject.map),
        node_(subject, of_node),
        client_(client_of(subject, of_client, node_.end.port())) {
    for (const Point& point : map_.points) {
      vectors_.push_back(test_vectors::cases_of(point));
      rounds_ = std::max(rounds_, vectors_.back().cases.size());
    }
  }

  void exchange() {
    client_->session().connect();
    ASSERT_TRUE(client_->session().wait_online(soon));
    for (std::size_t round = 0; round < rounds_ && !failed(); ++round) write(round);
    for (std::size_t round = 0; round < rounds_ && !failed(); ++round) read(round);
    if (failed()) return;
    refuse();
    for (std::size_t round = 0; round < 2; ++round) write(round);  // what the firmware set is no obstacle
  }

 private:
  /// One failure is enough: to wait for values that do not come takes long.
  static bool failed() { return ::testing::Test::HasFailure(); }

  const Case& pick(std::uint32_t point, std::size_t round) const {
    return random::pick(vectors_[point], point, round);
  }

  /// Every point at once, so that those that share registers or requests meet.
  void write(std::size_t round) {
    std::vector<client::PendingWrite> pending(map_.points.size());
    for (std::uint32_t i = 0; i < pending.size(); ++i)
      if (is_sent(i, round)) pending[i] = client_->set(i, pick(i, round).values);
    for (std::uint32_t i = 0; i < pending.size(); ++i) {
      if (!pending[i].valid()) continue;
      const client::SetResult result = pending[i].get();
      EXPECT_TRUE(result) << map_.points[i].name << " " << result.text;
    }
    for (std::uint32_t i = 0; i < pending.size(); ++i)
      if (is_sent(i, round)) arrived(map_.points[i], i, pick(i, round));
  }
  bool is_sent(std::uint32_t point, std::size_t round) const {
    return is_settable(map_.points[point]) && !pick(point, round).only_read;
  }
  void arrived(const Point& point, std::uint32_t index, const Case& sent) {
    EXPECT_EQ(node_.end.raw(point), sent.raw) << point.name << ": " << to_string(sent.values);
    if (!node_.firmware || !is_hooked_output(point)) return;
    // What shares its register is told of changes only.
    const auto told = node_.firmware->last(index);
    EXPECT_TRUE(told ? same_bits(*told, sent.values) : is_partial(point))
        << point.name << ": the firmware got " << (told ? to_string(*told) : "nothing") << " for "
        << to_string(sent.values);
  }

  void read(std::size_t round) {
    for (std::uint32_t i = 0; i < map_.points.size(); ++i)
      if (node_.end.is_shown(map_.points[i])) node_.show(i, map_.points[i], pick(i, round));
    for (std::uint32_t i = 0; i < map_.points.size(); ++i)
      if (node_.end.is_shown(map_.points[i])) comes(i, pick(i, round));
  }
  void comes(std::uint32_t point, const Case& shown) {
    std::optional<Values> got;
    for (const auto end = std::chrono::steady_clock::now() + soon; std::chrono::steady_clock::now() < end;) {
      got = client_->get(point);
      if (got && same_bits(*got, shown.values)) return;
      std::this_thread::sleep_for(1ms);
    }
    ADD_FAILURE() << map_.points[point].name << ": the client has " << (got ? to_string(*got) : "nothing")
                  << ", not " << to_string(shown.values);
  }

  void refuse() {
    for (std::uint32_t i = 0; i < map_.points.size(); ++i) {
      const Point& point = map_.points[i];
      if (!point.scale.present() && point.format.type != codec::Type::STRING)
        continue;  // its type has no more
      for (const codec::Value& value : vectors_[i].refused)
        EXPECT_EQ(client_->set(i, Values(point.count, value)).get().outcome,
                  client::SetResult::Outcome::refused)
            << point.name << ": " << codec::to_string(value);
    }
  }

  const Map& map_;
  Node node_;
  std::unique_ptr<ClientEnd> client_;
  std::vector<test_vectors::Cases> vectors_;
  std::size_t rounds_ = 0;
};

class RandomMaps : public ::testing::TestWithParam<Subject> {};

TEST_P(RandomMaps, The_table_is_the_map_that_the_loader_reads) {
  const MapPtr loaded = load(GetParam());
  ASSERT_TRUE(loaded) << file_of(GetParam());
  testing::expect_same(*GetParam().map, loaded->map());
}

TEST_P(RandomMaps, What_is_written_at_one_end_is_read_at_the_other) {
  const Subject& subject = GetParam();
  const MapPtr loaded = load(subject);
  ASSERT_TRUE(loaded) << file_of(subject);
  constexpr const Map* generated = nullptr;
  const Map* const at_run_time = &loaded->map();
  const struct {
    const char* name;
    const Map* client;
    const Map* node;
  } pairs[] = {{"generated client, generated node", generated, generated},
               {"generated client, run-time node", generated, at_run_time},
               {"run-time client, generated node", at_run_time, generated},
               {"run-time client, run-time node", at_run_time, at_run_time}};
  for (const auto& pair : pairs) {
    SCOPED_TRACE(file_of(subject) + ": " + pair.name);
    Ends(subject, pair.client, pair.node).exchange();
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, RandomMaps, ::testing::ValuesIn(subjects()),
                         [](const auto& tested) { return tested.param.name; });

/// So that a change of the random maps does not take away what they prove.
TEST(AllRandomMaps, Have_every_type_in_every_order) {
  std::set<std::pair<codec::Type, codec::Order>> formats;
  std::set<std::pair<Table, Access>> accesses;
  bool array = false;
  bool scale = false;
  bool line = false;
  bool counter = false;
  bool latched = false;
  for (const Subject& subject : subjects())
    for (const Point& point : subject.map->points) {
      formats.emplace(point.format.type, point.format.order);
      accesses.emplace(point.table, point.access);
      array |= point.count > 1;
      scale |= point.scale.present();
      line |= point.line.present();
      counter |= point.counter.present();
      latched |= point.latched.present();
    }
  using codec::Type;
  for (auto type = Type::BOOL; type <= Type::STRING; type = static_cast<Type>(static_cast<int>(type) + 1)) {
    const unsigned orders = codec::width(type) > 16 ? 4 : 2;
    for (unsigned i = 0; i < orders; ++i) {
      const codec::Order order = codec::make_order(i > 1, i % 2 == 1);
      EXPECT_EQ(formats.count({type, order}), 1U)
          << codec::to_string(type) << " " << codec::to_string(order, orders == 2);
    }
  }
  EXPECT_EQ(accesses.size(), 6U);  // inputs are read; outputs are written, read back, or only written
  EXPECT_TRUE(array && scale && line && counter && latched);
}

}  // namespace
}  // namespace coupler::random
