// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/device/core/hooks.hpp"
#include "coupler/device/core/log.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// A firmware's hooks. An exception that one throws is logged and ends no process; the request that it was
/// called for is refused.
class GuardedHooks final : public Hooks {
 public:
  /// All of them outlive it; the map is the one whose points `hooks` is behind.
  GuardedHooks(Hooks& hooks, const Map& map, Log& log) : hooks_(hooks), map_(map), log_(log) {}

  /// This process serves from now on: values can be set in it, of which `waker` is told. False:
  /// serving_began() threw.
  [[nodiscard]] bool begin(Waker* waker);
  /// Nobody serves: make_safe(), and what it sets is put into the image. False: it threw.
  [[nodiscard]] bool end(Image& image);

  void put_new_values(Image& image, Changes& changes) override { hooks_.put_new_values(image, changes); }
  [[nodiscard]] bool accept(std::uint32_t point, const std::uint16_t* registers) override;
  [[nodiscard]] bool shows_identity() const noexcept override { return hooks_.shows_identity(); }
  [[nodiscard]] Span<const WantedOutput> take_wanted_outputs() override {
    return hooks_.take_wanted_outputs();
  }
  void not_driven(const WantedOutput& wanted, bool watchdog) override;
  [[nodiscard]] bool hears_lines() const noexcept override { return hooks_.hears_lines(); }
  [[nodiscard]] bool take_level(std::uint32_t point, bool level, bool is_news) override;
  [[nodiscard]] bool answers() override;
  [[nodiscard]] std::optional<modbus::Exception> refuse_read(Table table, modbus::Range range) override;
  [[nodiscard]] std::string_view why_it_ends() const noexcept override { return hooks_.why_it_ends(); }
  void make_safe() override { (void)made_safe(); }

 private:
  bool made_safe();
  void log(const std::string& who, const char* what);
  void log_limited(const std::string& who, const std::string& what);

  Hooks& hooks_;
  const Map& map_;
  Log& log_;
};

}  // namespace coupler::device
