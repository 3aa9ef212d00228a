// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/change_watch.hpp"

#include <algorithm>
#include <utility>

namespace coupler::cli {

using host::Result;

namespace {

/// A gateway may let no such question through, and ends the connection then.
constexpr int most_unheard = 2;

}  // namespace

ChangeWatch::ChangeWatch(const Map& map, host::Link& link, host::DeviceStatistics& statistics, Use use,
                         Note note)
    : wanted_(map.changes && use),
      link_(link),
      clock_(link.clock()),
      use_(std::move(use)),
      note_(std::move(note)),
      listener_(map.connection.timeout, link, statistics, *this, *this) {}

Result<> ChangeWatch::start(bool is_node) {
  listener_.stop();
  if (!wanted_ || !is_node || !link_.can_wait()) return {};
  const Result<identity::Further> node = host::read_further(link_);
  if (!node) return tl::make_unexpected(node.error());
  if (!node->functions.tells_changes) return {};
  if (unheard_ >= most_unheard) {
    note_(
        "the node says that it tells changes, but the question for them ended two connections: it is polled");
    return {};
  }
  listener_.start(std::chrono::milliseconds(node->watchdog_timeout));
  return listener_.step();
}

void ChangeWatch::lost() {
  if (is_active()) unheard_ = listener_.has_heard() ? 0 : unheard_ + 1;
  listener_.stop();
}

Result<> ChangeWatch::wait_until(host::Time time) {
  while (is_active() && !std::exchange(missed_, false) && clock_.now() < time) {
    if (listener_.asks_for_watchdog()) {
      const Result<identity::Further> further = host::read_further(link_);
      if (!further) return tl::make_unexpected(further.error());
      listener_.set_watchdog(std::chrono::milliseconds(further->watchdog_timeout));
    }
    if (auto asked = listener_.step(); !asked) return asked;
    switch (link_.wait_until(std::min(time, listener_.due()))) {
      case host::Woken::by_time: break;
      case host::Woken::by_call: return {};
      case host::Woken::by_bytes:
        if (auto done = listener_.is_waiting() ? listener_.receive() : link_.discard_unasked(); !done)
          return done;
    }
  }
  return {};
}

void ChangeWatch::on_change(const modbus::Change& change, std::uint64_t /*number*/, host::Stamp stamp) {
  if (change.is_bit()) use_(change, stamp);
}

}  // namespace coupler::cli
