// SPDX-License-Identifier: Apache-2.0
// The node's whole engine on a stream of bytes: frames, requests, replies. The input is what a client sends.
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coupler/device/core/server.hpp"
#include "coupler/map/image_layout.hpp"
#include "test/device/core/node_under_test.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/fuzz/require.hpp"

namespace coupler::fuzz {
namespace {

using modbus::Bytes;
using modbus::Function;

constexpr std::uint16_t broken_line = 7;
constexpr std::uint32_t epoch = 1;
constexpr std::chrono::milliseconds time_between_requests{1};

/// Hardware of which one output and one input are broken.
class PartlyBrokenLines : public device::Lines {
 public:
  bool read(modbus::Range inputs, Span<std::uint16_t> levels, device::TimePoint) override {
    if (inputs.contains(broken_line)) return false;
    if (inputs.contains(0)) levels[0] = 1;
    return true;
  }
  bool drive(modbus::Range coils, Span<const std::uint16_t>) override { return !coils.contains(broken_line); }
  bool driven(modbus::Range, Span<std::uint16_t>) const override { return true; }
  bool drive_safe() override { return true; }
};

/// No two registers of it are the same: the number of each, and an odd byte at the end.
std::string map_text() {
  std::string text(20'001, '~');
  for (std::size_t i = 0; i < text.size() / 2; ++i)
    modbus::put_u16(reinterpret_cast<std::uint8_t*>(&text[2 * i]), static_cast<std::uint16_t>(i));
  return text;
}

/// The groups of a reply to FC 20 hold the text's registers that were asked for.
void check_file(Bytes request, Bytes reply) {
  std::size_t at = 2;
  for (std::size_t group = 2; group < request.size(); group += 7) {
    const std::size_t registers = modbus::get_u16(&request[group + 5]);
    require(reply.size() >= at + 2 + 2 * registers && reply[at] == 1 + 2 * registers, "a group has its size");
    std::size_t number = (modbus::get_u16(&request[group + 1]) - 1U) * modbus::records_per_file;
    number += modbus::get_u16(&request[group + 3]);
    for (std::size_t i = 0; i < registers; ++i) {
      const std::size_t expected = number + i < 10'000 ? number + i : '~' << 8U;
      require(number + i <= 10'000, "nothing is read behind the text");
      require(modbus::get_u16(&reply[at + 2 + 2 * i]) == expected, "a record holds its part of the text");
    }
    at += 2 + 2 * registers;
  }
  require(at == reply.size(), "there are as many groups as were asked for");
}

/// Points of every table, a hole, something that must not be written, and a text of more than one file.
MapPtr make_map() {
  return fakes::MapBuilder()
      .many(Table::coils, 0, 18)
      .add(Table::coils, "ejector", 18, codec::Type::BOOL,
           [](Point& point) { point.pulse = 2 * time_between_requests; })
      .many(Table::coils, 19, 1)
      .many(Table::coils, 65530, 6)
      .many(Table::discrete_inputs, 0, 20)
      .many(Table::input_registers, 0, 10)
      .many(Table::holding_registers, 0, 130)
      .add(Table::holding_registers, "constant", 140, codec::Type::DWORD,
           [](Point& point) { point.access = Access::read; })
      .text(map_text())
      .build();
}

/// A reply ADU is what the specification allows for its request.
void check_reply(const modbus::Frame& request, Bytes adu) {
  require(adu.size() >= modbus::mbap_size + 2 && adu.size() <= modbus::max_adu_size,
          "a reply has 9 … 260 bytes");
  require(modbus::get_u16(&adu[0]) == request.transaction, "the transaction id is the request's");
  require(modbus::get_u16(&adu[2]) == 0, "the protocol id is 0");
  require(modbus::get_u16(&adu[4]) == adu.size() - 6, "the length counts what follows it");
  require(adu[6] == request.unit, "the unit id is the request's");

  const Bytes pdu = adu.from(modbus::mbap_size);
  if (pdu[0] >= modbus::exception_bit) {
    require((pdu[0] | modbus::exception_bit) == (request.pdu[0] | modbus::exception_bit),
            "the function is the request's");
    require(pdu.size() == 2 && ((pdu[1] >= 1 && pdu[1] <= 4) || pdu[1] == 6),
            "an exception is 01, 02, 03, 04 or 06");
    return;
  }
  require(pdu[0] == request.pdu[0], "the function is the request's");
  switch (static_cast<Function>(pdu[0])) {
    case Function::read_coils:
    case Function::read_discrete_inputs:
      require(pdu[1] == (modbus::get_u16(&request.pdu[3]) + 7) / 8, "as many bits as were asked for");
      require(pdu.size() == std::size_t{2} + pdu[1], "the byte count is right");
      break;
    case Function::read_file_record:
      check_file(request.pdu, pdu);
      require(pdu.size() == std::size_t{2} + pdu[1], "the byte count is right");
      break;
    case Function::read_holding_registers:
    case Function::read_input_registers:
    case Function::read_write_multiple_registers:
      require(pdu[1] == 2 * modbus::get_u16(&request.pdu[3]), "as many registers as were asked for");
      require(pdu.size() == std::size_t{2} + pdu[1], "the byte count is right");
      break;
    case Function::write_multiple_coils:
    case Function::write_multiple_registers:
      require(std::equal(pdu.begin(), pdu.end(), request.pdu.begin(), request.pdu.begin() + 5),
              "a write is acknowledged with its address and quantity");
      break;
    case Function::write_single_coil:
    case Function::write_single_register:
    case Function::mask_write_register:
    case Function::diagnostics:
      require(std::equal(pdu.begin(), pdu.end(), request.pdu.begin(), request.pdu.end()),
              "a write and query data are acknowledged with the request");
      break;
    case Function::encapsulated_interface:
      require(pdu.size() >= 7 && pdu[1] == request.pdu[1] && pdu[2] == request.pdu[2],
              "an identification is of the kind that was asked for");
      break;
    case Function::schedule_output:
      require(modbus::parse_schedule_reply(pdu).has_value(), "an output that is accepted has a number");
      break;
    case Function::wait_for_changes: require(false, "what waits is not answered here");
  }
}

/// A node that lives for one stream.
class Engine {
 public:
  explicit Engine(const Map& map)
      : memory_(map),
        watchdog_(map.service.watchdog),
        links_(node_memory(map).links),
        told_(memory_.image.bits().size()),
        changes_(memory_.image, ring_, told_),
        handler_(map, lines_, {memory_.image, statistics_, watchdog_, links_, changes_, schedule_}),
        server_(map.connection.unit, handler_, statistics_) {
    handler_.tell_changes(epoch, now_);
  }

  /// Receives the stream in pieces of at most `piece` bytes, as the network may cut it, until it is at an end
  /// or no stream of frames any more.
  void receive(Bytes stream, std::size_t piece) {
    while (!stream.empty()) {
      const auto room = framer_.room();
      require(!room.empty(), "there is room for the rest of a frame");
      const std::size_t size = std::min({room.size(), stream.size(), piece});
      std::copy_n(stream.begin(), size, room.begin());
      framer_.filled(size);
      stream = stream.from(size);
      for (;;) {
        const auto outcome = framer_.next();
        if (outcome == modbus::Framer::Outcome::bad) return;
        if (outcome == modbus::Framer::Outcome::nothing) break;
        answer(framer_.frame());
      }
    }
  }

  const std::vector<std::uint8_t>& sent() const { return sent_; }
  const std::vector<std::uint16_t>& cells() const { return memory_.cells; }

 private:
  void answer(const modbus::Frame& request) {
    require(!request.pdu.empty() && request.pdu.size() <= modbus::max_pdu_size, "a PDU has 1 … 253 bytes");
    now_ += time_between_requests;
    handler_.tick(now_);  // what is scheduled for now
    const std::vector<std::uint16_t> before = memory_.cells;
    std::array<std::uint8_t, 2 * modbus::max_adu_size> adus{};
    const std::size_t waited = session_.wait ? server_.end_wait(session_, now_, adus) : 0;
    send(check_waited(waiting_, {adus.data(), waited}));
    const std::size_t size = server_.answer(request, session_, now_, adus);
    const Bytes adu(adus.data(), size);
    if (session_.wait) {
      require(size == 0, "what waits has no reply yet");
      waiting_ = {request.transaction, request.unit, {}};
      const std::size_t at_once = server_.answer_waiting(session_, now_, adus);
      send(check_waited(waiting_, {adus.data(), at_once}));
    } else if (size == 0) {
      require(request.unit >= 2 && request.unit <= 254, "only other units get silence");
    } else {
      check_reply(request, adu);
    }
    if (size == 0 || adu[modbus::mbap_size] >= modbus::exception_bit)
      require(memory_.cells == before, "what is not done leaves no trace");
    send(adu);
  }

  /// The reply to a request that waited, which may be none.
  Bytes check_waited(const modbus::Frame& request, Bytes adu) const {
    if (adu.empty()) return adu;
    require(adu.size() <= modbus::max_adu_size && modbus::get_u16(&adu[0]) == request.transaction &&
                modbus::get_u16(&adu[4]) == adu.size() - 6 && adu[6] == request.unit,
            "the header is the request's");
    const auto reply = modbus::parse_changes_reply(adu.from(modbus::mbap_size));
    require(reply.has_value(), "a reply tells of changes");
    require(reply->epoch == epoch && reply->newest == changes_.ring().newest(), "it says where the node is");
    require(!session_.wait, "it is given once");
    return adu;
  }

  void send(Bytes adu) { sent_.insert(sent_.end(), adu.begin(), adu.end()); }

  device::TimePoint now_{};
  device::OwnedImage memory_;
  PartlyBrokenLines lines_;
  device::Statistics statistics_;
  device::ClientSession session_;
  modbus::Frame waiting_{};  ///< the request that waits, without its PDU
  device::OutputWatchdog watchdog_;
  std::vector<device::EdgePoints::Link> links_;
  std::vector<device::ChangeRing::Entry> ring_{8};
  std::vector<std::uint16_t> told_;
  device::Changes changes_;
  std::vector<device::ScheduledOutput> scheduled_{4 + 1};
  device::OutputSchedule schedule_{scheduled_, &changes_, 1};
  device::Handler handler_;
  device::Server server_;
  modbus::Framer framer_;
  std::vector<std::uint8_t> sent_;
};

}  // namespace
}  // namespace coupler::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace coupler;
  static const MapPtr map = fuzz::make_map();
  const modbus::Bytes stream(data, size);
  fuzz::Engine at_once(map->map());
  at_once.receive(stream, size);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{11}}) {
    fuzz::Engine in_pieces(map->map());
    in_pieces.receive(stream, piece);
    fuzz::require(in_pieces.sent() == at_once.sent() && in_pieces.cells() == at_once.cells(),
                  "how the network cuts the stream makes no difference");
  }
  return 0;
}
