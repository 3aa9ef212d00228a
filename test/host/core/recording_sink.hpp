// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/core/publish_policy.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host::test {

/// Keeps what it is told.
class RecordingSink : public Sink {
 public:
  RecordingSink(const Map& map, const ValueTable& table);
  ~RecordingSink() override;

  std::map<std::string, std::vector<std::uint16_t>>
      values;                 ///< first register or bit of each sample, by point
  std::vector<Stamp> stamps;  ///< of each span
  std::vector<bool> online;
  std::vector<std::string> reports;

  /// Of a point, as in the driver.
  struct Topic {
    Topic(std::uint32_t of, const Point& point) : index(of), policy(point) {}
    std::uint32_t index;
    PublishPolicy policy;
    std::vector<Time> published;
  };
  std::deque<Topic> topics;
  Topic& add_topic(std::string_view point);

  void on_values(Span<const std::uint32_t> points) override;
  std::map<std::string, int> no_values;  ///< how often a point was said to have none
  void on_no_values(Span<const std::uint32_t> points, Time) override {
    for (const std::uint32_t point : points) ++no_values[std::string(map_.points[point].name)];
  }
  Time repeat_at(std::uint32_t point) const override;
  void on_online(bool now) override { online.push_back(now); }
  std::vector<ScheduledOutcome> outcomes;
  int throwing_outcomes = 0;  ///< it throws when it has been told so many
  void on_scheduled(const ScheduledOutcome& outcome) override {
    outcomes.push_back(outcome);
    if (throwing_outcomes > 0 && throwing_outcomes-- > 0) throw std::bad_alloc();
  }
  void on_report(Level, const std::string& text) override { reports.push_back(text); }

  /// How many reports contain the text.
  int reported(const std::string& text) const;

 private:
  Map map_;
  const ValueTable& table_;
};

}  // namespace coupler::host::test
