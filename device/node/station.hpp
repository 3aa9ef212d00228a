// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "device/keeper/charge.hpp"
#include "device/net/signals.hpp"
#include "device/node/duty.hpp"
#include "device/node/options.hpp"
#include "device/node/service_manager.hpp"

namespace coupler::node {

/// Reads the map again; null after telling what is wrong with it.
using ReadAgain = std::function<MapPtr()>;

/// Why a map is not served.
struct Refusal {
  enum Reason : int { map_is_wrong = 1, device_failed = 3 };
  Reason reason;       ///< also the exit status
  std::string errors;  ///< one a line
};

/// Says each line.
void tell(Log& log, const Refusal& refusal);

/// A node with the map in force, which may be replaced by another one while masters are served.
class Station final : public Charge {
 public:
  /// `read_again` is empty if the map is built in, `hooks` null if no code is bound to its points. All of
  /// them outlive it.
  Station(const Options& options, ReadAgain read_again, ServiceManager& manager, Log& log,
          Hooks* hooks = nullptr)
      : options_(options), read_again_(std::move(read_again)), manager_(manager), log_(log), hooks_(hooks) {}

  /// Puts the first map in force; it outlives the station.
  tl::expected<void, Refusal> start(const Map& map);

  /// Whether somebody has to hold its lines: simulated ones fall nowhere.
  bool needs_keeper() const;
  /// Answers masters in this process until a signal asks to stop; then whether every output is in its safe
  /// state. nullopt: the map, or one that came meanwhile, needs a keeper, and `clients` are connected.
  std::optional<bool> serve_alone(Loop& loop, Signals& signals, std::vector<OpenConnection>& clients);

  int serve(Superior& superior, std::vector<OpenConnection> clients) override;
  bool reload() override;
  bool look_after(TimePoint now) override;
  void change(std::vector<OpenConnection>& clients) override;
  bool make_safe() override;

 private:
  tl::expected<std::unique_ptr<Duty>, Refusal> prepare(const Map& map, MapPtr owner);
  tl::expected<Listener, std::string> listen(const std::string& address, std::uint16_t port);
  std::string greeting() const;

  const Options& options_;
  ReadAgain read_again_;
  ServiceManager& manager_;
  Log& log_;
  Hooks* hooks_;
  std::unique_ptr<Duty> duty_;
  std::unique_ptr<Duty> next_;  ///< waits for change()
};

}  // namespace coupler::node
