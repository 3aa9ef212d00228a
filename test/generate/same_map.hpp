// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "common/map/map.hpp"

namespace coupler::testing {

static_assert(model_version == 5, "Compare the new fields of the model here, too");

inline void expect_same(const Line& a, const Line& b) {
  EXPECT_EQ(a.chip, b.chip);
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.active_low, b.active_low);
  EXPECT_EQ(a.bias, b.bias);
  EXPECT_EQ(a.drive, b.drive);
  EXPECT_EQ(a.debounce, b.debounce);
}

inline void expect_same(const codec::Format& a, const codec::Format& b) {
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.order, b.order);
  EXPECT_EQ(a.half, b.half);
  EXPECT_EQ(a.bit, b.bit);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.encoding, b.encoding);
}

inline void expect_same(const EdgeOf& a, const EdgeOf& b) {
  EXPECT_EQ(a.input, b.input);
  EXPECT_EQ(a.edge, b.edge);
}

inline void expect_same(Span<const std::uint16_t> a, Span<const std::uint16_t> b) {
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
}

inline void expect_same(const HostOptions& a, const HostOptions& b) {
  EXPECT_EQ(a.rate, b.rate);
  EXPECT_EQ(a.publish, b.publish);
  EXPECT_EQ(a.deadband, b.deadband);
  EXPECT_EQ(a.max_interval, b.max_interval);
  EXPECT_EQ(a.latch, b.latch);
  EXPECT_EQ(a.queue_size, b.queue_size);
  EXPECT_EQ(a.write_function, b.write_function);
  EXPECT_EQ(a.write_queue, b.write_queue);
  EXPECT_EQ(a.verify_write, b.verify_write);
  EXPECT_EQ(a.deadman.timeout, b.deadman.timeout);
  expect_same(a.deadman.value, b.deadman.value);
}

inline void expect_same(const Point& a, const Point& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.table, b.table);
  EXPECT_EQ(a.address, b.address);
  expect_same(a.format, b.format);
  EXPECT_EQ(a.access, b.access);
  expect_same(a.initial, b.initial);
  EXPECT_EQ(a.safe, b.safe);
  expect_same(a.line, b.line);
  EXPECT_EQ(a.description, b.description);
  EXPECT_EQ(a.units, b.units);
  expect_same(a.counter, b.counter);
  expect_same(a.latched, b.latched);
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.scale.gain, b.scale.gain);
  EXPECT_EQ(a.scale.offset, b.scale.offset);
  EXPECT_EQ(a.iio.device, b.iio.device);
  EXPECT_EQ(a.iio.channel, b.iio.channel);
  EXPECT_EQ(a.pwm.chip, b.pwm.chip);
  EXPECT_EQ(a.pwm.channel, b.pwm.channel);
  EXPECT_EQ(a.pwm.period, b.pwm.period);
  expect_same(a.safe_value, b.safe_value);
  EXPECT_EQ(a.read_address, b.read_address);
  expect_same(a.host, b.host);
}

inline void expect_same(const SimWire& a, const SimWire& b) {
  EXPECT_EQ(a.from, b.from);
  EXPECT_EQ(a.to, b.to);
  EXPECT_EQ(a.invert, b.invert);
  EXPECT_EQ(a.square, b.square);
}

inline void expect_same(const Connection& a, const Connection& b) {
  EXPECT_EQ(a.address, b.address);
  EXPECT_EQ(a.port, b.port);
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_EQ(a.timeout, b.timeout);
}

inline void expect_same(const Polling& a, const Polling& b) {
  EXPECT_EQ(a.rate, b.rate);
  EXPECT_EQ(a.discrete_continuous, b.discrete_continuous);
  EXPECT_EQ(a.discrete_gap, b.discrete_gap);
  EXPECT_EQ(a.register_continuous, b.register_continuous);
  EXPECT_EQ(a.register_gap, b.register_gap);
}

inline void expect_same(const Limits& a, const Limits& b) {
  EXPECT_EQ(a.read_registers, b.read_registers);
  EXPECT_EQ(a.read_bits, b.read_bits);
  EXPECT_EQ(a.write_registers, b.write_registers);
  EXPECT_EQ(a.write_bits, b.write_bits);
  EXPECT_EQ(a.request_gap, b.request_gap);
  EXPECT_EQ(a.connect_delay, b.connect_delay);
  EXPECT_EQ(a.connections, b.connections);
  EXPECT_EQ(a.mask_write, b.mask_write);
}

inline void expect_same(const Service& a, const Service& b) {
  EXPECT_EQ(a.listen, b.listen);
  EXPECT_TRUE(std::equal(a.allow.begin(), a.allow.end(), b.allow.begin(), b.allow.end()));
  EXPECT_EQ(a.watchdog.timeout, b.watchdog.timeout);
  EXPECT_EQ(a.watchdog.fed_by, b.watchdog.fed_by);
  EXPECT_EQ(a.watchdog.recovery, b.watchdog.recovery);
  EXPECT_EQ(a.readback, b.readback);
}

inline void expect_same(const WatchdogSequences::Write& a, const WatchdogSequences::Write& b) {
  EXPECT_EQ(a.table, b.table);
  EXPECT_EQ(a.address, b.address);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.if_different, b.if_different);
}

inline void expect_same(Span<const WatchdogSequences::Write> a, Span<const WatchdogSequences::Write> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) expect_same(a[i], b[i]);
}

inline void expect_same(const WatchdogSequences& a, const WatchdogSequences& b) {
  EXPECT_EQ(a.timeout, b.timeout);
  EXPECT_EQ(a.recovery, b.recovery);
  EXPECT_EQ(a.feed_every, b.feed_every);
  expect_same(a.arm, b.arm);
  expect_same(a.feed, b.feed);
  expect_same(a.reset, b.reset);
  EXPECT_EQ(a.refusal, b.refusal);
  ASSERT_EQ(a.alarm.has_value(), b.alarm.has_value());
  if (a.alarm) expect_same(*a.alarm, *b.alarm);
}

/// Every field of the model, deep.
inline void expect_same(const Map& a, const Map& b) {
  EXPECT_EQ(a.name, b.name);
  expect_same(a.connection, b.connection);
  expect_same(a.polling, b.polling);
  expect_same(a.limits, b.limits);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    SCOPED_TRACE(a.points[i].name);
    expect_same(a.points[i], b.points[i]);
  }
  ASSERT_EQ(a.sim.size(), b.sim.size());
  for (std::size_t i = 0; i < a.sim.size(); ++i) expect_same(a.sim[i], b.sim[i]);
  EXPECT_EQ(a.fingerprint, b.fingerprint);
  EXPECT_EQ(a.text, b.text);
  EXPECT_EQ(a.text_crc, b.text_crc);
  expect_same(a.service, b.service);
  EXPECT_EQ(a.on_reconnect, b.on_reconnect);
  EXPECT_EQ(a.on_shutdown, b.on_shutdown);
  EXPECT_EQ(a.poll, b.poll);
  ASSERT_EQ(a.unreadable.size(), b.unreadable.size());
  for (std::size_t i = 0; i < a.unreadable.size(); ++i) {
    EXPECT_EQ(a.unreadable[i].table, b.unreadable[i].table);
    EXPECT_EQ(a.unreadable[i].range, b.unreadable[i].range);
  }
  expect_same(a.coupler_watchdog, b.coupler_watchdog);
}

}  // namespace coupler::testing
