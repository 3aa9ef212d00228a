// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/wiring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "coupler/device/gpio/simulated_chip.hpp"
#ifdef COUPLER_WITH_GPIOD
#include "coupler/device/gpio/line_requests.hpp"
#else
#include "coupler/device/gpio/grouped_lines.hpp"
#endif

namespace coupler::device {
namespace {

/// A wiring for which nothing has to be done before it takes over.
template <class Next>
class Ready : public PreparedWiring {
 public:
  Ready(std::unique_ptr<Next> next, const Next* before) : next_(std::move(next)), before_(before) {}
  std::unique_ptr<Wiring> take_over() override {
    if (before_ != nullptr) next_->take_over(*before_);
    return std::move(next_);
  }

 private:
  std::unique_ptr<Next> next_;
  const Next* before_;
};

class Simulated : public Wiring {
 public:
  explicit Simulated(const Map& map) : chip_(map, TimePoint::clock::now()) {}
  static Prepared prepare(const Map& map, const Simulated* before) {
    return std::make_unique<Ready<Simulated>>(std::make_unique<Simulated>(map), before);
  }

  Lines& lines() override { return chip_; }
  Prepared prepare_next(const Map& map, bool, Log&) override { return prepare(map, this); }
  void take_over(const Simulated& before) { chip_.take_over(before.chip_); }

 private:
  SimulatedChip chip_;
};

#ifndef COUPLER_WITH_GPIOD
class NoLines : public Wiring {
 public:
  explicit NoLines(Log& log) : lines_({}, {}, log) {}
  static Prepared prepare(const Map& map, Log& log) {
    const auto wired =
        std::find_if(map.points.begin(), map.points.end(), [](const auto& p) { return p.line.present(); });
    if (wired == map.points.end())
      return std::make_unique<Ready<NoLines>>(std::make_unique<NoLines>(log), nullptr);
    return tl::unexpected(
        fmt::format("point '{}' has a GPIO line, but this program was built without libgpiod; "
                    "install libgpiod-dev and build again, or run with --sim",
                    wired->name));
  }

  Lines& lines() override { return lines_; }
  Prepared prepare_next(const Map& map, bool, Log& log) override { return prepare(map, log); }
  void take_over(const NoLines&) {}

 private:
  GroupedLines lines_;
};
#endif

}  // namespace

Wiring::Prepared prepare_wiring(const Map& map, bool simulated, Wiring* before, bool safe, Log& log) {
  if (before != nullptr) return before->prepare_next(map, safe, log);
  if (simulated) return Simulated::prepare(map, nullptr);
#ifdef COUPLER_WITH_GPIOD
  return LineRequests::prepare(map, nullptr, safe, log);
#else
  return NoLines::prepare(map, log);
#endif
}

}  // namespace coupler::device
