// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/device_thread.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include "coupler/host/core/write.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/core/failing_heap.hpp"
#include "test/host/core/fake_device.hpp"

namespace coupler::host {
namespace {

using fakes::MapBuilder;
using test::FakeDevice;

LoadResult no_map(std::string_view, std::string_view) { return {}; }

/// Tells when the first value and a written value arrive.
struct WaitingSink : Sink {
  std::promise<void> first;
  std::promise<void> written;
  bool seen = false;
  bool seen_written = false;
  explicit WaitingSink(const Map& map) : values(map) {}
  ValueTable values;
  void on_values(Span<const std::uint32_t> points) override {
    if (points.empty()) return;
    if (!std::exchange(seen, true)) first.set_value();
    if (*values.registers(points[0]) != 0 && !std::exchange(seen_written, true)) written.set_value();
  }
  void on_online(bool) override {}
  void on_report(Level, const std::string&) override {}
  std::promise<ScheduledOutcome> outcome;
  void on_scheduled(const ScheduledOutcome& told) override { outcome.set_value(told); }
};

TEST(DeviceThread, Values_come_and_writes_go_while_it_lives) {
  auto builder = MapBuilder().coil("a", 1);
  builder.head().polling.rate = 100;
  const auto owned = builder.build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  WaitingSink sink(owned->map());
  DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
  thread.start();
  ASSERT_EQ(sink.first.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
  Write on;
  on.registers[0] = 1;
  thread.write(on);
  EXPECT_EQ(sink.written.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
}

TEST(DeviceThread, What_is_scheduled_is_written_though_nothing_else_is_due) {
  const auto owned = MapBuilder().command("a", 1).build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  WaitingSink sink(owned->map());
  DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
  thread.start();
  ScheduledWrite what;
  what.write.registers[0] = 1;
  do what.due = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  while (thread.schedule(what).get().number == 0);  // until it is connected
  auto told = sink.outcome.get_future();
  ASSERT_EQ(told.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  const ScheduledOutcome outcome = told.get();
  EXPECT_EQ(outcome.result, ScheduledOutcome::Result::done);
  EXPECT_GE(outcome.at.at, what.due);
}

TEST(DeviceThread, What_nobody_wants_is_not_read) {
  const auto owned = MapBuilder().coil("a", 1).coil("b", 9).build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  WaitingSink sink(owned->map());
  {
    DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
    for (const std::uint32_t point : {0U, 1U}) thread.want(point, false);
    thread.start();
    thread.want(0, true);
    ASSERT_EQ(sink.first.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
  }
  EXPECT_THAT(device.requests, testing::Each(testing::AnyOf("connect", "read coils 1+1")));
}

TEST(DeviceThread, A_write_to_an_idle_device_is_sent_by_the_one_who_makes_it) {
  const auto owned = MapBuilder().command("a", 1).build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  WaitingSink sink(owned->map());
  WriteTicket ticket;
  Write write;
  write.listener = &ticket;
  {
    DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
    thread.start();
    for (;;) {  // until it is connected
      WriteTicket first;
      Write warm_up;
      warm_up.listener = &first;
      thread.write(warm_up);
      if (first.wait().outcome == WriteResult::Outcome::ok) break;
    }
    device.await_idle();
    thread.write(write);
    EXPECT_EQ(ticket.wait().outcome, WriteResult::Outcome::ok);
  }
  EXPECT_EQ(device.senders.back(), std::this_thread::get_id());
}

TEST(DeviceThread, Every_write_has_a_result_when_it_ends) {
  const auto owned = MapBuilder().coil("a", 1).build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  device.refuse_connect = NotConnected{"refused"};
  WaitingSink sink(owned->map());
  WriteTicket ticket;
  Write write;
  write.listener = &ticket;
  {
    DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
    thread.start();
    thread.write(write);
  }
  EXPECT_EQ(ticket.wait().outcome, WriteResult::Outcome::dropped);
}

/// Throws when it is told what became of a scheduled write.
struct NoOutcomes : WaitingSink {
  using WaitingSink::WaitingSink;
  void on_scheduled(const ScheduledOutcome& /*told*/) override { throw std::bad_alloc(); }
};

TEST(DeviceThread, A_call_is_answered_though_the_sink_throws_meanwhile) {
  const auto owned = MapBuilder().command("a", 1).build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  NoOutcomes sink(owned->map());
  DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
  thread.start();
  ScheduledWrite what;
  std::uint32_t number = 0;
  do {  // until it is connected
    what.due = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    number = thread.schedule(what).get().number;
  } while (number == 0);
  auto cancelled = thread.cancel_scheduled(number);
  ASSERT_EQ(cancelled.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  try {
    EXPECT_EQ(cancelled.get().text, "it may or may not be carried out: std::bad_alloc");
  } catch (const std::future_error&) {
    FAIL() << "it has no answer";
  }
}

TEST(DeviceThread, All_writes_of_a_point_are_cancelled_with_one_call) {
  const auto owned = MapBuilder().command("a", 1).build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  WaitingSink sink(owned->map());
  DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
  thread.start();
  ScheduledWrite what;
  do  // until it is connected
    what.due = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (thread.schedule(what).get().number == 0);
  std::promise<CallAnswer> answer;
  auto cancelled = answer.get_future();
  thread.cancel_all({{0}, what.due}, [&answer](const CallAnswer& given) { answer.set_value(given); });
  ASSERT_EQ(cancelled.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  EXPECT_TRUE(cancelled.get().success);
  EXPECT_EQ(sink.outcome.get_future().get().result, ScheduledOutcome::Result::cancelled);
}

/// Counts its results, and makes the write once more for each of the first two.
struct AgainAndAgain : WriteListener {
  explicit AgainAndAgain(DeviceThread& of) : thread(of) {}
  DeviceThread& thread;
  std::vector<WriteResult::Outcome> outcomes;
  void write() {
    Write write;
    write.listener = this;
    thread.write(write);
  }
  void on_result(const WriteResult& result) override {
    outcomes.push_back(result.outcome);
    if (outcomes.size() < 3) write();
  }
};

TEST(DeviceThread, A_write_has_a_result_also_after_its_end) {
  const auto owned = MapBuilder().coil("a", 1).build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  WaitingSink sink(owned->map());
  DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
  AgainAndAgain listener(thread);
  thread.start();
  thread.end();
  listener.write();
  EXPECT_THAT(listener.outcomes,
              testing::ElementsAre(WriteResult::Outcome::dropped, WriteResult::Outcome::dropped,
                                   WriteResult::Outcome::dropped));
}

/// Throws whatever it is told while it is lost.
struct ThrowingSink : WaitingSink {
  using WaitingSink::WaitingSink;
  std::atomic<int> failures{0};
  void on_online(bool now) override {
    if (!now) throw std::runtime_error("no room for a message");
  }
  void on_failure(const Error& /*error*/) override {
    ++failures;
    throw 1;
  }
  void on_loss(const std::string& /*text*/) override { throw 2; }
  void on_report(Level level, const std::string& /*text*/) override {
    if (level != Level::info) throw std::bad_alloc();
  }
};

TEST(DeviceThread, It_lives_on_though_the_sink_throws_again_when_it_is_told_that_the_device_is_lost) {
  auto builder = MapBuilder().coil("a", 1);
  builder.head().polling.rate = 100;
  const auto owned = builder.build();
  FakeDevice device;
  std::atomic<int> reads{0};
  device.during_read = [&device, &reads] {
    if (++reads == 2) device.next_errors.push_back(TransportFailure{"reset"});
  };
  Link link(test::share(device), {}, {});
  ThrowingSink sink(owned->map());
  DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
  thread.start();
  for (int i = 0; i < 2000 && reads < 4; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(thread.end());
  EXPECT_GE(reads, 4) << "it was not connected again";
  EXPECT_GE(sink.failures, 1);  // more if a busy machine makes polls late: that warning throws, too
}

TEST(DeviceThread, It_lives_on_though_there_is_no_memory_to_tell_that_it_is_lost) {
  auto builder = MapBuilder().coil("a", 1);
  builder.head().polling.rate = 100;
  const auto owned = builder.build();
  FakeDevice device;
  std::atomic<int> reads{0};
  device.during_read = [&reads] {
    if (++reads != 2) return;
    const std::runtime_error failure("a text that needs memory to be told");
    test::fail_allocation();
    throw failure;
  };
  Link link(test::share(device), {}, {});
  WaitingSink sink(owned->map());
  DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
  thread.start();
  for (int i = 0; i < 1000 && reads < 4; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(thread.end());
  EXPECT_GE(reads, 4) << "it was not connected again";
}

TEST(DeviceThread, It_ends_at_once_while_it_waits_to_connect_again) {
  const auto owned = MapBuilder().coil("a", 1).build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  device.refuse_connect = NotConnected{"refused"};
  WaitingSink sink(owned->map());
  {
    DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
    thread.start();
    device.await_idle();
  }
  EXPECT_TRUE(device.woken_by_call);
}

TEST(DeviceThread, Before_it_starts_and_after_it_has_ended_nothing_is_asked) {
  auto builder = MapBuilder().coil("a", 1);
  builder.head().on_shutdown = OnShutdown::safe;
  const auto owned = builder.build();
  FakeDevice device;
  Link link(test::share(device), {}, {});
  WaitingSink sink(owned->map());
  DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
  EXPECT_TRUE(thread.end());
  thread.start();
  EXPECT_TRUE(thread.end());
  EXPECT_TRUE(device.requests.empty());
}

/// Connects a moment after the thread is to end.
struct SlowToConnect : FakeDevice {
  std::promise<void> connects;
  std::promise<void> ends;
  Result<> open(const Event& interrupt) override {
    connects.set_value();
    ends.get_future().wait();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return interrupt.is_set() ? fail(NotConnected{"interrupted"}) : FakeDevice::open(interrupt);
  }
};

TEST(DeviceThread, Who_connects_just_when_it_ends_gets_its_safe_values) {
  auto builder = MapBuilder().command("a", 1);
  builder.head().on_shutdown = OnShutdown::safe;
  const auto owned = builder.build();
  const auto is_made_safe = [&owned] {
    SlowToConnect device;
    Link link(test::share(device), {}, {});
    WaitingSink sink(owned->map());
    DeviceThread thread(owned->map(), Verify::off, no_map, link, sink.values, sink);
    thread.start();
    device.connects.get_future().wait();
    device.ends.set_value();
    return thread.end() && device.requests.back() == "write coil 1";
  };
  bool made_safe = false;
  for (int i = 0; i < 20 && !made_safe; ++i) made_safe = is_made_safe();  // a busy machine may be late
  EXPECT_TRUE(made_safe);
}

}  // namespace
}  // namespace coupler::host
