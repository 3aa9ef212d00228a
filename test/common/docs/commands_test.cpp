// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/document.hpp"

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"

namespace coupler::docs {
namespace {

using codec::Order;
using codec::Type;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr Table hr = Table::holding_registers;

/// How mbpoll is told to read the only point of a map.
std::string mbpoll(Type type, Order order, std::uint16_t count = 1) {
  auto builder = fakes::MapBuilder();
  builder.add(hr, "level", 6, type, [&](Point& point) {
    point.format.order = order;
    point.count = count;
  });
  return mbpoll_commands(builder.build()->map()).at(0).line;
}

TEST(Commands, Mbpoll_reads_a_point_as_what_it_is_if_it_can) {
  EXPECT_EQ(mbpoll(Type::REAL, Order::ABCD), "mbpoll -m tcp -1 -0 -a 1 -p 502 -t 4:float -B -c 1 -r 6 HOST");
  EXPECT_THAT(mbpoll(Type::UDINT, Order::CDAB, 3), HasSubstr("-t 4:int -c 3 -r 6"));
  EXPECT_THAT(mbpoll(Type::INT, Order::ABCD, 2), HasSubstr("-t 4 -c 2 -r 6"));
}

TEST(Commands, Mbpoll_shows_the_registers_of_what_it_does_not_know) {
  EXPECT_THAT(mbpoll(Type::LREAL, Order::ABCD), HasSubstr("-t 4:hex -c 4 "));
  EXPECT_THAT(mbpoll(Type::REAL, Order::DCBA), HasSubstr("-t 4:hex -c 2 "));
  EXPECT_THAT(mbpoll(Type::INT, Order::BADC), HasSubstr("-t 4:hex -c 1 "));
}

TEST(Commands, An_output_is_read_where_it_reads_back) {
  auto builder = fakes::MapBuilder();
  builder.add(hr, "level", 6, Type::INT, [](Point& point) { point.read_address = 518; });
  EXPECT_THAT(mbpoll_commands(builder.build()->map()).at(0).line, HasSubstr("-r 518 "));
}

TEST(Commands, Texts_of_the_map_are_one_word_for_the_shell) {
  auto builder = fakes::MapBuilder().many(hr, 0, 1);
  builder.head().connection.address = "a; rm -rf 'x'";
  const auto map = builder.build();
  EXPECT_THAT(mbpoll_commands(map->map()).at(0).line, HasSubstr(R"( 'a; rm -rf '\''x'\''')"));
  EXPECT_THAT(ros_commands(map->map(), "my map.yaml").at(0).line, HasSubstr("--map 'my map.yaml'"));
}

TEST(Commands, Ros_writes_the_first_point_that_takes_one_value) {
  auto builder = fakes::MapBuilder("cell");
  builder.many(hr, 0, 1);  // a WORD: an array of bits
  builder.add(hr, "speed", 4, Type::INT);
  std::vector<std::string> lines;
  for (const Command& command : ros_commands(builder.build()->map(), "cell.yaml"))
    lines.push_back(command.line);
  EXPECT_THAT(lines,
              ElementsAre("coupler_driver --map cell.yaml", "ros2 topic echo /cell/holding_registers_0",
                          "rostopic echo /cell/holding_registers_0",
                          "ros2 topic pub --once /cell/speed/write std_msgs/msg/Int16 '{data: 1}'",
                          "rostopic pub --once /cell/speed/write std_msgs/Int16 1"));
}

}  // namespace
}  // namespace coupler::docs
