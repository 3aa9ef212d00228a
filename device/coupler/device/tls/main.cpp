// SPDX-License-Identifier: Apache-2.0
// coupler-node-tls: the process of a node that does TLS. coupler-node starts it.
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "coupler/base/standard_files.hpp"
#include "coupler/device/log/stderr_log.hpp"
#include "coupler/device/net/allow_list.hpp"
#include "coupler/device/net/message.hpp"
#include "coupler/device/tls/expiry_notice.hpp"
#include "coupler/device/tls/tls_server.hpp"
#include "coupler/device/tls_process/tls_messages.hpp"
#include "coupler/device/tls_process/tls_settings.hpp"

namespace coupler::device {
namespace {

/// Behind the process that answers, and ahead of nobody else.
constexpr int politeness = 5;

bool is_socket(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISSOCK(status.st_mode);
}

/// The addresses of a map's `allow`, which the supervisor has read before.
AllowList allow_list(const std::vector<std::string>& texts) {
  std::vector<Network> networks;
  for (const std::string& text : texts)
    if (const auto network = parse_network(text)) networks.push_back(*network);
  return AllowList(std::move(networks));
}

/// Handles the messages of the supervisor.
class Control : public EventHandler {
 public:
  Control(Loop& loop, TlsServer& server, ExpiryNotice& expiry)
      : loop_(loop), server_(server), expiry_(expiry) {
    has_ended_ = !loop.watch(tls_messages::control_descriptor, Interest::read, *this);
  }

  /// The supervisor has: so does this process.
  bool has_ended() const { return has_ended_; }

  void ready(TimePoint) override {
    std::array<std::uint8_t, 16> room{};
    Descriptor descriptor;
    const ssize_t size = receive_message(tls_messages::control_descriptor, room, descriptor);
    if (size == 0) {
      has_ended_ = true;
      loop_.forget(tls_messages::control_descriptor, *this);  // its end would be reported again and again
    }
    if (size <= 0) return;
    if (room[0] == tls_messages::prepare) prepare(descriptor.get());
    if (room[0] == tls_messages::commit && prepared_) commit(std::move(descriptor));
    if (room[0] == tls_messages::alive) answer(tls_messages::still_alive, {});
  }

 private:
  struct Prepared {
    TlsRules rules;
    AllowList allowed;
  };

  void prepare(int memory) {
    prepared_.reset();
    auto settings = read_settings(memory);
    if (!settings)
      return answer(tls_messages::refused, "the certificates could not be handed to the TLS process");
    auto context = tls::Context::make(tls::Side::server, settings->credentials);
    if (!context) return answer(tls_messages::refused, "'security': " + context.error());
    prepared_ = Prepared{{*std::move(context), std::move(settings->roles)}, allow_list(settings->allow)};
    answer(tls_messages::prepared, {});
  }

  void commit(Descriptor socket) {
    expiry_.watch(prepared_->rules.context.validity());
    Listener listener{std::move(socket), {}, std::move(prepared_->allowed)};
    server_.put_in_force(std::move(listener), std::move(prepared_->rules));
    prepared_.reset();
  }

  static void answer(std::uint8_t what, const std::string& text) {
    const Span<const char> letters(text);
    (void)send_message(tls_messages::control_descriptor,
                       {{&what, 1}, {reinterpret_cast<const std::uint8_t*>(letters.data()), letters.size()}},
                       -1, Waits::no);
  }

  Loop& loop_;
  TlsServer& server_;
  ExpiryNotice& expiry_;
  std::optional<Prepared> prepared_;
  bool has_ended_ = false;
};

std::chrono::milliseconds until_then(TimePoint until, TimePoint now) {
  return std::chrono::ceil<std::chrono::milliseconds>(until - now);
}

int run() {
  ::prctl(PR_SET_NAME, "coupler-tls");
  ::prctl(PR_SET_DUMPABLE, 0);  // no core file has the key, and no other process of this user reads it
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  (void)!::nice(politeness);
  for (const int inherited : {tls_messages::control_descriptor, tls_messages::clients_descriptor})
    ::fcntl(inherited, F_SETFD, FD_CLOEXEC);
  StderrLog log(std::getenv("JOURNAL_STREAM"));
  log.never_wait();
  Loop loop;
  if (!loop.is_open()) return 1;
  TlsServer server(loop, log, [](const OpenConnection& client) {
    return send_client(tls_messages::clients_descriptor, client, Waits::no);
  });
  ExpiryNotice expiry(log);
  Control control(loop, server, expiry);
  TimePoint now = TimePoint::clock::now();
  const auto turn = [&](std::optional<std::chrono::milliseconds> most) {
    for (const auto due : {server.time_until_due(now), expiry.time_until_due(now), log.tick(now)})
      if (due && (!most || *due < *most)) most = due;
    now = loop.run_once(most);
    server.tick(now);
    expiry.tick(now, std::chrono::system_clock::now());
  };
  while (!control.has_ended()) turn(std::nullopt);
  // The process that answers has ended before: its last answers are on their way.
  constexpr std::chrono::milliseconds for_last_words{100};
  for (const TimePoint until = now + for_last_words; now < until && server.size() > 0;)
    turn(until_then(until, now));
  return 0;
}

}  // namespace
}  // namespace coupler::device

int main() {
  using namespace coupler::device;
  coupler::open_standard_files();
  if (!is_socket(tls_messages::control_descriptor) || !is_socket(tls_messages::clients_descriptor)) {
    std::fputs(
        "coupler-node-tls: coupler-node starts this program when the 'security' of its map has a "
        "certificate; "
        "there is nothing to call by hand\n",
        stderr);
    return 2;
  }
  return run();
}
