// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "coupler/host/panel/live_values.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::host::test {

using Names = std::vector<std::string>;
using State = PointQuality::State;

/// Values of a device, and one page that sees them.
class LiveValuesTest : public testing::Test {
 protected:
  using Json = nlohmann::ordered_json;

  void show(const fakes::MapBuilder& map) {
    owned_ = map.build();
    table_ = std::make_unique<ValueTable>(owned_->map());
    values_ = std::make_unique<LiveValues>(owned_->map(), *table_,
                                           [&](Level, const std::string& text) { reports_.push_back(text); });
    seen_ = 0;
  }

  /// What the page has not been told yet. Does not wait.
  Json news() { return Json::parse(values_->news(seen_, Time{}, Time{})); }
  /// What a page that comes now is told.
  Json news_again() const {
    std::uint64_t nothing = 0;
    return Json::parse(values_->news(nothing, Time{}, Time{}));
  }
  std::string quality(const std::string& point) const { return news_again()["points"][point]["quality"]; }
  static Names names_of(const Json& points) {
    Names names;
    for (const auto& [name, state] : points.items()) names.push_back(name);
    return names;
  }

  /// "SEEN_OFF,SEEN_ON" of the loop check.
  std::string seen(const std::string& point) const {
    const std::string csv = values_->seen_csv();
    const std::size_t line = csv.find("\n" + point + ",");
    if (line == std::string::npos) return "no such line";
    const std::size_t from = line + point.size() + 2;
    return csv.substr(from, csv.find(',', csv.find(',', from) + 1) - from);
  }
  /// [least, greatest] of the newest step, or null.
  Json step(const std::string& point) const {
    return Json::parse(values_->histories(std::chrono::steady_clock::now()))[point].back();
  }

  std::uint32_t index_of(std::string_view name) const {
    return static_cast<std::uint32_t>(find(owned_->map(), name) - owned_->map().points.begin());
  }
  /// A reply of these points, whose first register or bit is `start`.
  ReadSpan span(Table table, std::uint32_t start, std::size_t count, const Names& points) const {
    ReadSpan span{table, modbus::Range::of(start, static_cast<std::uint32_t>(count)), {}};
    for (const std::string& name : points) span.points.push_back(index_of(name));
    return span;
  }
  void read_registers(const Names& points, std::uint32_t start, const std::vector<std::uint16_t>& words,
                      std::chrono::nanoseconds at = {}, Table table = Table::holding_registers) {
    read(span(table, start, words.size(), points), words, start_ + at);
  }
  void read_bits(const Names& points, std::uint32_t start, const std::vector<std::uint16_t>& bits) {
    const Table table = owned_->map().points[index_of(points.front())].table;
    read(span(table, start, bits.size(), points), bits, start_);
  }
  void read(const ReadSpan& span, const std::vector<std::uint16_t>& values, Time at) {
    table_->store(span, values, {at, {}}, at);
    for (const std::uint32_t point : span.points)
      if (!table_->is_usable(point))
        values_->on_no_values({&point, 1}, at);
      else
        values_->on_values({&point, 1});
  }
  /// The point is read, and the answer is an exception.
  void refuse(const std::string& name, modbus::Exception code) {
    const std::uint32_t point = index_of(name);
    table_->exception({&point, 1}, code);
    values_->on_no_values({&point, 1}, start_);
  }
  void reject(const std::string& name, modbus::Exception code) {
    const std::uint32_t point = index_of(name);
    table_->rejected({&point, 1}, code);
    values_->on_no_values({&point, 1}, start_);
  }
  void set_online(bool online) {
    table_->online(online);
    values_->on_online(online);
  }

  const Time start_ = std::chrono::steady_clock::now();
  MapPtr owned_;
  std::vector<std::string> reports_;
  std::unique_ptr<ValueTable> table_;
  std::unique_ptr<LiveValues> values_;
  std::uint64_t seen_ = 0;
};

}  // namespace coupler::host::test
