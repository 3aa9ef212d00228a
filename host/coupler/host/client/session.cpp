// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/client/session.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/modbus/make_transports.hpp"
#include "coupler/map/loader/load.hpp"

namespace coupler::client {
namespace {

Map moved(Map map, const Options& options) {
  if (!options.address.empty()) map.connection.address = options.address;
  if (options.port) map.connection.port = *options.port;
  return map;
}

std::unique_ptr<host::Transport> make_transport(const Map& map) {
  return std::move(host::make_transports({map}).front());
}

}  // namespace

struct Session::Link {
  Link(const Map& map, Verify verify, host::Sink& sink)
      : transport(make_transport(map)), thread(map, verify, load_served_map, *transport, sink) {}

  std::unique_ptr<host::Transport> transport;
  host::DeviceThread thread;
};

std::string to_string(const NoValue& why) {
  if (why.quality == Quality::never_read) return "was not read yet";
  if (why.quality == Quality::offline) return "was not read yet: the device does not answer";
  return fmt::format("cannot be read: {}",
                     why.exception ? host::to_string(host::Error(host::ExceptionReply{*why.exception}))
                                   : std::string(host::to_string(why.quality)));
}

Session::Session(const Map& map, Options options)
    : options_(std::move(options)), map_(moved(map, options_)), values_(map_) {}

Session::~Session() { disconnect(); }

void Session::connect() {
  const std::unique_lock lock(link_mutex_);
  host::Sink& news = *this;
  if (!link_) link_ = std::make_unique<Link>(map_, options_.verify, news);
}

void Session::disconnect() {
  std::unique_ptr<Link> link;
  {
    const std::unique_lock lock(link_mutex_);
    link = std::move(link_);
  }
  link.reset();  // outside the lock: callbacks that are on their way may set points
}

bool Session::online() const {
  const std::lock_guard lock(online_mutex_);
  return online_;
}

bool Session::wait_online(std::chrono::milliseconds at_most) const {
  std::unique_lock lock(online_mutex_);
  return came_online_.wait_for(lock, at_most, [this] { return online_; });
}

tl::expected<Session::Sample, NoValue> Session::judge(std::uint32_t point,
                                                      std::optional<LastValues::Value> value) const {
  const host::PointQuality known = quality(point);
  if (!value) return tl::unexpected(NoValue{known.state, known.last_exception});
  // A value is here a moment before its quality is.
  const Quality state = known.state == Quality::never_read ? Quality::good : known.state;
  return Sample{std::move(value->registers), state, std::chrono::steady_clock::now() - value->at};
}

host::PointQuality Session::quality(std::uint32_t point) const {
  const std::shared_lock lock(link_mutex_);
  return link_ ? link_->thread.quality(point) : host::PointQuality{Quality::offline};
}

PendingWrite Session::write(host::Write& write) {
  PendingWrite pending = listen_to(write);
  const std::shared_lock lock(link_mutex_);
  if (link_) {
    link_->thread.write(write);
  } else {
    host::WriteResult result;
    result.outcome = SetResult::Outcome::dropped;
    result.why = "not connected; call connect() first";
    write.listener->on_result(result);
  }
  return pending;
}

void Session::on_bits(const host::ReadSpan& span, Span<const std::uint8_t> bits, host::Time at) {
  std::copy(bits.begin(), bits.end(), bits_.begin());
  on_registers(span, {bits_.data(), bits.size()}, at);
}

void Session::on_registers(const host::ReadSpan& span, Span<const std::uint16_t> registers, host::Time at) {
  values_.bring(span, registers, at);
}

void Session::on_online(bool online) {
  const std::lock_guard lock(online_mutex_);
  online_ = online;
  came_online_.notify_all();
}

void Session::on_report(Level level, const std::string& text) {
  if (options_.on_report) options_.on_report(level, text);
}

PendingWrite PointHandle::write(const std::uint16_t* registers) {
  host::Write write;
  write.point = index_;
  const std::size_t count = range(point()).count();
  if (holds_bits(point().table)) {
    for (std::size_t i = 0; i < count; ++i)
      if (registers[i] != 0) write.set_bit(i);
  } else {
    std::copy(registers, registers + count, write.registers.begin());
  }
  return session_.write(write);
}

}  // namespace coupler::client
