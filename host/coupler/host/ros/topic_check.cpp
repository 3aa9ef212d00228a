// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/topic_check.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::host {
namespace {

constexpr std::string_view write_end = "/write";
constexpr std::string_view stamped_ends[] = {"/stamped", "/sample"};
constexpr std::string_view one_by_one =
    "; the topic of a point and its /write are remapped one by one: remap the other one, too";

/// Returns the text before `end`; empty if the topic has another end.
std::string before(std::string_view end, std::string_view topic) {
  if (topic.size() <= end.size() || topic.substr(topic.size() - end.size()) != end) return {};
  return std::string(topic.substr(0, topic.size() - end.size()));
}

/// The end that is one of those of stamped points; empty: it has none.
std::string_view stamped_end(std::string_view topic) {
  for (const std::string_view end : stamped_ends)
    if (!before(end, topic).empty()) return end;
  return {};
}

/// Returns the text before the end of a topic with stamps; empty if the topic has no such end.
std::string before_stamped_end(std::string_view topic) {
  const std::string_view end = stamped_end(topic);
  return end.empty() ? std::string() : before(end, topic);
}

std::string key_of(const Endpoint& other) {
  return fmt::format("{} {} {} {}", other.topic, other.publishes ? "<" : ">", other.node, other.type);
}

std::string read_only(const Endpoint& other, const Point& point) {
  return fmt::format("{}: node {} publishes here, and the point {} is read only: nothing is written. {}",
                     other.topic, other.node, point.name,
                     is_writable(point.table)
                         ? "If the device lets it be written, give it 'access: read_write' in the map"
                         : fmt::format("No device lets {} be written", to_string(point.table)));
}

std::string write_only(const Endpoint& other, const Point& point) {
  return fmt::format(
      "{}: node {} subscribes, and the point {} is write only: it receives nothing. If the device lets "
      "it be read, give it 'access: read_write' in the map",
      other.topic, other.node, point.name);
}

std::string not_stamped(const Endpoint& other, const Point& point) {
  return fmt::format("{}: node {} subscribes, and the point {} is not stamped: it receives nothing. {}",
                     other.topic, other.node, point.name,
                     point.count > 1 ? "An array cannot be" : "Give it 'stamped: true' in the map");
}

std::string nobody_there(const Endpoint& other) {
  return fmt::format(
      "{}: node {} {}", other.topic, other.node,
      other.publishes ? "publishes here, and nobody listens" : "subscribes, and nobody publishes here");
}

/// Returns whether the two names are probably meant to be the same. Names that differ in a number, or have
/// one letter in place of another (arm_l, arm_r), are rather those of two devices.
bool is_same_device(std::string_view written, std::string_view device) {
  if (edit_distance(written, device) != 1 || !is_slip(written, device)) return false;
  const auto kept = [](std::string_view name, bool (*keep)(char)) {
    std::string rest;
    std::copy_if(name.begin(), name.end(), std::back_inserter(rest), keep);
    return rest;
  };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return kept(written, is_digit) == kept(device, is_digit) &&
         (written.size() != device.size() ||
          std::is_permutation(written.begin(), written.end(), device.begin()));
}

/// Points of the map that fit; for subscribers the other topics of a device, too.
std::vector<std::string_view> names_of(const Map& map, bool (*fits)(const Point&), bool with_others) {
  std::vector<std::string_view> names;
  for (const Point& point : map.points)
    if (fits(point)) names.push_back(point.name);
  if (!with_others) return names;
  names.push_back(loader::points_topic);
  names.insert(names.end(), std::begin(loader::driver_topics), std::end(loader::driver_topics));
  return names;
}

}  // namespace

std::string_view TopicCheck::needed_type(const std::string& topic, bool publishes) const {
  const Topics& own = publishes ? written_ : published_;
  const auto found = own.find(topic);
  return found == own.end() ? std::string_view() : found->second.type;
}

const Point* TopicCheck::point_of(const Topics& topics, const std::string& topic) {
  const auto found = topics.find(topic);
  return found == topics.end() ? nullptr : found->second.point;
}

const TopicCheck::Device* TopicCheck::device_of(const std::string& topic) const {
  const Device* nearest = nullptr;
  for (const Device& one : devices_)
    if (starts_with(topic, one.space) && (nearest == nullptr || one.space.size() > nearest->space.size()))
      nearest = &one;
  return nearest;
}

bool TopicCheck::concerns(const std::string& topic) const {
  return published_.count(topic) > 0 || written_.count(topic) > 0 || device_of(topic) != nullptr ||
         point_of(published_, before(write_end, topic)) != nullptr ||
         point_of(published_, before_stamped_end(topic)) != nullptr ||
         point_of(written_, topic + std::string(write_end)) != nullptr || !beside_device(topic).empty();
}

std::vector<Finding> TopicCheck::check(const std::vector<Endpoint>& others) const {
  Names met[2];   // topics that somebody subscribes to, and those that somebody publishes
  Names drivers;  // they publish `online`, too, and DuplicateDriver reports them
  for (const Endpoint& other : others) {
    met[other.publishes ? 1 : 0].insert(other.topic);
    if (other.publishes && !before("/online", other.topic).empty() && published_.count(other.topic) > 0)
      drivers.insert(other.node);
  }
  std::vector<Finding> findings;
  std::vector<Finding> guesses;
  for (const Endpoint& other : others) {
    if (const auto needed = needed_type(other.topic, other.publishes); !needed.empty()) {
      check_type(other, needed, findings);
      continue;
    }
    if (published_.count(other.topic) > 0) {
      if (drivers.count(other.node) == 0)
        findings.push_back({key_of(other), [this, other] { return foreign(other); }});
      continue;
    }
    if (written_.count(other.topic) > 0) continue;
    const bool is_alone = met[other.publishes ? 0 : 1].count(other.topic) == 0;
    if (!check_direction(other, is_alone, findings) && is_alone)
      guesses.push_back({key_of(other), [this, other] { return misspelt(other); }, false});
  }
  findings.insert(findings.end(), guesses.begin(), guesses.end());
  return findings;
}

void TopicCheck::check_type(const Endpoint& other, std::string_view needed, std::vector<Finding>& findings) {
  if (other.type.empty() || other.type == "*" || other.type == needed) return;
  findings.push_back({key_of(other), [other, needed] {
                        return fmt::format("{}: node {} {} {}, and this topic is {}: {} {}", other.topic,
                                           other.node, other.publishes ? "publishes" : "subscribes to",
                                           other.type, needed,
                                           other.publishes ? "its messages do not arrive. Publish"
                                                           : "it receives nothing. Subscribe to",
                                           needed);
                      }});
}

/// Subscribers cannot tell what it publishes from what this node does.
std::string TopicCheck::foreign(const Endpoint& other) const {
  const Point* const point = point_of(published_, other.topic);
  const auto write = std::find_if(written_.begin(), written_.end(),
                                  [point](const auto& topic) { return topic.second.point == point; });
  const std::string remedy =
      write == written_.end()
          ? fmt::format("Remap this topic of {}", other.node)
          : fmt::format("If they are to be written, publish at {}; otherwise remap this topic of {}",
                        write->first, other.node);
  return fmt::format("{}: node {} publishes here, too: its values are not the device's. {}", other.topic,
                     other.node, remedy);
}

/// A topic of a point that goes the other way only. False: it is none.
bool TopicCheck::check_direction(const Endpoint& other, bool is_alone, std::vector<Finding>& findings) const {
  const auto add = [&](const Point& point, std::string (*text)(const Endpoint&, const Point&)) {
    findings.push_back({key_of(other), [other, &point, text] { return text(other, point); }});
    return true;
  };
  const auto elsewhere = [](const Endpoint& end, const Point&) {
    return nobody_there(end) + std::string(one_by_one);
  };
  if (other.publishes) {
    const Point* const point = point_of(published_, before(write_end, other.topic));
    if (point == nullptr) return false;
    if (!is_writable(*point)) return add(*point, read_only);
    return is_alone && add(*point, elsewhere);
  }
  if (!is_alone) return false;
  if (const Point* const point = point_of(written_, other.topic + std::string(write_end)))
    return is_readable(*point) ? add(*point, elsewhere) : add(*point, write_only);
  const Point* const point = point_of(published_, before_stamped_end(other.topic));
  return point != nullptr && !point->host.stamped && add(*point, not_stamped);
}

/// Only where a name is near: others may have topics beside those of a device.
std::string TopicCheck::misspelt(const Endpoint& other) const {
  const Device* const device = device_of(other.topic);
  const std::string rest = device == nullptr ? std::string() : other.topic.substr(device->space.size());
  if (other.publishes && "/" + rest == write_end) return without_point(other, *device);
  if (device != nullptr)
    if (std::string text = without_topics(other, *device, rest); !text.empty()) return text;
  const std::string meant = device == nullptr ? (other.publishes ? beside_device(other.topic) : std::string())
                            : other.publishes ? write_meant_by(*device, rest)
                                              : value_meant_by(*device, rest);
  return meant.empty() ? meant : fmt::format("{}; did you mean {}?", nobody_there(other), meant);
}

/// At a point that was not chosen to have topics.
std::string TopicCheck::without_topics(const Endpoint& other, const Device& device,
                                       const std::string& rest) const {
  const std::string_view end = other.publishes ? write_end : stamped_end(rest);
  const Point* const point = find(*device.map, end.empty() ? std::string_view(rest) : before(end, rest));
  if (point == nullptr) return {};
  const auto is_of_point = [point](const auto& topic) { return topic.second.point == point; };
  for (const Topics* topics : {&published_, &written_})
    if (std::any_of(topics->begin(), topics->end(), is_of_point)) return {};
  return fmt::format("{}: {} has no topics. Name it in the setting 'topics' of the driver",
                     nobody_there(other), point->name);
}

/// At the name of the service for writes.
std::string TopicCheck::without_point(const Endpoint& other, const Device& device) const {
  for (const std::string_view name : names_of(*device.map, is_writable, false))
    if (const std::string topic = fmt::format("{}{}{}", device.space, name, write_end);
        written_.count(topic) > 0)
      return fmt::format("{}: it has no point. Publish at the point's, as {}", nobody_there(other), topic);
  return {};
}

/// "lmap/write", "lamp/wirte", "lmap". Whatever is below a point that can be written is meant for it.
std::string TopicCheck::write_meant_by(const Device& device, const std::string& rest) const {
  const std::size_t slash = std::min(rest.rfind('/'), rest.size());
  const std::string_view head = std::string_view(rest).substr(0, slash);
  const std::string_view end = std::string_view(rest).substr(slash);
  const auto names = names_of(*device.map, is_writable, false);
  std::string_view name;
  if (std::find(names.begin(), names.end(), head) != names.end()) name = head;
  if (name.empty() && is_slip(end, write_end)) name = nearest(head, names);
  if (name.empty()) name = nearest(rest, names);
  const std::string meant = fmt::format("{}{}{}", device.space, name, write_end);
  return written_.count(meant) > 0 ? meant : std::string();
}

std::string TopicCheck::value_meant_by(const Device& device, const std::string& rest) const {
  const std::string_view end = stamped_end(rest);
  const std::string word = end.empty() ? rest : before(end, rest);
  if (word.empty()) return {};
  const auto is_stamped = [](const Point& point) { return point.host.stamped; };
  const auto fits = end.empty() ? static_cast<bool (*)(const Point&)>(is_readable) : +is_stamped;
  const std::string_view near = nearest(word, names_of(*device.map, fits, end.empty()));
  const std::string meant = fmt::format("{}{}{}", device.space, near, end);
  return near.empty() || published_.count(meant) == 0 ? std::string() : meant;
}

/// A write to a point of this driver, but for a slip in the device's name; empty if it is none, or may be for
/// several.
std::string TopicCheck::beside_device(const std::string& topic) const {
  if (before(write_end, topic).empty()) return {};
  std::string meant;
  for (const Device& device : devices_)
    for (std::size_t slash = topic.find('/', 1); slash != std::string::npos;
         slash = topic.find('/', slash + 1)) {
      std::string there = device.space + topic.substr(slash + 1);
      if (written_.count(there) == 0 || !is_same_device(topic.substr(0, slash + 1), device.space)) continue;
      if (!meant.empty()) return {};
      meant = std::move(there);
    }
  return meant;
}

}  // namespace coupler::host
