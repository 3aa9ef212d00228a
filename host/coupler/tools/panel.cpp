// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/never_wait.hpp"
#include "coupler/base/utc_text.hpp"
#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/core/named_write.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "coupler/host/panel/panel_points.hpp"
#include "coupler/host/panel/panel_server.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/network.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/device_argument.hpp"
#include "coupler/tools/field_map.hpp"
#include "coupler/tools/interruption.hpp"
#include "coupler/tools/read_only_map.hpp"
#include "coupler/tools/report_line.hpp"

namespace coupler::tools {
namespace {

struct Arguments {
  DeviceArgument device;
  std::string listen = "127.0.0.1";  ///< IP address
  std::optional<std::uint16_t> port;
  std::string name;  ///< that browsers may call this machine besides its address; empty: none
  std::optional<std::string> certificate;  ///< PEM file for HTTPS; not given: HTTP
  std::optional<std::string> key;          ///< the file of its key
  bool write = false;                      ///< pages may write
  bool field = false;  ///< the field side of a simulated node (coupler/map/field_side.hpp)
};

using host::WriteTicket;

/// A page gives a click up after 5 s, and its request may arrive until then. It is written within this time
/// or not at all, so no click is written that is older than 8 s.
constexpr std::chrono::seconds longest_wait{3};
constexpr std::chrono::milliseconds turn_period{100};
constexpr int turns_a_report = 10;  ///< the head's numbers are new once a second

/// Writes a message to standard error. A terminal that is gone does not end the panel.
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
  /// A connection to the device. A thread that waits for the outcome of a write may hold it beyond its end.
  class Connection {
   public:
    Connection(const Map& map, host::ValueTable& table, host::Sink& sink)
        : link_(host::make_link(map.connection, map.limits)),
          thread_(map, map.verify, load_served_map, link_, table, sink) {
      thread_.start();
    }

    /// Queues a write, whose listener gets the result when the connection ends at the latest. Returns false
    /// if the connection has already ended.
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

bool is_loopback(std::string_view address) {
  const auto parsed = parse_network(address);
  return parsed && (parse_network("127.0.0.0/8")->contains(parsed->address) ||
                    parse_network("::1")->contains(parsed->address));
}

/// Returns ok if the page may be served like that. Otherwise says why not, and returns the exit status.
Exit check(const Arguments& arguments) {
  if (!is_ip_address(arguments.listen))
    return complain("panel", bad_call, "--listen: '" + arguments.listen + "' is not an IP address",
                    "give one of this machine's, or 0.0.0.0 for all of them");
  // An empty name, as of a variable that is not set, must not lead to HTTP.
  const bool is_https = arguments.certificate || arguments.key;
  if (is_https && (arguments.certificate.value_or("").empty() || arguments.key.value_or("").empty()))
    return complain("panel", bad_call, "HTTPS needs a certificate and its key",
                    "give both --page-certificate FILE and --page-key FILE");
  if (arguments.write && !is_https && !is_loopback(arguments.listen))
    return complain("panel", bad_call, "--write over a network needs HTTPS, or who reads along has the key",
                    "give --page-certificate FILE and --page-key FILE; or leave --listen out, give --port "
                    "8502, and on the other machine run `ssh -L 8502:127.0.0.1:8502 USER@THIS_MACHINE` and "
                    "open the address there");
  if (arguments.write && !is_https && !arguments.name.empty() && arguments.name != "localhost")
    return complain(
        "panel", bad_call,
        "--write with --name needs HTTPS: by plain HTTP and a name, a browser's pages cannot tell how "
        "many they are, and of too many none can write",
        "leave --name out, or give --page-certificate FILE and --page-key FILE");
  return ok;
}

Exit run(const Arguments& arguments) {
  if (const Exit checked = check(arguments); checked != ok) return checked;
  std::shared_ptr<const host::PageTls> tls;
  if (arguments.certificate) {
    auto read = host::read_page_tls(*arguments.certificate, *arguments.key);
    if (!read) return complain("panel", bad_call, read.error(), {});
    tls = *std::move(read);
  }
  const auto found = get_device("panel", arguments.device);
  if (!found) return found.error();
  std::optional<FieldMap> field;
  if (arguments.field)
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
  LookedAtDevice device(map, table, values, arguments.write);
  const std::string warning(watchdog_warning(original));
  if (!warning.empty()) say(host::Level::warning, warning);
  auto server = host::PanelServer::start({arguments.listen, arguments.port.value_or(0), arguments.name}, tls,
                                         host::panel_points(map, arguments.write, warning), values, device);
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

}  // namespace

void add_panel(Program& program, Exit& exit) {
  auto command =
      program.add_command("panel", "Show a device's points live, as a page in a browser, until Ctrl-C.");
  const auto arguments = std::make_shared<Arguments>();
  add_device_options(command, arguments->device);
  command.add_option("--port", arguments->port, "Port of the page (default: any free one)");
  command
      .add_option("--listen", arguments->listen,
                  "IP address at which the page is served, for browsers on other machines")
      .show_default()
      .type_name("ADDRESS");
  command
      .add_option("--name", arguments->name,
                  "What browsers may call this machine besides its address, as press.local")
      .type_name("NAME");
  command
      .add_option("--page-certificate", arguments->certificate,
                  "Serve the page by HTTPS: the PEM file of a certificate for this machine")
      .path()
      .type_name("FILE");
  command.add_option("--page-key", arguments->key, "The file of its key").path().type_name("FILE");
  command.add_flag("--write", arguments->write,
                   "Pages may write to the device; without it nothing is ever written");
  command.add_flag("--field", arguments->field,
                   "Of a node that runs with --sim: the other side of its terminals. With --write its inputs "
                   "can be set, and its outputs are only shown");
  command.footer(
      "Example:\n  coupler panel 192.168.1.20\n  coupler panel press.yaml --at 192.168.1.20 --port "
      "8502\n  coupler panel 127.0.0.1:1502 --field --write");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::tools
