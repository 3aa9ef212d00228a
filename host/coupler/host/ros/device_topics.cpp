// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/device_topics.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/ros/status.hpp"
#include "coupler/map/loader/load.hpp"

namespace coupler::host {
namespace {

using State = PointQuality::State;

std::string topic(const Map& map, std::string_view point) { return fmt::format("{}/{}", map.name, point); }

std::vector<std::unique_ptr<PointPublisher>> advertise_all(Node& node, const Map& map, Listeners& listeners) {
  std::vector<std::unique_ptr<PointPublisher>> result(map.points.size());
  for (std::uint32_t i = 0; i < map.points.size(); ++i)
    if (is_readable(map.points[i]))
      result[i] = node.advertise(topic(map, map.points[i].name), map.points[i], i, listeners);
  return result;
}

std::function<void(bool)> advertise_online(Node& node, const Map& map) {
  auto online = node.advertise_online(topic(map, "online"));
  online(false);
  return online;
}

}  // namespace

DeviceTopics::DeviceTopics(Node& node, const Map& map, std::unique_ptr<Transport> transport, Verify verify,
                           Poll poll)
    : node_(node),
      map_(map),
      listeners_(map.points.size()),
      publishers_(advertise_all(node, map_, listeners_)),
      online_(advertise_online(node, map)),
      status_(node.advertise_status(topic(map, "status"), map)),
      diagnostics_(map, node),
      services_(map, listeners_),
      transport_(std::make_unique<TracedTransport>(std::string(map.name), std::move(transport), node)),
      thread_(map, verify, load_served_map, *transport_, *this, poll),
      writes_{[this](const Write& write) { thread_.write(write); },
              [this](std::optional<std::uint32_t> point, const std::string& what) { refuse(point, what); }} {
  for (std::uint32_t i = 0; i < map_.points.size(); ++i)
    if (is_writable(map_.points[i]))
      subscriptions_.push_back(node.subscribe(topic(map_, map_.points[i].name) + "/write", map_, i, writes_));
  services_.offer(node, {writes_, [this] { return thread_.reset_watchdog(); },
                         [this] { return thread_.make_safe(); }, [this] { return thread_.statistics(); }});
  if (poll == Poll::subscribed)
    listeners_.follow([this](std::uint32_t point, bool wanted) { thread_.want(point, wanted); });
}

bool DeviceTopics::end() {
  services_.withdraw();
  return thread_.end();
}

bool DeviceTopics::report(Time now, bool anyway) {
  const std::uint64_t revision = thread_.revision();
  if (!anyway && revision == seen_ && now <= stale_from_ && now < status_due_) return false;
  seen_ = revision;
  stale_from_ = Time::max();
  const DeviceSnapshot device = thread_.statistics();
  std::vector<PointQuality> points = thread_.qualities();
  for (const PointQuality& point : points) stale_from_ = std::min(stale_from_, point.stale_from);
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (const auto state = points[i].state; is_readable(map_.points[i]) && listeners_.is_unwanted(i) &&
                                            (state == State::stale || state == State::never_read))
      points[i].state = State::not_wanted;
  if (status_(device, points, now)) status_due_ = now + status_interval;
  thread_.report_held_back();
  if (const auto line = refused_lines_.due(now)) on_report(Level::warning, *line);
  return diagnostics_.update(device, points);
}

void DeviceTopics::on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Time at) {
  std::copy(bits.begin(), bits.end(), bits_.begin());
  on_registers(span, {bits_.data(), bits.size()}, at);
}

void DeviceTopics::on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Time at) {
  for (const std::uint32_t index : span.points) {
    const modbus::Range place = read_range(map_.points[index]);
    const std::uint16_t* value = &registers[place.start() - std::size_t{span.range.start()}];
    publishers_[index]->publish(value, at);
    if (services_.value_waiter().is_wanted(index))
      services_.value_waiter().bring(value, place.count(), transport_->asked());
  }
}

void DeviceTopics::on_online(bool online) {
  if (online)  // what was published before is history
    for (const auto& publisher : publishers_)
      if (publisher) publisher->renew();
  services_.value_waiter().online(online);
  online_(online);
}

void DeviceTopics::on_report(Level level, const std::string& text) {
  node_.log(level, fmt::format("{}: {}", map_.name, text));
}

void DeviceTopics::refuse(std::optional<std::uint32_t> point, const std::string& what) {
  if (point) {
    Write refused;
    refused.point = *point;
    thread_.refuse(refused, what);
  }
  const auto now = std::chrono::steady_clock::now();
  if (const auto line = refused_lines_.say("refused a write to " + what, now))
    on_report(Level::warning, *line);
}

}  // namespace coupler::host
