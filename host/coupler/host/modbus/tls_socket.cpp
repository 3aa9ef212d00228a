// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/tls_socket.hpp"

#include <poll.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <utility>

#include "coupler/credentials/credentials.hpp"
#include "coupler/tls/alert.hpp"
#include "coupler/tls/issue.hpp"
#include "coupler/tls/stream.hpp"

namespace coupler::host {
namespace {

class StreamSocket final : public TlsSocket {
 public:
  StreamSocket(const tls::Context& context, int socket, tls::Verification verification, Certificate own)
      : stream_(context, socket, std::move(verification)), certificates_{std::move(own), {}, false} {}
  StreamSocket(const StreamSocket&) = delete;
  StreamSocket& operator=(const StreamSocket&) = delete;
  ~StreamSocket() override { stream_.close(); }

  /// Returns what went wrong; empty: nothing.
  std::string shake_hands(int socket, const Deadline& deadline, const Event& interrupt) {
    for (;;) {
      const tls::Stream::Progress shaken = stream_.shake_hands();
      if (shaken.bytes > 0) break;
      if (shaken.wants == 0) return handshake_problem();
      std::array<pollfd, 2> wanted{{{socket, shaken.wants, 0}, {interrupt.fd(), POLLIN, 0}}};
      const int ready = ::poll(wanted.data(), wanted.size(), deadline.left());
      if (interrupt.is_set()) return "interrupted";
      if (ready == 0)
        return "the TLS handshake took longer than `timeout`; does the device speak TLS at this port?";
    }
    certificates_.device = {stream_.verification().peer.name, {}, stream_.peer_validity()};
    certificates_.has_pin = stream_.verification().pin.has_value();
    return {};
  }

  ssize_t receive(Span<std::uint8_t> room) override {
    const tls::Stream::Progress got = stream_.read(room.data(), room.size());
    has_pending_ = stream_.has_pending();
    return result(got, POLLIN);
  }
  ssize_t send(modbus::Bytes bytes) override {
    return result(stream_.write(bytes.data(), bytes.size()), POLLOUT);
  }
  bool has_pending() const override { return has_pending_; }
  std::string problem() const override { return is_stuck_ ? stuck : stream_.problem(); }
  Certificates certificates() const override { return certificates_; }

 private:
  static constexpr const char* stuck =
      "the device keeps sending messages of TLS itself, and does not read the answers to them";

  std::string handshake_problem() const {
    const std::string& problem = stream_.problem();
    if (problem == tls::has_left || problem == tls::no_tls)
      return problem + " in the TLS handshake; does the device speak TLS at this port?";
    return problem;
  }

  /// `waits_for`: the event after which the call can be made again.
  ssize_t result(const tls::Stream::Progress& progress, short waits_for) {
    if (progress.bytes > 0) return progress.bytes;
    if (progress.wants == 0 && waits_for == POLLIN && stream_.problem().empty()) return 0;
    // The caller polls for `waits_for` only: after EAGAIN it would find the socket ready and come back here,
    // without end. So this is an error.
    is_stuck_ |= progress.wants != 0 && progress.wants != waits_for;
    errno = progress.wants == waits_for ? EAGAIN : EPIPE;
    return -1;
  }

  tls::Stream stream_;
  Certificates certificates_;
  std::atomic<bool> has_pending_{false};
  bool is_stuck_ = false;
};

}  // namespace

Result<std::unique_ptr<TlsSocket>> open_tls(int socket, const std::string& host, const TlsTexts& tls,
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
  auto opened = std::make_unique<StreamSocket>(*context, socket, std::move(verification),
                                               Certificate{subject.name, subject.role, context->validity()});
  if (auto problem = opened->shake_hands(socket, deadline, interrupt); !problem.empty())
    return failed(std::move(problem));
  return opened;
}

}  // namespace coupler::host
