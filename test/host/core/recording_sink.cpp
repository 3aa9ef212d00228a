// SPDX-License-Identifier: Apache-2.0
#include "test/host/core/recording_sink.hpp"

#include <algorithm>

namespace coupler::host::test {

RecordingSink::RecordingSink(const Map& map) : map_(map) {}
RecordingSink::~RecordingSink() = default;

void RecordingSink::on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Stamp stamp) {
  stamps.push_back(stamp);
  for (const auto i : span.points)
    values[std::string(map_.points[i].name)].push_back(
        bits[read_range(map_.points[i]).start() - std::size_t{span.range.start()}]);
  for (Topic& topic : topics)
    for (const auto i : span.points) {
      if (topic.index != i) continue;
      const std::uint16_t value = values[std::string(map_.points[i].name)].back();
      if (topic.policy.calls_news(&value, stamp.at)) topic.published.push_back(stamp.at);
    }
}

RecordingSink::Topic& RecordingSink::add_topic(std::string_view point) {
  const Point* const found = find(map_, point);
  return topics.emplace_back(static_cast<std::uint32_t>(found - map_.points.data()), *found);
}

Time RecordingSink::repeat_at(std::uint32_t point) const {
  Time at = Time::max();
  for (const Topic& topic : topics)
    if (topic.index == point) at = std::min(at, topic.policy.repeat_at());
  return at;
}

void RecordingSink::on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp) {
  stamps.push_back(stamp);
  for (const auto i : span.points)
    values[std::string(map_.points[i].name)].push_back(
        registers[read_range(map_.points[i]).start() - std::size_t{span.range.start()}]);
}

int RecordingSink::reported(const std::string& text) const {
  int count = 0;
  for (const std::string& report : reports) count += report.find(text) != std::string::npos ? 1 : 0;
  return count;
}

}  // namespace coupler::host::test
