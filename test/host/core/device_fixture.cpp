// SPDX-License-Identifier: Apache-2.0
#include "test/host/core/device_fixture.hpp"

#include <algorithm>
#include <atomic>
#include <new>
#include <thread>
#include <utility>

#include "coupler/map/functions.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/modbus/server.hpp"
#include "test/host/core/failing_heap.hpp"

namespace coupler::host::test {

TimedDevice::~TimedDevice() = default;

Result<modbus::Bytes> TimedDevice::receive() {
  const auto parsed = modbus::parse_request(request());
  const auto* read = parsed ? std::get_if<modbus::Read>(&*parsed) : nullptr;
  const bool is_short = read != nullptr ? holds_bits(table_of(read->function))
                                        : parsed && std::holds_alternative<modbus::FileGroups>(*parsed);
  if (!is_short) clock_.advance(reply_time);
  if (is_mute && read != nullptr && !is_short && read->range.start() < identity::reserved.start()) {
    requests.emplace_back("unanswered");
    return fail(Timeout{std::chrono::milliseconds(3000)});
  }
  return FakeDevice::receive();
}

DeviceTest::DeviceTest() = default;
DeviceTest::~DeviceTest() = default;

void DeviceTest::start(const MapBuilder& builder, Verify verify) {
  owned = builder.build();
  device.now = [this] { return clock.now(); };
  make_sink();
  make_engine(verify, [this](std::string_view, std::string_view) { return LoadResult{served, {}}; });
}

void DeviceTest::make_sink() {
  table.emplace(owned->map());
  sink.emplace(owned->map(), *table);
}

void DeviceTest::make_engine(Verify verify, MapLoader load) {
  const Map& map = owned->map();
  engine.reset();
  link.emplace(shared, map.connection, map.limits, &clock);
  engine.emplace(map, verify, std::move(load), *link, *table, *sink);
}

bool DeviceTest::is_turn_free() {
  const bool is_free = shared->turns.try_take(this);
  if (is_free) shared->turns.release();
  return is_free;
}

void DeviceTest::during_wait_for_turn(const std::function<void()>& step,
                                      const std::function<void()>& meanwhile) {
  ASSERT_TRUE(shared->turns.try_take(this));
  std::atomic<bool> is_over{false};
  std::thread other([&] {
    while (!is_over && !shared->turns.is_awaited())
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    if (!is_over) meanwhile();
    shared->turns.release();
  });
  step();
  is_over = true;
  other.join();
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

bool DeviceTest::step_without_memory(long allocations) {
  fail_allocation(allocations);
  try {
    engine->step();
    return has_failed();
  } catch (const std::bad_alloc&) {
    const bool failed = has_failed();
    engine->give_up("no memory");
    return failed;
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
