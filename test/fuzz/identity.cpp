// SPDX-License-Identifier: Apache-2.0
// What a driver believes of a device that claims to be a node. The input is the device's answers: the
// identity area, then replies to FC 20, each a byte with its size (255: a right reply around the bytes that
// follow) and its PDU.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "coupler/host/core/node_map.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/modbus/server.hpp"
#include "test/fuzz/require.hpp"
#include "test/host/core/share.hpp"

namespace coupler::fuzz {
namespace {

using host::Result;
using modbus::Bytes;

/// A device that answers with the input, and is gone when that ends.
class Impostor : public host::Channel {
 public:
  explicit Impostor(Bytes answers) : answers_(answers) {}

  Result<> open(const host::Event&) override { return {}; }
  void close() override {}
  void hang_up() override {}
  Result<> select(std::uint8_t, std::chrono::milliseconds) override { return {}; }
  Result<> send(Bytes request) override {
    std::copy(request.begin(), request.end(), request_.begin());
    size_ = request.size();
    return {};
  }
  Result<Bytes> receive() override {
    const Bytes request = Bytes(request_).first(size_);
    const auto parsed = modbus::parse_request(request);
    require(parsed.has_value(), "the driver asks for what there can be");
    if (const auto* read = std::get_if<modbus::Read>(&*parsed)) return area(*read);
    const auto* groups = std::get_if<modbus::FileGroups>(&*parsed);
    require(groups != nullptr && groups->size() == 1, "the driver only reads the area and the file");
    const auto registers = (*groups)[0].registers;
    const Bytes size = take(1);
    if (size.empty()) return host::fail(host::NotConnected{});
    const bool right = size[0] == 255;
    const Bytes reply = right ? reply_around(take(std::size_t{2} * registers), registers) : take(size[0]);
    std::array<std::uint16_t, modbus::max_file_registers> taken{};
    require(!right || modbus::parse_file_reply(reply, Span<std::uint16_t>(taken).first(registers)),
            "a right reply is taken");
    return answer(reply);
  }
  host::Woken wait_until(host::Time, host::Wakeup&, const host::Event&) override {
    return host::Woken::by_time;
  }

 private:
  /// At most so many of the bytes that are left.
  Bytes take(std::size_t size) {
    const Bytes taken = answers_.first(std::min(size, answers_.size()));
    answers_ = answers_.from(taken.size());
    return taken;
  }

  Bytes reply_around(Bytes data, std::size_t registers) {
    modbus::FileReply reply(pdu_);
    const auto place = reply.add(static_cast<std::uint16_t>(registers));
    std::fill(std::copy(data.begin(), data.end(), place.begin()), place.end(), std::uint8_t{0});
    return Bytes(pdu_.data(), reply.size());
  }

  Result<Bytes> area(const modbus::Read& read) {
    std::array<std::uint16_t, modbus::max_read_registers> registers{};
    const Bytes bytes = take(2 * read.range.count());
    for (std::size_t i = 0; i < bytes.size() / 2; ++i) registers[i] = modbus::get_u16(&bytes[2 * i]);
    const auto all = Span<const std::uint16_t>(registers).first(read.range.count());
    return answer(Bytes(pdu_.data(), modbus::reply_registers(read.function, all, pdu_)));
  }
  Result<Bytes> answer(Bytes reply) const {
    if (answers_.empty()) return host::fail(host::NotConnected{});
    return reply;
  }

  Bytes answers_;
  std::array<std::uint8_t, modbus::max_pdu_size> request_{};
  std::size_t size_ = 0;
  std::array<std::uint8_t, modbus::max_pdu_size> pdu_{};
};

void check_head(const identity::Head& head) {
  std::array<std::uint16_t, identity::head_size> area{};
  identity::write_head(head, area.data());
  const auto again = identity::read_head(area);
  require(again && again->fingerprint == head.fingerprint && again->map_size == head.map_size &&
              again->map_crc == head.map_crc,
          "what is read is what is written");
}

}  // namespace
}  // namespace coupler::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace coupler;
  fuzz::Impostor device(modbus::Bytes(data, size));
  host::Link link(host::test::share(device), {}, {});
  fuzz::require(link.connect().has_value(), "a device is there");
  const auto head = host::read_identity(link);
  if (!head || !*head) return 0;
  fuzz::check_head(**head);
  const auto text = host::fetch_map_text(link, (*head)->map_size);
  fuzz::require(!text || text->size() == (*head)->map_size, "the text is as long as the device said");
  const auto further = host::read_further(link);
  for (const char c : further ? host::to_string(further->machine) : std::string())
    fuzz::require(c >= ' ' && c <= '~', "what is told of a machine is printable ASCII");
  return 0;
}
