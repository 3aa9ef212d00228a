// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/waiters.hpp"

#include <algorithm>

#include "coupler/device/net/connection.hpp"

namespace coupler::device {

void Waiters::remove(const Connection& connection) {
  const auto found = std::find_if(all_.begin(), all_.end(),
                                  [&](const Waiter& waiter) { return waiter.connection == &connection; });
  if (found == all_.end()) return;
  *found = all_.back();
  all_.pop_back();
}

std::optional<TimePoint> Waiters::due() const {
  if (all_.empty()) return std::nullopt;
  if (is_news()) return TimePoint{};
  return std::min_element(all_.begin(), all_.end(),
                          [](const Waiter& a, const Waiter& b) { return a.until < b.until; })
      ->until;
}

void Waiters::answer(TimePoint now) {
  const auto due = this->due();
  const bool is_news = this->is_news();
  told_ = server_.changes().ring().newest();
  if (!due || *due > now) return;
  // From the end: who is answered leaves its place to the last one, and whoever waits again comes behind it.
  for (std::size_t i = all_.size(); i-- > 0;)
    if (is_news || all_[i].until <= now) all_[i].connection->answer_wait(now);
}

}  // namespace coupler::device
