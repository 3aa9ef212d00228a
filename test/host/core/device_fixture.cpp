// SPDX-License-Identifier: Apache-2.0
#include "test/host/core/device_fixture.hpp"

#include <algorithm>

#include "coupler/map/functions.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/modbus/server.hpp"

namespace coupler::host::test {

TimedDevice::~TimedDevice() = default;

Result<modbus::Bytes> TimedDevice::exchange(modbus::Bytes pdu) {
  const auto request = modbus::parse_request(pdu);
  const auto* read = request ? std::get_if<modbus::Read>(&*request) : nullptr;
  if (read == nullptr || holds_bits(table_of(read->function))) return FakeDevice::exchange(pdu);
  clock_.advance(reply_time);
  if (is_mute && read->range.start() < identity::reserved.start()) {
    requests.emplace_back("unanswered");
    return fail(Timeout{std::chrono::milliseconds(3000)});
  }
  return FakeDevice::exchange(pdu);
}

Result<modbus::Bytes> TimedDevice::receive_pdu() {
  clock_.advance(reply_time);
  return FakeDevice::receive_pdu();
}

DeviceTest::DeviceTest() = default;
DeviceTest::~DeviceTest() = default;

void DeviceTest::start(const MapBuilder& builder, Verify verify) {
  owned = builder.build();
  device.now = [this] { return clock.now(); };
  const Map& map = owned->map();
  sink.emplace(map);
  const auto load = [this](std::string_view, std::string_view) { return LoadResult{served, {}}; };
  engine.emplace(map, verify, load, device, clock, *sink);
}

void DeviceTest::serve(const MapBuilder& builder) {
  served = builder.build();
  device.serve(served->map());
}

void DeviceTest::run_for(Duration duration) {
  const Time end = clock.now() + duration;
  while (clock.now() < end) {
    const Time due = engine->step();
    clock.sleep_until(std::min({due, device.answers_wait_at(), end}));
    if (due > clock.now() && device.answers_wait_at() <= clock.now()) engine->arrived();
  }
}

void DeviceTest::push(std::string_view point, std::uint16_t value, WriteListener* listener) {
  Write write;
  write.point = static_cast<std::uint32_t>(find(owned->map(), point) - owned->map().points.data());
  write.registers[0] = value;
  write.listener = listener;
  engine->push(write);
}

}  // namespace coupler::host::test
