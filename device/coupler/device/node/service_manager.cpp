// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "coupler/device/supervisor/heartbeat.hpp"

namespace coupler::device {
namespace {

/// A path, or with a leading @ a name in the kernel's own space. Closed if there is no such socket.
Descriptor connect_to(std::string_view name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (name.empty() || name.size() >= sizeof address.sun_path) return {};
  std::copy(name.begin(), name.end(), address.sun_path);
  if (name.front() == '@') address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  Descriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!socket.is_open() || ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0)
    return {};
  return socket;
}

/// Beats in half of the time that the manager waits for a sign of life, in µs.
unsigned interval_for(const char* watchdog) {
  using std::chrono::microseconds;
  const microseconds wait(watchdog == nullptr ? 0 : std::strtoll(watchdog, nullptr, 10));
  if (wait.count() <= 0) return 0;
  return static_cast<unsigned>(std::max<std::int64_t>(1, wait / 2 / heartbeat_period));
}

}  // namespace

ServiceManager::ServiceManager(const char* socket, const char* watchdog)
    : socket_(connect_to(socket == nullptr ? "" : socket)), interval_(interval_for(watchdog)) {}

void ServiceManager::beat() {
  if (!std::exchange(is_ready_, true)) ready(status_);
  if (interval_ == 0 || ++beats_ < interval_) return;
  beats_ = 0;
  send("WATCHDOG=1");
}

void ServiceManager::reloading(TimePoint now) {
  using std::chrono::microseconds;
  send("RELOADING=1\nMONOTONIC_USEC=" +
       std::to_string(std::chrono::duration_cast<microseconds>(now.time_since_epoch()).count()));
}

void ServiceManager::ready(std::string status) {
  status_ = std::move(status);
  send("READY=1\nSTATUS=" + status_);
}

void ServiceManager::stopping() { send("STOPPING=1"); }

void ServiceManager::send(std::string_view state) {
  if (is_there()) ::send(socket_.get(), state.data(), state.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace coupler::device
