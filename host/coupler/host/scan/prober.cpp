// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/prober.hpp"

#include <algorithm>
#include <variant>
#include <vector>

#include <fmt/format.h>

namespace coupler::scan {
namespace {

using std::chrono::milliseconds;

/// So many requests that got no reply twice: from then on none is repeated.
constexpr int certain = 3;
constexpr int busy_tries = 5;
constexpr milliseconds busy_pause{200};
/// Pauses before each attempt to connect again: small devices free a connection late.
constexpr milliseconds connect_pauses[] = {milliseconds(0), milliseconds(250), milliseconds(1000),
                                           milliseconds(3000)};

bool is_busy(const Reply& reply) {
  return reply.kind == Reply::Kind::refused && (reply.exception == modbus::Exception::acknowledge ||
                                                reply.exception == modbus::Exception::server_device_busy);
}

}  // namespace

Prober::Prober(Client& client, host::Clock& clock, const ScanProgress& progress, double rate)
    : client_(client),
      clock_(clock),
      progress_(progress),
      gap_(std::chrono::duration_cast<host::Duration>(std::chrono::duration<double>(1 / rate))),
      ready_(clock.now()) {}

Result<> Prober::connect() {
  auto result = client_.connect();
  connected_ = result.has_value();
  return result;
}

bool Prober::reconnect() {
  Result<> result;
  for (const milliseconds wait : connect_pauses) {
    if (wait.count() > 0) clock_.sleep_until(clock_.now() + wait);
    if (progress_.wants_end()) return false;
    pause();
    if (result = connect(); result) return true;
  }
  if (!progress_.wants_end()) broke_off_ = result.error();
  return false;
}

void Prober::pause() {
  clock_.sleep_until(ready_);
  ready_ = clock_.now() + gap_;
}

bool Prober::is_ready() {
  if (progress_.wants_end() || broke_off_ || (!connected_ && !reconnect())) return false;
  pause();
  return !progress_.wants_end();
}

template <class Request>
Reply Prober::attempt(Request&& request) {
  if (!is_ready()) return {};
  ++requests_;
  const Result<> result = request();
  if (result) return {Reply::Kind::given};
  if (const auto* exception = host::exception_in(result.error()))
    return {Reply::Kind::refused, exception->code};
  client_.close();
  connected_ = false;
  if (progress_.wants_end()) return {};
  if (has_remedy(result.error())) {  // the next request would have the same answer
    broke_off_ = result.error();
    return {};
  }
  ++failures_[host::to_string(result.error())];
  return {Reply::Kind::none, {}, std::holds_alternative<host::Timeout>(result.error())};
}

template <class Request>
Reply Prober::ask(Request&& request, bool once) {
  Reply reply = attempt(request);
  for (int tries = 1; is_busy(reply) && tries < busy_tries; ++tries) {
    clock_.sleep_until(clock_.now() + busy_pause * tries);
    reply = attempt(request);
  }
  if (reply.kind != Reply::Kind::none || once || confirmed_ == certain) return reply;
  reply = attempt(request);
  confirmed_ = reply.kind == Reply::Kind::none ? confirmed_ + 1 : 0;
  return reply;
}

Reply Prober::try_read(Table table, modbus::Range range, std::uint16_t* values) {
  return ask([&] { return client_.read(table, range, values); }, true);
}

Reply Prober::read(Table table, modbus::Range range, std::uint16_t* values) {
  return ask([&] { return client_.read(table, range, values); }, false);
}

Reply Prober::identify(modbus::ReadDeviceIdentification wanted, IdentificationPage& page) {
  const auto request = [&]() -> Result<> {
    auto got = client_.identify(wanted);
    if (!got) return tl::make_unexpected(got.error());
    page = std::move(*got);
    return {};
  };
  return ask(request, true);
}

std::vector<std::string> Prober::failures() const {
  std::vector<std::string> texts;
  texts.reserve(failures_.size());
  for (const auto& [text, times] : failures_)
    texts.push_back(times == 1 ? text : fmt::format("{} ({} times)", text, times));
  return texts;
}

}  // namespace coupler::scan
