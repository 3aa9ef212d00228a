// SPDX-License-Identifier: Apache-2.0
#include "test/host/core/recording_sink.hpp"

#include <algorithm>

namespace coupler::host::test {

RecordingSink::RecordingSink(const Map& map, const ValueTable& table) : map_(map), table_(table) {}
RecordingSink::~RecordingSink() = default;

void RecordingSink::on_values(Span<const std::uint32_t> points) {
  if (points.empty()) return;
  stamps.push_back(table_.stamp(points[0]));
  for (const auto i : points) values[std::string(map_.points[i].name)].push_back(*table_.registers(i));
  for (Topic& topic : topics)
    if (std::find(points.begin(), points.end(), topic.index) != points.end() &&
        topic.policy.calls_news(table_.registers(topic.index), table_.stamp(topic.index).at))
      topic.published.push_back(table_.stamp(topic.index).at);
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

int RecordingSink::reported(const std::string& text) const {
  int count = 0;
  for (const std::string& report : reports) count += report.find(text) != std::string::npos ? 1 : 0;
  return count;
}

}  // namespace coupler::host::test
