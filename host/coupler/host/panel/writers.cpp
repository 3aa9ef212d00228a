// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/writers.hpp"

#include <algorithm>
#include <iterator>

namespace coupler::host {

void Writers::alive(std::string_view page, Time now) {
  if (const auto found = heard_.find(page); found != heard_.end()) found->second = now;
}

void Writers::left(std::string_view page) {
  if (const auto found = heard_.find(page); found != heard_.end()) found->second = Time::min();
}

bool Writers::are_gone(Time now) {
  const Duration unheard = std::max(now - std::min(looked_, now) - longest_turn, Duration::zero());
  looked_ = now;
  if (heard_.empty()) return false;
  for (auto& [page, at] : heard_)
    if (at != Time::min()) at = std::min(at + unheard, now);
  for (auto it = heard_.begin(); it != heard_.end();)
    it = it->second < now - longest_silence ? heard_.erase(it) : std::next(it);
  return heard_.empty();
}

}  // namespace coupler::host
