// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/health.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The status is published at least this often.
constexpr auto status_interval = std::chrono::seconds(1);

/// The numbers of PointQuality::State::invalid and fault. The message PointStatus has no names for them,
/// because a new constant would change its MD5 sum in ROS 1, and older bags could no longer be played.
constexpr int invalid_quality = 7;
constexpr int fault_quality = 8;

/// The message of `<name>/status`, coupler_driver/Status of either ROS: its contents, and when it is
/// published.
template <class Message>
class Status {
 public:
  explicit Status(const Map& map) {
    message_.points.resize(map.points.size());
    for (std::size_t i = 0; i < map.points.size(); ++i) {
      message_.points[i].name = std::string(map.points[i].name);
      message_.points[i].quality = 0xFF;  // none: the first one is a change
    }
  }

  /// True if the message is to be published now: a quality, the identity or `online` has changed, or
  /// status_interval has passed. The caller sets the stamp.
  bool update(const DeviceSnapshot& device, const std::vector<PointQuality>& points, Time now) {
    if (!fill(device, points, now) && published_ != Time::min() && now - published_ < status_interval)
      return false;
    published_ = now;
    return true;
  }
  Message& message() { return message_; }

 private:
  using Points = decltype(std::declval<Message>().points);
  using PointStatus = typename Points::value_type;
  using State = PointQuality::State;
  using Outcome = WriteResult::Outcome;

  template <class T, class U>
  static bool assign(T& field, const U& value) {
    if (field == value) return false;
    field = static_cast<T>(value);
    return true;
  }

  static std::string in_words(const PointQuality& quality) {
    std::string text(to_string(quality.state));
    if (!quality.why.empty()) text += ": " + quality.why;
    if (quality.last_exception) text += "; last " + to_string(Error(ExceptionReply{*quality.last_exception}));
    return text;
  }

  static std::uint8_t number_of(const std::optional<Outcome>& outcome) {
    return outcome ? outcome_number(*outcome) : std::uint8_t{PointStatus::NOT_WRITTEN};
  }

  bool fill(const DeviceSnapshot& device, const std::vector<PointQuality>& points, Time now) {
    check_numbers();
    bool changed = assign(message_.online, device.online);
    changed |= assign(message_.identity, to_string(device.identity));
    changed |= assign(message_.trouble, device.online ? std::string() : device.trouble);
    for (std::size_t i = 0; i < points.size(); ++i) {
      PointStatus& status = message_.points[i];
      const PointQuality& quality = points[i];
      const std::uint8_t code =
          quality.last_exception ? static_cast<std::uint8_t>(*quality.last_exception) : std::uint8_t{0};
      status.age = quality.last_good ? std::chrono::duration<double>(now - *quality.last_good).count() : -1;
      changed |= assign(status.write_outcome, number_of(quality.last_write));
      changed |= assign(status.write_text, quality.last_write_text);
      const bool quality_changed = assign(status.quality, static_cast<std::uint8_t>(quality.state));
      const bool has_reason = PointQuality::is_unusable(quality.state) && status.text != in_words(quality);
      if (!(assign(status.exception, code) || quality_changed || has_reason)) continue;
      status.text = in_words(quality);
      changed = true;
    }
    return changed;
  }

  static constexpr void check_numbers() {
    static_assert(static_cast<int>(State::good) == PointStatus::GOOD &&
                  static_cast<int>(State::stale) == PointStatus::STALE &&
                  static_cast<int>(State::never_read) == PointStatus::NEVER_READ &&
                  static_cast<int>(State::exception) == PointStatus::EXCEPTION &&
                  static_cast<int>(State::rejected) == PointStatus::REJECTED &&
                  static_cast<int>(State::offline) == PointStatus::OFFLINE &&
                  static_cast<int>(State::not_wanted) == PointStatus::NOT_WANTED &&
                  static_cast<int>(State::invalid) == invalid_quality &&
                  static_cast<int>(State::fault) == fault_quality);
    static_assert(outcome_number(Outcome::ok) == PointStatus::WRITE_OK &&
                  outcome_number(Outcome::superseded) == PointStatus::WRITE_SUPERSEDED &&
                  outcome_number(Outcome::exception) == PointStatus::WRITE_EXCEPTION &&
                  outcome_number(Outcome::not_taken) == PointStatus::WRITE_NOT_TAKEN &&
                  outcome_number(Outcome::lost) == PointStatus::WRITE_LOST &&
                  outcome_number(Outcome::dropped) == PointStatus::WRITE_DROPPED &&
                  outcome_number(Outcome::kept) == PointStatus::WRITE_KEPT &&
                  outcome_number(Outcome::refused) == PointStatus::WRITE_REFUSED);
  }

  Message message_;
  Time published_ = Time::min();
};

}  // namespace coupler::host
