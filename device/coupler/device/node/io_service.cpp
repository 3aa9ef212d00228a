// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/io_service.hpp"

#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string_view>
#include <utility>

#include "coupler/base/log_line_limit.hpp"
#include "coupler/device/supervisor/heartbeat.hpp"

namespace coupler::device {
namespace {

/// That clients which wait can ask for.
constexpr std::size_t kept_changes = 1024;

using TimeUntilDue = std::optional<std::chrono::milliseconds>;

class SteadyClock final : public Clock {
 public:
  TimePoint now() const override { return TimePoint::clock::now(); }
};

const SteadyClock steady_clock;

/// nullopt is for ever.
TimeUntilDue shorter(TimeUntilDue a, TimeUntilDue b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

/// A substitute for the first seconds of a machine without a source of random numbers, when the kernel has
/// none.
std::uint32_t epoch_from_clock() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto ns = static_cast<std::uint64_t>(std::chrono::nanoseconds(now).count());
  return static_cast<std::uint32_t>(ns ^ ns >> 32) ^ static_cast<std::uint32_t>(::getpid());
}

/// A number for what begins anew with each process: not 0, and hardly ever the same twice. Waits for nothing.
std::uint32_t random_epoch() {
  std::uint32_t epoch = 0;
  if (::getrandom(&epoch, sizeof epoch, GRND_NONBLOCK) != sizeof epoch) epoch = epoch_from_clock();
  return std::max<std::uint32_t>(epoch, 1);
}

/// " (01: 2, 03: 1)"; nothing if there were none.
std::string by_code(const Statistics& statistics) {
  std::string text;
  for (std::size_t i = 0; i < identity::exceptions_of.size(); ++i)
    if (const auto count = statistics.*identity::exceptions_of[i]; count != 0)
      text += fmt::format("{}{:02}: {}", text.empty() ? " (" : ", ", i + 1, count);
  return text.empty() ? text : text + ")";
}

}  // namespace

/// Takes edges from the kernel as they come. A line that is gone is not watched any more.
class IoService::EdgeHandler final : public EventHandler {
 public:
  EdgeHandler(Loop& loop, InputGroup& group, Handler& handler, Log& log)
      : loop_(loop), group_(group), handler_(handler) {
    if (!loop_.watch(group_.descriptor(), Interest::read, *this))
      log.write(fmt::format(
          "edges of an input cannot be watched: {}; they are taken only when a client sends a request",
          std::strerror(errno)));
  }
  EdgeHandler(const EdgeHandler&) = delete;
  EdgeHandler& operator=(const EdgeHandler&) = delete;
  ~EdgeHandler() { loop_.forget(group_.descriptor(), *this); }

  void ready(TimePoint now) override {
    handler_.take_news(now);
    if (!group_.reports_edges()) loop_.forget(group_.descriptor(), *this);
  }

 private:
  Loop& loop_;
  InputGroup& group_;
  Handler& handler_;
};

/// Takes clients that another process has let in.
class IoService::Intake final : public EventHandler {
 public:
  Intake(Loop& loop, int channel, TcpServer& tcp) : loop_(loop), channel_(channel), tcp_(tcp) {
    [[maybe_unused]] const bool watched = loop_.watch(channel_, Interest::read, *this);
    assert(watched);
  }
  Intake(const Intake&) = delete;
  Intake& operator=(const Intake&) = delete;
  ~Intake() { loop_.forget(channel_, *this); }

  void ready(TimePoint now) override {
    std::array<std::uint8_t, longest_client_message> bytes{};
    Descriptor socket;
    const ssize_t size = receive_message(channel_, bytes, socket);
    if (size == 0) return loop_.forget(channel_, *this);
    if (size < 0) return;
    const auto message = Span<const std::uint8_t>(bytes).first(static_cast<std::size_t>(size));
    // Without TLS it would have the rights of others.
    if (auto client = parse_client(message, std::move(socket)); client && client->tls)
      tcp_.admit(*std::move(client), now);
  }

 private:
  Loop& loop_;
  int channel_;
  TcpServer& tcp_;
};

IoService::IoService(const ServingContext& context, Loop& loop, Log& log, int clients)
    : loop_(loop),
      log_(log),
      statistics_(context.state->statistics()),
      hooked_(context.hooked.get()),
      ring_(kept_changes),
      told_(context.state->image().bits().size()),
      changes_(context.state->image(), ring_, told_),
      schedule_(context.state->scheduled(), &changes_, context.state->pulses()),
      handler_(*context.map, context.hardware(),
               {context.state->image(), context.state->statistics(), context.state->watchdog(),
                context.state->links(), changes_, schedule_},
               &steady_clock),
      server_(context.map->connection.unit, handler_, context.state->statistics()),
      tcp_(loop, context.listener, server_, context.state->statistics(), log),
      timer_(loop, [this](TimePoint now) { handler_.tick(now); }),
      now_(TimePoint::clock::now()),
      trips_(statistics_.watchdog_trips) {
  handler_.set_machine(context.state->machine());
  handler_.tell_changes(random_epoch(), now_);
  if (hooked_ != nullptr) hooked_->begin_levels(changes_.ring());
  if (clients >= 0) intake_ = std::make_unique<Intake>(loop, clients, tcp_);
  for (InputGroup* group : context.wiring->event_sources())
    edge_handlers_.emplace_back(loop, *group, handler_, log);
}

IoService::~IoService() = default;

void IoService::take_over(std::vector<OpenConnection> clients) { tcp_.take_over(std::move(clients), now_); }

void IoService::run(const std::function<bool(TimePoint)>& is_over, const std::function<void()>& beat) {
  for (TimePoint next_beat = now_; !is_over(now_); turn()) {
    if (now_ < next_beat) continue;
    beat();
    next_beat = now_ + heartbeat_period;
  }
  (void)log_.tick(now_ + LogLineLimit::usual);  // logs what is still held back
}

std::vector<OpenConnection> IoService::release() {
  handler_.end_schedule(TimePoint::clock::now());
  return tcp_.release();
}

bool IoService::make_safe(modbus::Reason reason) {
  const bool is_safe = handler_.make_safe(reason, TimePoint::clock::now());
  tcp_.end_waits();
  return is_safe;
}

void IoService::end(std::string_view why) {
  const bool is_safe = make_safe(modbus::Reason::reload);
  log_.write(shutdown_summary(why, is_safe, statistics_, TimePoint::clock::now()));
}

void IoService::turn() {
  const TimeUntilDue work = shorter(tcp_.time_until_due(now_), handler_.time_until_due(now_));
  timer_.set(handler_.next_scheduled());
  now_ = loop_.run_once(shorter(heartbeat_period, shorter(work, log_.tick(now_))));
  handler_.tick(now_);
  if (hooked_ != nullptr) tell_firmware();
  tcp_.tick(now_);
  log_trips();
}

/// The outputs that the firmware wanted before its code failed are dropped, or they would undo the safe
/// state.
void IoService::tell_firmware() {
  if (hooked_->tell_levels(changes_.ring())) return;
  (void)hooked_->take_wanted_outputs();
  (void)make_safe(modbus::Reason::safe_state);
}

void IoService::log_trips() {
  if (trips_ == statistics_.watchdog_trips) return;
  trips_ = statistics_.watchdog_trips;
  const std::string writers = tcp_.writers();
  log_.warn_limited(
      "watchdog",
      fmt::format("the watchdog expired: no client that writes sent a request in time; outputs go to their "
                  "safe state; {}",
                  writers.empty() ? "no such client is connected" : "still connected: " + writers));
}

std::string shutdown_summary(std::string_view why, bool safe, const Statistics& statistics, TimePoint now) {
  struct Count {
    std::string_view of;
    std::uint32_t count;
  };
  std::string text = fmt::format(
      "{}: {}; answered {} requests, {} of them with an exception{}; uptime {} s", why,
      safe ? "outputs are in their safe state" : "not every output could be driven to its safe state",
      statistics.requests, statistics.exceptions, by_code(statistics),
      std::chrono::duration_cast<std::chrono::seconds>(now - statistics.started).count());
  for (const Count& item : {Count{"connections", statistics.connections},
                            {"refused", statistics.refusals},
                            {"evicted", statistics.evictions},
                            {"closed for what they sent", statistics.bad_frames},
                            {"timed out", statistics.timeouts},
                            {"requests for other units", statistics.foreign_units},
                            {"hardware errors", statistics.hardware_errors},
                            {"events lost", statistics.events_lost},
                            {"watchdog trips", statistics.watchdog_trips}})
    if (item.count != 0) text += fmt::format(", {}: {}", item.of, item.count);
  return text;
}

}  // namespace coupler::device
