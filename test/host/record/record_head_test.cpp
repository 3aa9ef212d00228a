// SPDX-License-Identifier: Apache-2.0
// What a file of a recording begins with, as programs read it.
#include <chrono>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "coupler/map/fingerprint.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/record/reader.hpp"
#include "test/host/record/recorder_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using fakes::MapBuilder;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

/// The head of a recording of the map.
class RecordHeadTest : public test::RecorderTest {
 protected:
  record::Head head() {
    std::istringstream text(recorder_->beginning(start_ + seconds(1)));
    auto reader = record::Reader::open(text, "press.jsonl");
    EXPECT_TRUE(reader) << reader.error();
    return reader->head();
  }
};

TEST_F(RecordHeadTest, Has_the_map_without_who_may_do_what) {
  const std::string text =
      "name: press\n"
      "tls: {certificate: press.pem, key: press.key, ca: ca.pem}\n"
      "security:\n"
      "  roles: {viewer: {read: all}}\n"
      "mapping:\n"
      "  coils: {lamp: 0}\n";
  record(load_map(text, "press.yaml").map, json_format());
  EXPECT_EQ(head().map, "name: press\nmapping:\n  coils: {lamp: 0}\n");
  EXPECT_EQ(head().fingerprint, fingerprint_text(owned_->map().fingerprint));
  EXPECT_EQ(head().name, "press");
  EXPECT_EQ(head().device, "10.0.0.1:502");
  EXPECT_THAT(recorder_->beginning(start_), Not(HasSubstr("press.key")));
}

TEST_F(RecordHeadTest, Says_how_often_each_point_is_read_and_which_are_not) {
  MapBuilder map;
  map.holding("a", 0).command("reset", 0).add(Table::holding_registers, "b", 1, Type::UINT, [](Point& point) {
    point.host.rate = 50;
  });
  map.holding("c", 2).head().polling.rate = 4;
  const TableRange unreadable[] = {{Table::holding_registers, modbus::Range::of(2, 1)}};
  map.head().unreadable = unreadable;
  record(map, json_format());
  EXPECT_THAT(head().periods, testing::UnorderedElementsAre(Pair("a", 0.25), Pair("b", 0.02)));
  EXPECT_THAT(head().not_recorded,
              testing::UnorderedElementsAre(Pair("reset", "write-only"),
                                            Pair("c", "in what the map calls unreadable")));
}

TEST_F(RecordHeadTest, Names_pulses_that_are_shorter_than_two_periods) {
  const auto pulse = [](int length) {
    return [=](Point& point) { point.pulse = std::chrono::milliseconds(length); };
  };
  MapBuilder map;
  map.add(Table::coils, "short", 0, Type::BOOL, pulse(199))
      .add(Table::coils, "long", 1, Type::BOOL, pulse(200));
  map.coil("lamp", 2);
  record(map, json_format());
  EXPECT_THAT(recorder_->beginning(start_),
              HasSubstr(R"("may_miss":{"short":"pulses of 199 ms, read every 100 ms"})"));
}

TEST_F(RecordHeadTest, Stands_before_values_that_can_be_read_back) {
  record(MapBuilder().holding("a", 0).coil("lamp", 0), json_format());
  recorder_->on_online(true);
  read_registers({"a"}, 0, {5});
  read_bits({"lamp"}, 0, {1});
  std::istringstream text(recorder_->beginning(start_ + seconds(1)) + take().lines +
                          recorder_->end(start_ + seconds(2)));
  auto reader = record::Reader::open(text, "press.jsonl");
  ASSERT_TRUE(reader) << reader.error();
  std::vector<std::string> found;
  for (;;) {
    const auto line = reader->next();
    ASSERT_TRUE(line) << line.error();
    if (!*line) break;
    if (const auto* value = std::get_if<record::Value>(&(*line)->what))
      found.push_back(fmt::format("{}={}", value->point, fmt::join(value->registers, ",")));
    else
      found.emplace_back(std::holds_alternative<record::DeviceState>((*line)->what) ? "device" : "remark");
  }
  EXPECT_THAT(found, ElementsAre("device", "lamp=1", "a=5", "device", "a=5", "lamp=1", "remark"));
}

}  // namespace
}  // namespace coupler::host
