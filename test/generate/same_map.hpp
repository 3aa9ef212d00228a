// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "coupler/map/fields.hpp"

namespace coupler::testing {

static_assert(model_version == 20, "Compare the new fields of the model here, too");

/// What fields_of() lists.
template <class Struct>
void expect_same_fields(const Struct& a, const Struct& b) {
  for_each_field(a, b, [](const auto& field, const auto& value, const auto& other) {
    EXPECT_EQ(value, other) << field.key;
  });
}

inline void expect_same(const codec::Format& a, const codec::Format& b) {
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.order, b.order);
  EXPECT_EQ(a.half, b.half);
  EXPECT_EQ(a.bit, b.bit);
  EXPECT_EQ(a.bits, b.bits);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.encoding, b.encoding);
}

inline void expect_same(Span<const std::uint16_t> a, Span<const std::uint16_t> b) {
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
}

inline void expect_same(const HostOptions& a, const HostOptions& b) {
  expect_same_fields(a, b);
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
  expect_same_fields(a.line, b.line);
  EXPECT_EQ(a.description, b.description);
  EXPECT_EQ(a.units, b.units);
  expect_same_fields(a.counter, b.counter);
  expect_same_fields(a.latched, b.latched);
  EXPECT_EQ(a.count, b.count);
  expect_same_fields(a.scale, b.scale);
  expect_same_fields(a.iio, b.iio);
  expect_same_fields(a.pwm, b.pwm);
  expect_same(a.safe_value, b.safe_value);
  EXPECT_EQ(a.read_address, b.read_address);
  expect_same_fields(a.bounds, b.bounds);
  EXPECT_TRUE(std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(),
                         [](const NamedValue& one, const NamedValue& other) {
                           return one.value == other.value && one.name == other.name;
                         }));
  expect_same_fields(a.faults, b.faults);
  EXPECT_TRUE(std::equal(a.invalid.begin(), a.invalid.end(), b.invalid.begin(), b.invalid.end(),
                         [](const RawRange& one, const RawRange& other) {
                           return one.first == other.first && one.last == other.last;
                         }));
  EXPECT_EQ(a.pulse, b.pulse);
  expect_same(a.host, b.host);
}

inline void expect_same(const Service& a, const Service& b) {
  expect_same_fields(a, b);
  EXPECT_TRUE(std::equal(a.allow.begin(), a.allow.end(), b.allow.begin(), b.allow.end()));
  expect_same_fields(a.watchdog, b.watchdog);
  EXPECT_EQ(a.port, b.port);
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

inline void expect_same(const Security& a, const Security& b) {
  EXPECT_EQ(a.plain, b.plain);
  EXPECT_EQ(a.no_role, b.no_role);
  EXPECT_EQ(a.files.certificate, b.files.certificate);
  EXPECT_EQ(a.files.key, b.files.key);
  EXPECT_EQ(a.files.ca, b.files.ca);
  EXPECT_EQ(a.files.revoked, b.files.revoked);
  EXPECT_EQ(a.port, b.port);
  ASSERT_EQ(a.roles.size(), b.roles.size());
  for (std::size_t i = 0; i < a.roles.size(); ++i) {
    const Role& one = a.roles[i];
    const Role& other = b.roles[i];
    EXPECT_EQ(one.name, other.name);
    EXPECT_TRUE(std::equal(one.rights.begin(), one.rights.end(), other.rights.begin(), other.rights.end()));
    EXPECT_EQ(one.reads_all, other.reads_all);
  }
}

/// Every field of the model, deep.
inline void expect_same(const Map& a, const Map& b) {
  EXPECT_EQ(a.name, b.name);
  expect_same_fields(a.connection, b.connection);
  expect_same_fields(a.polling, b.polling);
  expect_same_fields(a.limits, b.limits);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    SCOPED_TRACE(a.points[i].name);
    expect_same(a.points[i], b.points[i]);
  }
  ASSERT_EQ(a.sim.size(), b.sim.size());
  for (std::size_t i = 0; i < a.sim.size(); ++i) expect_same_fields(a.sim[i], b.sim[i]);
  EXPECT_EQ(a.fingerprint, b.fingerprint);
  EXPECT_EQ(a.text, b.text);
  EXPECT_EQ(a.text_crc, b.text_crc);
  expect_same(a.service, b.service);
  expect_same_fields(a, b);
  for (const auto areas : {&Map::unreadable, &Map::read_whole}) {
    ASSERT_EQ((a.*areas).size(), (b.*areas).size());
    for (std::size_t i = 0; i < (a.*areas).size(); ++i) {
      EXPECT_EQ((a.*areas)[i].table, (b.*areas)[i].table);
      EXPECT_EQ((a.*areas)[i].range, (b.*areas)[i].range);
    }
  }
  expect_same(a.coupler_watchdog, b.coupler_watchdog);
  expect_same(a.security, b.security);
  ASSERT_EQ(a.tools.size(), b.tools.size());
  for (std::size_t i = 0; i < a.tools.size(); ++i) {
    EXPECT_EQ(a.tools[i].name, b.tools[i].name);
    expect_same_fields(a.tools[i], b.tools[i]);
  }
  ASSERT_EQ(a.axes.size(), b.axes.size());
  for (std::size_t i = 0; i < a.axes.size(); ++i) {
    EXPECT_EQ(a.axes[i].name, b.axes[i].name);
    expect_same_fields(a.axes[i], b.axes[i]);
  }
}

}  // namespace coupler::testing
