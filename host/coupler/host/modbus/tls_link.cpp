// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/tls_link.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "coupler/base/what_failed.hpp"
#include "coupler/credentials/credentials.hpp"
#include "coupler/tls/alert.hpp"
#include "coupler/tls/context.hpp"
#include "coupler/tls/issue.hpp"
#include "coupler/tls/session.hpp"

namespace coupler::host {
namespace {

class TlsConnection final : public TlsLink {
 public:
  TlsConnection(Descriptor socket, const tls::Context& context, Certificate own,
                tls::Verification verification)
      : certificates_{std::move(own), {}, false},
        socket_(std::move(socket)),
        verification_(std::move(verification)),
        session_(context.connection(socket_.get(), verification_), verification_) {}
  TlsConnection(const TlsConnection&) = delete;
  TlsConnection& operator=(const TlsConnection&) = delete;
  ~TlsConnection() override {
    stop_.call();
    if (thread_.joinable()) thread_.join();
  }

  /// Returns what went wrong; empty: nothing.
  std::string shake_hands(const Deadline& deadline, const Event& interrupt) {
    while (session_.shake_hands() == tls::Session::State::handshake) {
      std::array<pollfd, 2> wanted{
          {{socket_.get(), session_.wants().socket, 0}, {interrupt.fd(), POLLIN, 0}}};
      const int ready = ::poll(wanted.data(), wanted.size(), deadline.left());
      if (interrupt.is_set()) return "interrupted";
      if (ready == 0)
        return "the TLS handshake took longer than `timeout`; does the device speak TLS at this port?";
    }
    if (session_.state() == tls::Session::State::open) return {};
    if (session_.problem() == tls::has_left || session_.problem() == tls::no_tls)
      return session_.problem() + " in the TLS handshake; does the device speak TLS at this port?";
    return session_.problem();
  }

  /// Returns what went wrong; empty: nothing.
  std::string carry() {
    std::array<int, 2> pair{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, pair.data()) != 0)
      return std::strerror(errno);
    carried_ = Descriptor(pair[0]);
    given_ = Descriptor(pair[1]);
    certificates_.device = {verification_.peer.name, {}, session_.peer_validity()};
    certificates_.has_pin = verification_.pin.has_value();
    session_.carry(carried_.get());
    // From here on the session is that thread's.
    try {
      thread_ = std::thread([this] { run(); });
    } catch (const std::system_error& error) {
      return what_failed(error);
    }
    return {};
  }

  Descriptor take_socket() override { return std::move(given_); }
  std::string problem() const override {
    const std::lock_guard lock(mutex_);
    return problem_;
  }

  Certificates certificates() const override { return certificates_; }

 private:
  void run() {
    while (session_.pump() == tls::Session::State::open) {
      const auto wants = session_.wants();
      // A descriptor that nothing is wanted of is left out: its end would be reported again and again.
      std::array<pollfd, 3> wanted{{{wants.socket != 0 ? socket_.get() : -1, wants.socket, 0},
                                    {wants.plain != 0 ? carried_.get() : -1, wants.plain, 0},
                                    {stop_.fd(), POLLIN, 0}}};
      ::poll(wanted.data(), wanted.size(), -1);
      if (wanted[2].revents != 0) {
        session_.pump();  // what was said last
        break;
      }
    }
    {
      const std::lock_guard lock(mutex_);
      problem_ = session_.problem();
    }
    ::shutdown(carried_.get(), SHUT_RDWR);
    ::shutdown(socket_.get(), SHUT_RDWR);
  }

  Certificates certificates_;
  Descriptor socket_;
  tls::Verification verification_;
  tls::Session session_;
  Descriptor carried_;
  Descriptor given_;
  Wakeup stop_;
  mutable std::mutex mutex_;
  std::string problem_;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<TlsLink>> open_tls(Descriptor socket, const std::string& host, const TlsTexts& tls,
                                          const Deadline& deadline, const Event& interrupt) {
  const auto failed = [](std::string why) { return fail(NotConnected{std::move(why), true}); };
  auto credentials = read_credentials({tls.certificate, tls.key, tls.ca, {}, tls.folder});
  if (!credentials) return failed(std::move(credentials).error());
  auto context = tls::Context::make(tls::Side::client, *credentials);
  if (!context) return failed(std::move(context).error());
  tls::Verification verification;
  verification.server = tls.name.empty() ? host : tls.name;
  verification.pin = tls::parse_pin(tls.pin);
  const auto subject = tls::subject_of(credentials->certificate).value_or(tls::Subject{});
  auto link = std::make_unique<TlsConnection>(std::move(socket), *context,
                                              Certificate{subject.name, subject.role, context->validity()},
                                              std::move(verification));
  if (auto problem = link->shake_hands(deadline, interrupt); !problem.empty())
    return failed(std::move(problem));
  if (auto problem = link->carry(); !problem.empty()) return failed(std::move(problem));
  return link;
}

}  // namespace coupler::host
