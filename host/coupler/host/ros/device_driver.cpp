// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/device_driver.hpp"

#include <algorithm>
#include <future>
#include <utility>

#include <fmt/format.h>

#include "coupler/codec/text.hpp"
#include "coupler/host/ros/advertise_points.hpp"
#include "coupler/host/ros/device_motion.hpp"
#include "coupler/host/ros/device_panel.hpp"
#include "coupler/host/ros/device_waits.hpp"
#include "coupler/host/ros/shutdown.hpp"
#include "coupler/host/ros/start_progress.hpp"
#include "coupler/host/ros/status.hpp"
#include "coupler/map/loader/load.hpp"

namespace coupler::host {
namespace {

/// A point of that name has the topic.
std::shared_ptr<void> publish_points(Node& node, const Map& map) {
  return find(map, "points") == nullptr ? node.publish_points(topic(map, "points"), map) : nullptr;
}

Node::PublishScheduled advertise_scheduled(Node& node, const Map& map, const WallTime& wall) {
  return can_schedule(map) ? node.advertise_scheduled(topic(map, "scheduled"), map, wall)
                           : Node::PublishScheduled();
}

std::function<void(bool)> advertise_online(Node& node, const Map& map) {
  auto online = node.advertise_online(topic(map, "online"));
  online(false);
  return online;
}

/// Each request is a line at ROS's debug level.
std::unique_ptr<Link> traced(std::unique_ptr<Link> link, std::string device, Node& node) {
  link->trace({[&node] { return node.shows_debug(); },
               [&node, device = std::move(device)](const std::string& line) {
                 node.log_debug(fmt::format("{}: {}", device, line));
               }});
  return link;
}

}  // namespace

DeviceDriver::DeviceDriver(Node& node, const Map& map, std::unique_ptr<Link> link,
                           const std::vector<std::string>& topics)
    : node_(node),
      map_(map),
      values_(map_),
      subscribers_(map.points.size()),
      has_topics_(choose_topics(node, map_, topics)),
      publishers_(advertise_all({node, map_, subscribers_, has_topics_})),
      stamped_(advertise_with_time({node, map_, subscribers_, has_topics_}, wall_, "stamped",
                                   &Node::advertise_stamped)),
      samples_(advertise_with_time({node, map_, subscribers_, has_topics_}, wall_, "sample",
                                   &Node::advertise_sample)),
      points_(publish_points(node, map_)),
      publish_online_(advertise_online(node, map)),
      publish_status_(node.advertise_status(topic(map, "status"), map)),
      publish_scheduled_(advertise_scheduled(node, map_, wall_)),
      diagnostics_(map, node),
      services_(map, values_, subscribers_),
      link_(traced(std::move(link), std::string(map.name), node)),
      thread_(map, map.verify, load_served_map, *link_, values_, *this),
      writes_{[this](const Write& write) { accept(write); },
              [this](std::optional<std::uint32_t> point, const std::string& what) { refuse(point, what); }} {}

void DeviceDriver::begin(const Followed& followed) {
  if (Shutdown::requested) return;
  start_followers(followed);
  if (map_.poll == Poll::subscribed)
    for (std::uint32_t i = 0; i < map_.points.size(); ++i) thread_.want(i, false);
  thread_.start();
  if (map_.poll == Poll::subscribed)
    subscribers_.follow([this](std::uint32_t point, bool wanted) {
      forget(point);  // it is not read meanwhile
      for (const auto& follower : followers_) follower->wanted(point);
      thread_.want(point, wanted);
    });
  subscribers_.on_each([this](std::uint32_t point) { thread_.want(point, true); });
  // Before the topics, which take minutes for many points: safe values are available before any write is.
  services_.start(node_,
                  {writes_, [this] { return driven().reset_watchdog(); }, [this] { return make_safe(); },
                   [this](const ScheduledWrite& what) { return schedule(what); },
                   [this](std::uint32_t number) { return thread_.cancel_scheduled(number); },
                   [this] { return thread_.scheduled(); }, [this] { return thread_.statistics(); }});
  for (const auto& follower : followers_) follower->begin();
  for_each_point(node_, map_, "have their topics and services for writes", [this](std::uint32_t i) {
    if (!has_topics_[i] || !is_writable(map_.points[i])) return;
    subscriptions_.push_back(node_.subscribe(topic(map_, map_.points[i].name) + "/write", map_, i, writes_));
    services_.offer_set(i);
  });
}

/// The thread, for what drives outputs. ROS may ask for that while other devices are still started.
DeviceThread& DeviceDriver::driven() {
  Shutdown::begin_driving();
  return thread_;
}

void DeviceDriver::start_followers(const Followed& followed) {
  const auto report = [this](Level level, const std::string& text) { log(level, text); };
  const auto add = [this](std::unique_ptr<Follower> follower) {
    if (follower) followers_.push_back(std::move(follower));
  };
  if (followed.recording) add(DeviceRecording::start(map_, values_, *followed.recording, report));
  if (followed.panel) add(start_panel(map_, values_, *followed.panel, report));
  if (!map_.tools.empty() || !map_.axes.empty())
    add(DeviceMotion::start(node_, map_, values_, subscribers_,
                            {[this](const Write& write) { driven().write(write); },
                             [this](std::uint32_t point) { thread_.want(point, true); },
                             [this](const ScheduledWrite& what, Reply<ScheduleAnswer>::Give give) {
                               driven().schedule(what, std::move(give));
                             },
                             [this](WritesFrom which, Reply<CallAnswer>::Give give) {
                               thread_.cancel_all(std::move(which), std::move(give));
                             }}));
  if (can_wait_for(map_))
    add(DeviceWaits::start(node_, map_, values_, subscribers_,
                           [this](std::uint32_t point) { thread_.want(point, true); }));
}

void DeviceDriver::end_followers() {
  for (const auto& follower : followers_) follower->end();
}

bool DeviceDriver::stop() {
  services_.stop();
  for (const auto& follower : followers_) follower->end_comes();
  return stop_device();
}

bool DeviceDriver::report(Time now, bool force) {
  using State = PointQuality::State;
  const std::uint64_t revision = thread_.revision();
  if (!force && revision == reported_ && now <= stale_from_ && now < status_due_) return false;
  reported_ = revision;
  stale_from_ = Time::max();
  const DeviceSnapshot device = thread_.statistics();
  std::vector<PointQuality> points = values_.qualities(now);
  for (const auto& follower : followers_) follower->report(device, now);
  for (const PointQuality& point : points) stale_from_ = std::min(stale_from_, point.stale_from);
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (const auto state = points[i].state; is_readable(map_.points[i]) && subscribers_.is_unwanted(i) &&
                                            (state == State::stale || state == State::never_read))
      points[i].state = State::not_wanted;
  if (publish_status_(device, points, now)) status_due_ = now + status_interval;
  thread_.report_held_back();
  for (LogLineLimit* const lines : {&refused_lines_, &wall_lines_})
    if (const auto line = lines->due(now)) log(Level::warning, *line);
  if (const auto slow = pace_.update(map_, device, now)) log(Level::warning, *slow);
  return diagnostics_.update(device, points, pace_.trouble());
}

void DeviceDriver::on_values(Span<const std::uint32_t> points) {
  publish(points, false);
  for (const auto& follower : followers_) follower->sink().on_values(points);
}

void DeviceDriver::on_told(std::uint32_t point) {
  publish({&point, 1}, true);
  for (const auto& follower : followers_) follower->sink().on_told(point);
}

void DeviceDriver::publish(Span<const std::uint32_t> points, bool is_told) {
  bool is_measured = false;  // once, so that the stamps of one read are equal
  for (const std::uint32_t point : points) {
    if (!has_topics_[point]) continue;
    const Sample sample{values_.stamp(point), is_told, values_.differs(point)};
    publishers_[point]->publish(values_.registers(point), sample);
    if (sample.is_new && map_.points[point].format.type == codec::Type::STRING) check_text(point);
    if (!map_.points[point].host.stamped) continue;
    if (!std::exchange(is_measured, true)) measure_wall();
    for (const auto* publishers : {&stamped_, &samples_})
      if (const auto& publisher = (*publishers)[point]) publisher->publish(values_.registers(point), sample);
  }
}

void DeviceDriver::on_gap() {
  for (const auto& follower : followers_) follower->sink().on_gap();
}

void DeviceDriver::on_no_values(Span<const std::uint32_t> points, Time at) {
  for (const std::uint32_t point : points) {
    if (!values_.is_usable(point)) renew(point);  // so that subscribers see the value come back
    forget(point);
  }
  for (const auto& follower : followers_) follower->sink().on_no_values(points, at);
}

/// ROS 2's other programs fail on a text that is not UTF-8, so it is published with escapes.
void DeviceDriver::check_text(std::uint32_t point) {
  const Point& text = map_.points[point];
  const auto byte = codec::first_unknown_byte(values_.registers(point), text.format);
  if (!byte || !odd_texts_.insert(point).second) return;
  const bool is_ascii = text.format.encoding == codec::Encoding::ascii;
  log(Level::warning,
      fmt::format(
          "the text of {} is not {}: its byte 0x{:02X} is published as '{}'. If its letters are wrong "
          "in pairs, write 'order: {}'; if the device has Latin-1, write 'encoding: latin-1'",
          text.name, to_string(text.format.encoding), *byte, is_ascii ? "?" : fmt::format("\\x{:02x}", *byte),
          codec::bytes_swapped(text.format.order) ? "AB" : "BA"));
}

void DeviceDriver::renew(std::uint32_t point) {
  for (const auto* publishers : {&publishers_, &stamped_, &samples_})
    if (const auto& publisher = (*publishers)[point]) publisher->renew();
}

void DeviceDriver::forget(std::uint32_t point) {
  if (const auto& publisher = samples_[point]) publisher->forget();
}

void DeviceDriver::measure_wall() {
  const Duration set_by = wall_.measure();
  if (set_by == Duration::zero()) return;
  const double seconds = std::chrono::duration<double>(std::chrono::abs(set_by)).count();
  const auto line = wall_lines_.say(
      fmt::format("this machine's clock was set {:.3f} s {}, or it slept; time stamps follow it", seconds,
                  set_by > Duration::zero() ? "ahead" : "back"),
      std::chrono::steady_clock::now());
  if (line) log(Level::warning, *line);
}

Time DeviceDriver::repeat_at(std::uint32_t point) const {
  Time first = Time::max();
  for (const auto* publishers : {&publishers_, &stamped_, &samples_})
    if (const auto& publisher = (*publishers)[point]) first = std::min(first, publisher->repeat_at());
  return first;
}

void DeviceDriver::on_identified(Identity::Verdict verdict) {
  for (const auto& follower : followers_) follower->sink().on_identified(verdict);
}

void DeviceDriver::on_online(bool online) {
  for (std::uint32_t i = 0; online && i < publishers_.size(); ++i) {
    renew(i);  // values from before the interruption are history
    forget(i);
  }
  publish_online_(online);
  for (const auto& follower : followers_) follower->sink().on_online(online);
}

void DeviceDriver::on_scheduled(const ScheduledOutcome& outcome) {
  for (const auto& follower : followers_) follower->sink().on_scheduled(outcome);
  measure_wall();
  publish_scheduled_(outcome);
}

void DeviceDriver::on_loss(const std::string& why) {
  for (const auto& follower : followers_) follower->sink().on_loss(why);
}

void DeviceDriver::on_report(Level level, const std::string& text) {
  log(level, text);
  for (const auto& follower : followers_) follower->sink().on_report(level, text);
}

void DeviceDriver::log(Level level, const std::string& text) {
  node_.log(level, fmt::format("{}: {}", map_.name, text));
}

void DeviceDriver::refuse(std::optional<std::uint32_t> point, const std::string& what) {
  if (point) {
    Write refused;
    refused.point = *point;
    thread_.refuse(refused, what);
  }
  say_refused(what);
}

void DeviceDriver::say_refused(const std::string& what) {
  const auto now = std::chrono::steady_clock::now();
  if (const auto line = refused_lines_.say("refused a write to " + what, now)) log(Level::warning, *line);
}

/// Writes it, unless it belongs to a tool.
void DeviceDriver::accept(const Write& write) {
  const Point& point = map_.points[write.point];
  const std::string why = why_not_direct(map_, point);
  if (why.empty()) {
    for (const auto& follower : followers_) follower->write_comes(write.point);
    return driven().write(write);
  }
  thread_.refuse(write, why);
  say_refused(fmt::format("{}: {}", point.name, why));
}

/// Followers stop what they do before the request, and what they begin while it is made.
std::future<CallAnswer> DeviceDriver::make_safe() {
  const auto tell = [this] {
    for (const auto& follower : followers_) follower->safe_comes();
  };
  tell();
  auto made = driven().make_safe();
  tell();
  return made;
}

std::future<ScheduleAnswer> DeviceDriver::schedule(const ScheduledWrite& what) {
  const std::string why = why_not_direct(map_, map_.points[what.write.point]);
  if (why.empty()) return driven().schedule(what);
  std::promise<ScheduleAnswer> refused;
  refused.set_value({0, "refused: " + why});
  return refused.get_future();
}

}  // namespace coupler::host
