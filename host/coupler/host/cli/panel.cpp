// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/never_wait.hpp"
#include "coupler/base/utc_text.hpp"
#include "coupler/cli/device_argument.hpp"
#include "coupler/cli/live_device.hpp"
#include "coupler/host/cli/field_map.hpp"
#include "coupler/host/cli/interruption.hpp"
#include "coupler/host/cli/read_only_map.hpp"
#include "coupler/host/cli/report_line.hpp"
#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/core/named_write.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "coupler/host/panel/panel_points.hpp"
#include "coupler/host/panel/panel_server.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::cli {
namespace {

using host::WriteTicket;

/// Until a page gives a click up, after 5 s, its request may come: none is written that is older than 8 s.
constexpr std::chrono::seconds longest_wait{3};
constexpr std::chrono::milliseconds turn_period{100};
constexpr int turns_a_report = 10;  ///< the head's numbers are new once a second

/// A terminal that has gone ends no panel.
void say(host::Level level, const std::string& text) {
  std::fputs(report_line("panel", level, text).c_str(), stderr);
}

/// A connection to the device that exists while a page looks.
class LookedAtDevice final : public host::PanelDevice {
 public:
  LookedAtDevice(const Map& map, host::ValueTable& table, host::LiveValues& values, bool writes)
      : map_(map), table_(table), values_(values), writes_(writes) {}

  void look(bool anybody) override {
    set(nullptr);  // first: the coupler may take one connection only
    table_.begin();
    if (anybody)
      set(std::make_shared<Connection>(map_, table_, values_));
    else
      values_.stopped();
  }
  bool writes() const override { return writes_; }
  WriteTicket::Outcome write(unsigned page, const std::string& point, const std::string& value) override {
    WriteTicket::Outcome outcome = try_write(point, value);
    say(outcome.outcome == host::WriteResult::Outcome::ok ? host::Level::info : host::Level::warning,
        fmt::format("{}: page {}: {} = {}: {}", utc_text(std::chrono::system_clock::now()), page,
                    printable(point), printable(value), printable(outcome.text)));
    return outcome;
  }
  void writers_left() override {
    say(host::Level::info,
        "no page that has written is left: connecting again, so that it feeds no watchdog");
    look(true);
  }

  /// Gives the pages the counts of the connection. To be called once a second.
  void report() {
    if (const auto now = connection()) values_.tell(now->statistics());
  }

 private:
  /// Somebody who waits for the outcome of a write may have it longer than it lasts.
  class Connection {
   public:
    Connection(const Map& map, host::ValueTable& table, host::Sink& sink)
        : link_(host::make_link(map.connection, map.limits)),
          thread_(map, map.verify, load_served_map, link_, table, sink) {
      thread_.start();
    }

    /// False: it has ended. Otherwise the listener hears of it, at the end at the latest.
    bool write(const host::Write& write) {
      const std::lock_guard lock(mutex_);
      if (!has_ended_) thread_.write(write);
      return !has_ended_;
    }
    void end() {
      {
        const std::lock_guard lock(mutex_);
        has_ended_ = true;
      }
      thread_.end();
    }
    host::DeviceSnapshot statistics() const { return thread_.statistics(); }

   private:
    host::Link link_;
    host::DeviceThread thread_;
    std::mutex mutex_;
    bool has_ended_ = false;
  };

  std::shared_ptr<Connection> connection() {
    const std::lock_guard lock(mutex_);
    return connection_;
  }
  void set(std::shared_ptr<Connection> next) {
    {
      const std::lock_guard lock(mutex_);
      connection_.swap(next);
    }
    if (next) next->end();  // the old one
  }

  WriteTicket::Outcome try_write(const std::string& name, const std::string& text) {
    auto write = host::write_named(map_, name, text);
    if (!write) return {host::WriteResult::Outcome::refused, {}, "refused: " + write.error()};
    WriteTicket ticket;
    write->listener = &ticket;
    write->ordered = true;
    write->until = std::chrono::steady_clock::now() + longest_wait;
    const auto now = connection();
    if (now == nullptr || !now->write(*write))
      return {host::WriteResult::Outcome::dropped, {}, "dropped: no page is open"};
    return ticket.wait();
  }

  const Map& map_;
  host::ValueTable& table_;
  host::LiveValues& values_;
  const bool writes_;
  std::mutex mutex_;
  std::shared_ptr<Connection> connection_;
};

}  // namespace

Exit panel(const DeviceArgument& argument, const PanelOptions& options) {
  std::shared_ptr<const host::PageTls> tls;
  if (!options.certificate.empty()) {
    auto read = host::read_page_tls(options.certificate, options.key);
    if (!read) return complain("panel", bad_call, read.error(), {});
    tls = *std::move(read);
  }
  const auto found = get_device("panel", argument);
  if (!found) return found.error();
  std::optional<FieldMap> field;
  if (options.field)
    if (const std::string why = field.emplace(found->map).why_missing(); !why.empty())
      return complain("panel", failed, "--field: " + why, {});
  const Map& original = field ? field->map() : found->map;
  const ReadOnlyMap looking(original);
  const Map& map = looking.map();
  host::SteadyClock clock;
  std::atomic<bool> ended{false};
  const Interruption interruption([&] {
    ended = true;
    clock.stop();
  });
  host::ValueTable table(map);
  host::LiveValues values(map, table, say);
  LookedAtDevice device(map, table, values, options.write);
  const std::string warning(watchdog_warning(original));
  if (!warning.empty()) say(host::Level::warning, warning);
  auto server = host::PanelServer::start({options.listen, options.port, options.name}, tls,
                                         host::panel_points(map, options.write, warning), values, device);
  if (!server) return complain("panel", bad_call, server.error(), "give another one with --listen or --port");
  for (const int file : {STDOUT_FILENO, STDERR_FILENO}) never_wait_for_reader_of(file);
  std::signal(SIGPIPE, SIG_IGN);
  std::puts((*server)->url().c_str());
  std::fflush(stdout);
  std::clearerr(stdout);  // it is no fault of the panel that nobody reads this
  if (const auto objection = (*server)->objection())
    say(host::Level::warning, "the page's certificate: " + *objection);
  say(host::Level::info, "open that address in a browser; Ctrl-C ends it");
  for (int turn = 0; !ended; ++turn) {
    clock.sleep_until(clock.now() + turn_period);
    if (turn % turns_a_report == 0) device.report();
    (*server)->turn(clock.now());
  }
  return ok;
}

}  // namespace coupler::cli
