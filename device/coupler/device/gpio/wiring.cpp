// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/wiring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "coupler/device/gpio/grouped_lines.hpp"
#include "coupler/device/gpio/simulated_chip.hpp"
#ifdef COUPLER_WITH_GPIOD
#include "coupler/device/gpio/prepare_lines.hpp"
#endif

namespace coupler::device {
namespace {

/// Hardware that nobody else can have and that is always there.
template <class Hardware>
class Own : public Wiring {
 public:
  template <class... Args>
  explicit Own(Args&&... args) : hardware_(std::forward<Args>(args)...) {}
  Lines& lines() override { return hardware_; }
  Hardware& hardware() { return hardware_; }

 private:
  Hardware hardware_;
};

using Simulated = Own<SimulatedChip>;

class NextSimulated : public NextWiring {
 public:
  NextSimulated(const Map& map, Wiring* before)
      : before_(dynamic_cast<Simulated*>(before)),
        next_(std::make_unique<Simulated>(map, TimePoint::clock::now())) {}
  std::unique_ptr<Wiring> take_over() override {
    if (before_ != nullptr) next_->hardware().take_over(before_->hardware());
    return std::move(next_);
  }

 private:
  Simulated* before_;
  std::unique_ptr<Simulated> next_;
};

#ifndef COUPLER_WITH_GPIOD
class NextNothing : public NextWiring {
 public:
  explicit NextNothing(Log& log) : log_(log) {}
  std::unique_ptr<Wiring> take_over() override {
    return std::make_unique<Own<GroupedLines>>(std::vector<WiredOutputs>(), std::vector<WiredInputs>(), log_);
  }

 private:
  Log& log_;
};
#endif

}  // namespace

tl::expected<std::unique_ptr<NextWiring>, std::string> prepare_wiring(const Map& map, bool simulated,
                                                                      Wiring* before,
                                                                      [[maybe_unused]] bool safe, Log& log) {
  if (simulated) return std::make_unique<NextSimulated>(map, before);
#ifdef COUPLER_WITH_GPIOD
  return prepare_lines(map, dynamic_cast<LineRequests*>(before), safe, log);
#else
  const auto* wired =
      std::find_if(map.points.begin(), map.points.end(), [](const auto& p) { return p.line.present(); });
  if (wired == map.points.end()) return std::make_unique<NextNothing>(log);
  return tl::unexpected(
      fmt::format("point '{}' has a GPIO line, but this program was built without libgpiod; "
                  "install libgpiod-dev and build again, or run with --sim",
                  wired->name));
#endif
}

}  // namespace coupler::device
