// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coupler/host/record/recorder.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::host::test {

using Words = std::vector<std::uint16_t>;

/// Lines that are easily compared.
class ShortFormat : public RecordFormat {
 public:
  std::string head(const record::Head& head, record::Moment /*at*/) const override {
    return "head of " + head.name + '\n';
  }
  std::string value(record::Moment at, const Point& point, Span<const std::uint16_t> registers,
                    record::Nanoseconds uncertainty, PointQuality::State quality) const override {
    if (quality != PointQuality::State::good)
      return fmt::format("{}: {} {} {}\n", in_ms(at.since_start), point.name, to_string(quality),
                         registers[0]);
    return fmt::format("{}: {} {}={}±{}\n", in_ms(at.since_start), holds_bits(point.table) ? "bit" : "word",
                       point.name, fmt::join(registers, ","), in_ms(uncertainty));
  }
  std::string no_value(record::Moment at, const Point& point, PointQuality::State quality,
                       unsigned exception) const override {
    return fmt::format("{}: {} {} {}\n", in_ms(at.since_start), point.name, to_string(quality), exception);
  }
  // The recorder's own clock tells when these were.
  std::string online(record::Moment /*at*/, std::optional<bool> is_node) const override {
    return is_node ? fmt::format("online, {}\n", *is_node ? "a node" : "foreign") : "online\n";
  }
  std::string lost(record::Moment /*at*/, std::string_view why) const override {
    return fmt::format("lost: {}\n", why);
  }
  std::string clock(record::Moment /*at*/, record::Nanoseconds /*set_by*/) const override {
    return "clock\n";
  }
  std::string missing(record::Moment at, record::Nanoseconds since, std::string_view why) const override {
    return fmt::format("{}: missing since {}: {}\n", in_ms(at.since_start), in_ms(since), why);
  }
  std::string end(record::Moment at) const override {
    return fmt::format("{}: end\n", in_ms(at.since_start));
  }

 private:
  static long in_ms(record::Nanoseconds time) {
    return static_cast<long>(std::chrono::duration_cast<std::chrono::milliseconds>(time).count());
  }
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

class RecorderTest : public testing::Test {
 protected:
  void record(const fakes::MapBuilder& map,
              std::unique_ptr<RecordFormat> format = std::make_unique<ShortFormat>()) {
    record(map.build(), std::move(format));
  }
  void record(MapPtr map, std::unique_ptr<RecordFormat> format = std::make_unique<ShortFormat>()) {
    owned_ = std::move(map);
    format_ = std::move(format);
    values_.emplace(owned_->map());
    recorder_.emplace(owned_->map(), *values_, "10.0.0.1:502", *format_, start_,
                      [&](Level, const std::string& text) { reports_.push_back(text); });
  }

  void come_online() {
    values_->connected();
    values_->online(true);
    recorder_->on_online(true);
  }
  void go_offline() {
    values_->online(false);
    recorder_->on_online(false);
  }
  void lose(const std::string& why) {
    go_offline();
    recorder_->on_loss(why);
  }

  std::uint32_t index_of(std::string_view name) const {
    return static_cast<std::uint32_t>(find(owned_->map(), name) - owned_->map().points.begin());
  }
  /// A reply of these points, whose first register or bit is `start`.
  ReadSpan span(Table table, std::uint32_t start, std::size_t count,
                const std::vector<std::string>& points) const {
    ReadSpan span{table, modbus::Range::of(start, static_cast<std::uint32_t>(count)), {}};
    for (const std::string& name : points) span.points.push_back(index_of(name));
    return span;
  }
  void read_registers(const std::vector<std::string>& points, std::uint32_t start, const Words& words,
                      std::chrono::milliseconds at = std::chrono::seconds(1), Duration uncertainty = {}) {
    read(span(Table::holding_registers, start, words.size(), points), words, {start_ + at, uncertainty});
  }
  void read_bits(const std::vector<std::string>& points, std::uint32_t start, const Words& bits) {
    read(span(Table::coils, start, bits.size(), points), bits, {start_ + std::chrono::seconds(1), {}});
  }
  void read(const ReadSpan& span, const Words& words, Stamp stamp) {
    values_->store(span, words, stamp, stamp.at);
    for (const std::uint32_t point : span.points)
      if (!values_->is_usable(point))
        recorder_->on_no_values({&point, 1}, stamp.at);
      else
        recorder_->on_values({&point, 1});
  }
  /// The point is read, and the answer is an exception.
  void refuse(const std::string& name, modbus::Exception code,
              std::chrono::milliseconds at = std::chrono::seconds(1)) {
    const std::uint32_t point = index_of(name);
    values_->exception({&point, 1}, code);
    recorder_->on_no_values({&point, 1}, start_ + at);
  }
  void reject(const std::string& name, modbus::Exception code,
              std::chrono::milliseconds at = std::chrono::seconds(1)) {
    const std::uint32_t point = index_of(name);
    values_->rejected({&point, 1}, code);
    recorder_->on_no_values({&point, 1}, start_ + at);
  }
  Recorder::Taken take() { return recorder_->take(start_ + std::chrono::seconds(1)); }
  std::vector<std::string> taken() {
    const Recorder::Taken taken = take();
    EXPECT_FALSE(taken.lost);
    return lines_of(taken.lines);
  }

  using State = PointQuality::State;
  const Time start_ = std::chrono::steady_clock::now() - std::chrono::hours(1);
  MapPtr owned_;
  std::unique_ptr<RecordFormat> format_;
  std::vector<std::string> reports_;
  std::optional<ValueTable> values_;
  std::optional<Recorder> recorder_;
};

}  // namespace coupler::host::test
