// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/player.hpp"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/utc_text.hpp"

namespace coupler::device {
namespace {

/// How long a thread that is to end sleeps at most.
constexpr std::chrono::milliseconds nap{50};
/// How long the last values can be read.
constexpr std::chrono::milliseconds last_look{1000};

}  // namespace

Player::Player(const Recording& recording, const PlayedMap& played, ReplayOptions options)
    : PointHooks(played.map),
      recording_(recording),
      played_(played),
      recorded_(played.map.points.size()),
      options_(std::move(options)),
      supervisor_(::getpid()),
      differences_(recording, options_.tolerance, options_.compared),
      exceptions_(played.index.size()),
      shown_exceptions_(exceptions_) {
  for (std::uint32_t i = 0; i < played.index.size(); ++i) recorded_[played.index[i]] = i;
}

Player::~Player() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void Player::serving_began() {
  if (shared_[0].started != 0) {  // in another process, which has died with what clients had written
    shared_[0].is_broken = true;
    return end();
  }
  apply_what_is_before();
  thread_ = std::thread([this] { play(); });
}

bool Player::answers() {
  if (shared_[0].started == 0) shared_[0].started = Clock::now().time_since_epoch().count();
  return !is_lost_;
}

/// Whoever reads a point whose exception has ended gets the value that it has then, and none from before.
void Player::put_new_values(Image& image, Changes& changes) {
  const std::lock_guard lock(mutex_);
  PointHooks::put_new_values(image, changes);
  if (std::exchange(are_new_exceptions_, false)) shown_exceptions_ = exceptions_;
}

std::optional<modbus::Exception> Player::refuse_read(Table table, modbus::Range wanted) {
  for (std::size_t i = 0; i < shown_exceptions_.size(); ++i) {
    if (!shown_exceptions_[i]) continue;
    const Point& read = played_.map.points[played_.mirror[i].value_or(played_.index[i])];
    if (read.table == table && range(read).overlaps(wanted)) return shown_exceptions_[i];
  }
  return std::nullopt;
}

bool Player::accept(std::uint32_t point, const std::uint16_t* registers) {
  const auto recorded = recorded_[point];
  if (!recorded) return true;  // of a watchdog
  const Point& written = played_.map.points[point];
  const std::uint16_t own = own_bits(written);
  const std::lock_guard lock(mutex_);
  masked_.assign(registers, registers + range(written).count());
  for (std::uint16_t& each : masked_) each = static_cast<std::uint16_t>(each & own);
  differences_.written(*recorded, masked_.data(), now());
  replace_registers(point, masked_.data());  // a recorded value may have been set just before
  if (const auto mirror = played_.mirror[*recorded]) set_registers(*mirror, masked_.data());
  return true;
}

void Player::show(std::uint32_t recorded, const std::uint16_t* registers) {
  set_registers(played_.index[recorded], registers);
  if (const auto mirror = played_.mirror[recorded]) set_registers(*mirror, registers);
}

/// The first request may be a write, and the thread not awake yet.
Nanoseconds Player::now() const {
  const Clock::rep round = round_began_;
  const Clock::time_point began = round != 0 ? Clock::time_point(Clock::duration(round)) : first_round();
  return std::chrono::duration_cast<Nanoseconds>((Clock::now() - began) * options_.speed);
}

Player::Clock::duration Player::real(Nanoseconds recorded) const {
  return std::chrono::duration_cast<Clock::duration>(recorded / options_.speed);
}

Player::Clock::time_point Player::first_round() const {
  return Clock::time_point(Clock::duration(shared_[0].started)) - real(options_.from);
}

/// The first request finds everything as it was at that moment.
void Player::apply_what_is_before() {
  const std::lock_guard lock(mutex_);
  const auto events = recording_.events();
  while (applied_ < events.size() && events[applied_].at <= options_.from) apply(events[applied_++]);
}

/// False: the thread is to end.
bool Player::sleep_until(Clock::time_point time) {
  while (!stopping_ && Clock::now() < time) std::this_thread::sleep_until(std::min(time, Clock::now() + nap));
  return !stopping_;
}

bool Player::wait_for_start() {
  constexpr std::chrono::milliseconds look(1);
  while (!stopping_ && shared_[0].started == 0) std::this_thread::sleep_for(look);
  return !stopping_;
}

void Player::play() {
  if (!wait_for_start()) return;
  Clock::time_point began = first_round();
  const Clock::duration round = real(recording_.length());
  for (;;) {
    if (!play_once(began)) return;
    std::vector<Differences::Difference> found;
    {
      const std::lock_guard lock(mutex_);
      found = differences_.take_all();
      differences_.begin_again();
    }
    tell(found);
    if (!options_.loop || round.count() == 0) break;
    began += round;
    begin_again();
  }
  tell_unwritten();
  end();
}

/// Begins again. Values that are missing at the beginning of the recording do not keep those of its end.
void Player::begin_again() {
  const std::lock_guard lock(mutex_);
  is_lost_ = false;
  exceptions_.assign(exceptions_.size(), std::nullopt);
  are_new_exceptions_ = true;
}

/// Stops the node.
void Player::end() {
  is_over_ = true;
  if (::getppid() == supervisor_) ::kill(supervisor_, SIGTERM);
}

/// False: the thread is to end.
bool Player::play_once(Clock::time_point began) {
  const auto when = [&](Nanoseconds at) { return began + real(at); };
  round_began_ = began.time_since_epoch().count();
  const auto events = recording_.events();
  for (std::size_t i = std::exchange(applied_, 0); i < events.size();) {
    const Nanoseconds at = events[i].at;
    if (!wait_and_tell(at, when(at))) return false;
    const std::lock_guard lock(mutex_);
    while (i < events.size() && events[i].at == at) apply(events[i++]);
  }
  if (!wait_and_tell(recording_.length(), when(recording_.length()))) return false;
  if (options_.loop) return true;
  Nanoseconds until{};
  {
    const std::lock_guard lock(mutex_);
    until = differences_.open_until();
  }
  return sleep_until(std::max(when(until), when(recording_.length()) + last_look));
}

/// Differences are told as they become certain, also while nothing is recorded. False: the thread is to end.
bool Player::wait_and_tell(Nanoseconds recorded, Clock::time_point real_time) {
  constexpr std::chrono::milliseconds period(500);
  for (;;) {
    if (const auto now = Clock::now(); now >= told_at_ + period) {
      told_at_ = now;
      std::vector<Differences::Difference> found;
      {
        const std::lock_guard lock(mutex_);
        found = differences_.take(std::min(recorded, this->now()));
      }
      tell(found);
    }
    if (Clock::now() >= real_time) return !stopping_;
    if (!sleep_until(std::min(real_time, told_at_ + period))) return false;
  }
}

void Player::apply(const Recording::Event& event) {
  using Kind = Recording::Event::Kind;
  if (event.kind == Kind::lost || event.kind == Kind::online) {
    is_lost_ = options_.faults && event.kind == Kind::lost;
    return;
  }
  if (event.kind == Kind::value || options_.faults) {
    are_new_exceptions_ |= exceptions_[event.point] != event.exception;
    exceptions_[event.point] = event.exception;
  }
  if (event.kind == Kind::exception) return;
  const std::uint16_t* const registers = recording_.registers(event);
  if (is_writable(played_.map.points[played_.index[event.point]]))
    differences_.recorded(event.point, registers, event.at);
  if (!differences_.is_written(event.point)) show(event.point, registers);
}

/// Without the lock: whoever reads this may take his time.
void Player::tell(const std::vector<Differences::Difference>& found) {
  for (const auto& [at, point, what] : found) {
    ++shared_[0].differences;
    const std::string line = fmt::format(
        "replay: {} ({:.3f} s): {}: {}\n", utc_text(recording_.wall_at_begin() + at),
        std::chrono::duration<double>(at).count(), recording_.map()->map().points[point].name, what);
    std::fputs(line.c_str(), stderr);
  }
}

/// Outputs that nobody wrote followed the recording. Where their names were given, that is a difference.
void Player::tell_unwritten() {
  std::vector<std::uint32_t> points;
  {
    const std::lock_guard lock(mutex_);
    points = differences_.unwritten();
  }
  if (points.empty()) return;
  std::string names;
  for (const std::uint32_t point : points)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", recording_.map()->map().points[point].name);
  if (options_.names_points) shared_[0].differences += static_cast<std::uint32_t>(points.size());
  const std::string line =
      fmt::format("replay: nobody wrote {}, which followed the recording{}\n", names,
                  options_.names_points ? "" : "; where a program is to write them, name them with --points");
  std::fputs(line.c_str(), stderr);
}

}  // namespace coupler::device
