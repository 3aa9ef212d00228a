// SPDX-License-Identifier: Apache-2.0
// What is a change: which bits a node tells of, whatever made them change.
#include "coupler/device/core/changes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "coupler/map/identity.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::modbus {

void PrintTo(const Change& change, std::ostream* to) {
  *to << int{change.table} << ':' << change.address << " is " << static_cast<int>(change.kind) << " since "
      << change.at.count();
}

}  // namespace coupler::modbus

namespace coupler::device {
namespace {

using codec::Type;
using fakes::MapBuilder;
using modbus::Change;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;

/// Coils: 0 and 1 have lines (safe: off and on), 2 is memory, 3 latches rising edges of the input "button",
/// 0. Input 1 has a line as well, 2 has none.
class Told : public testing::Test {
 protected:
  static constexpr auto off = Change::Kind::off;
  static constexpr auto on = Change::Kind::on;
  static constexpr std::uint32_t epoch = 7;
  static constexpr milliseconds timeout{500};

  Told() {
    node_.lines.outputs = {{0, {0, 0}}, {1, {1, 0}}};
    node_.lines.set_input(1, 1);
    node_.handler.tell_changes(epoch, node_.now);
  }

  /// What is told since the last call.
  std::vector<Change> news() {
    node_.handler.take_news(node_.now);
    const auto reply = node_.changes.ring().reply_to({0, epoch, seen_});
    seen_ = reply.newest;
    return {reply.all().begin(), reply.all().end()};
  }
  Change coil(int address, Change::Kind kind) const { return bit(1, address, kind, node_.now); }
  static Change bit(int table, int address, Change::Kind kind, TimePoint at) {
    return {static_cast<std::uint8_t>(table), kind, static_cast<std::uint16_t>(address),
            at.time_since_epoch()};
  }
  void later() { node_.now += milliseconds(20); }

  NodeUnderTest node_{MapBuilder()
                          .many(Table::coils, 0, 3)
                          .add(Table::coils, "seen", 3, Type::BOOL,
                               [](Point& point) {
                                 point.latched = {"button", Edge::rising};
                               })
                          .add(Table::discrete_inputs, "button", 0, Type::BOOL)
                          .add(Table::discrete_inputs, "door", 1, Type::BOOL)
                          .add(Table::discrete_inputs, "set", 2, Type::BOOL)
                          .many(Table::holding_registers, 0, 2)
                          .watchdog({timeout, Watchdog::FedBy::any, Watchdog::Recovery::automatic})
                          .build()};
  std::uint64_t seen_ = 0;
};

TEST_F(Told, The_levels_at_the_start_are_no_change) { EXPECT_THAT(news(), IsEmpty()); }

TEST_F(Told, Each_edge_of_an_input_with_the_time_of_the_edge) {
  const TimePoint at = node_.now + milliseconds(3);
  later();
  node_.lines.changes = {{1, false, at}, {1, true, at + milliseconds(1)}, {0, true, at}};
  EXPECT_THAT(news(),
              ElementsAre(bit(2, 1, off, at), bit(2, 1, on, at + milliseconds(1)), bit(2, 0, on, at)));
}

TEST_F(Told, An_edge_to_the_level_that_was_told_is_no_change) {
  node_.lines.changes = {{1, true, node_.now}};
  EXPECT_THAT(news(), IsEmpty());
}

TEST_F(Told, Edges_that_were_not_seen_are_lost) {
  node_.lines.lost_changes = 4;
  EXPECT_THAT(news(), IsEmpty());
  EXPECT_EQ(node_.changes.ring().reply_to({0, epoch, 0}).lost, 4U);
}

TEST_F(Told, A_write_tells_the_bits_that_it_changed_and_no_other) {
  later();
  node_.ask(pdu(15, {0, 3}, {1, 0b101}));
  EXPECT_THAT(news(), ElementsAre(coil(0, on), coil(2, on)));
  later();
  node_.ask(pdu(15, {0, 3}, {1, 0b001}));
  EXPECT_THAT(news(), ElementsAre(coil(2, off)));
  node_.ask(pdu(5, {0, 0xFF00}));
  EXPECT_THAT(news(), IsEmpty());
}

TEST_F(Told, A_write_that_fails_changes_nothing) {
  node_.lines.broken = true;
  node_.ask(pdu(15, {0, 3}, {1, 0b101}));
  EXPECT_THAT(news(), IsEmpty());
}

TEST_F(Told, Registers_are_not_told) {
  node_.ask(pdu(6, {0, 1}));
  EXPECT_THAT(news(), IsEmpty());
}

TEST_F(Told, A_latch_that_an_edge_sets_and_a_client_clears) {
  later();
  node_.lines.edges = {{0, {1, 1, 0}}};
  EXPECT_THAT(news(), ElementsAre(coil(3, on)));
  node_.lines.edges = {{0, {1, 0, 0}}};
  EXPECT_THAT(news(), IsEmpty());
  later();
  node_.ask(pdu(5, {3, 0}));
  EXPECT_THAT(news(), ElementsAre(coil(3, off)));
}

TEST_F(Told, The_outputs_that_the_watchdog_drives_to_their_safe_state) {
  node_.ask(pdu(15, {0, 3}, {1, 0b101}));
  news();
  node_.now += timeout;
  node_.handler.tick(node_.now);
  EXPECT_THAT(news(), ElementsAre(coil(0, off), coil(1, on)));
}

TEST_F(Told, The_safe_state_at_the_end) {
  later();
  EXPECT_TRUE(node_.handler.make_safe(modbus::Reason::safe_state, node_.now));
  EXPECT_THAT(news(), ElementsAre(coil(1, on)));
}

TEST_F(Told, An_input_that_a_client_reads_before_its_edge_came_is_told_then) {
  later();
  node_.lines.set_input(1, 0);
  node_.ask(pdu(2, {0, 3}));
  const TimePoint read = node_.now;
  EXPECT_THAT(news(), ElementsAre(bit(2, 1, off, read)));
  // Its edge comes late: to the level that was told.
  node_.lines.changes = {{1, false, read}};
  EXPECT_THAT(news(), IsEmpty());
}

TEST_F(Told, An_input_whose_edge_came_while_it_was_read_has_the_time_of_the_edge) {
  class Late : public FakeLines {
   public:
    bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint now) override {
      if (edge) changes.push_back(*std::exchange(edge, std::nullopt));
      return FakeLines::read(inputs, levels, now);
    }
    std::optional<Change> edge;
  } lines;
  NodeUnderTest node(MapBuilder().many(Table::discrete_inputs, 0, 1).build());
  Changes changes(node.image, node.ring, node.told);
  Handler handler(node.map, Hardware(lines),
                  {node.image, node.statistics, node.watchdog, node.links, changes, node.schedule});
  handler.tell_changes(epoch, node.now);
  const TimePoint at = node.now + milliseconds(1);
  lines.set_input(0, 1);
  lines.edge = {0, true, at};
  Pdu reply(modbus::max_pdu_size);
  handler.handle(pdu(2, {0, 1}), node.session, at + milliseconds(1), reply);
  EXPECT_THAT(changes.ring().reply_to({0, epoch, 0}).changes[0], (bit(2, 0, on, at)));
  EXPECT_EQ(changes.ring().newest(), 1U);
}

TEST_F(Told, Nothing_before_somebody_says_so_and_the_node_does_not_know_the_function) {
  NodeUnderTest node(MapBuilder().many(Table::coils, 0, 1).build());
  const auto functions = [&] {
    return node.image.find(Table::input_registers,
                           modbus::Range::of(identity::reserved.start() + identity::at_functions, 1))[0];
  };
  Pdu request(modbus::changes_request_size);
  modbus::build_changes_request({}, request);
  EXPECT_THAT(node.ask(request), ElementsAre(0xC1, 1));
  EXPECT_EQ(functions() & identity::Functions::tells_changes_bit, 0);
  node.handler.tell_changes(epoch, node.now);
  EXPECT_THAT(node.ask(request), IsEmpty());
  EXPECT_EQ(functions() & identity::Functions::tells_changes_bit, identity::Functions::tells_changes_bit);
}

/// Sets a discrete input and a register.
struct SettingHooks : Hooks {
  void put_new_values(Image& image, Changes& changes) override {
    if (!level) return;
    const auto range = modbus::Range::of(2, 1);
    image.find(Table::discrete_inputs, range)[0] = *level;
    changes.compare(Table::discrete_inputs, range);
  }
  bool accept(std::uint32_t, const std::uint16_t*) override { return true; }
  std::optional<std::uint16_t> level;
};

/// The same node with a firmware's code.
struct ToldByFirmware : Told {
  ToldByFirmware() { handler.tell_changes(epoch, node_.now); }
  SettingHooks hooks;
  HookedPoints hooked{node_.map, node_.image, hooks};
  Changes changes{node_.image, node_.ring, node_.told};
  Handler handler{node_.map,
                  Hardware(node_.lines, nullptr, &hooked),
                  {node_.image, node_.statistics, node_.watchdog, node_.links, changes, node_.schedule}};
};

TEST_F(ToldByFirmware, A_bit_that_a_firmware_sets_with_the_time_at_which_it_is_taken) {
  hooks.level = 1;
  later();
  handler.take_news(node_.now);
  handler.take_news(node_.now + timeout);
  EXPECT_EQ(changes.ring().newest(), 1U);
  EXPECT_EQ(changes.ring().reply_to({0, epoch, 0}).changes[0], bit(2, 2, on, node_.now));
}

TEST_F(ToldByFirmware, A_bit_that_a_firmware_sets_when_edges_of_the_same_turn_are_taken) {
  ClientSession session;
  std::array<std::uint8_t, modbus::max_pdu_size> request{};
  const std::size_t size = modbus::build_changes_request({1000, epoch, 0}, request);
  std::array<std::uint8_t, modbus::max_pdu_size> reply{};
  handler.handle({request.data(), size}, session, node_.now, reply);
  handler.take_news(node_.now);
  hooks.level = 1;
  handler.tick(node_.now);
  EXPECT_EQ(changes.ring().newest(), 1U);
}

}  // namespace
}  // namespace coupler::device
