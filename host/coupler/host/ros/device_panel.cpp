// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/device_panel.hpp"

#include <chrono>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "coupler/base/what_failed.hpp"
#include "coupler/host/panel/panel_points.hpp"
#include "coupler/host/panel/panel_server.hpp"

namespace coupler::host {
namespace {

constexpr std::chrono::seconds told_period{1};

class DevicePanel final : public Follower {
 public:
  DevicePanel(const Map& map, const ValueTable& table)
      : values_(map, table, [](Level, const std::string&) {}) {}  // it is logged

  /// Empty, or why not.
  std::string serve(const Map& map, unsigned port) {
    if (port > std::numeric_limits<std::uint16_t>::max()) return fmt::format("there is no port {}", port);
    try {
      auto server = PanelServer::start({"127.0.0.1", static_cast<int>(port)}, nullptr,
                                       panel_points(map, false, {}), values_, device_);
      if (!server) return server.error();
      server_ = *std::move(server);
      return {};
    } catch (const std::system_error& error) {  // the device can do without
      return what_failed(error);
    }
  }
  std::string url() const { return server_->url(); }

  Sink& sink() override { return values_; }
  void report(const DeviceSnapshot& device, Time now) override {
    if (now < told_ + told_period) return;
    told_ = now;
    values_.tell(device);
  }

 private:
  LiveValues values_;
  PanelDevice device_;
  std::unique_ptr<PanelServer> server_;
  Time told_{};
};

}  // namespace

std::unique_ptr<Follower> start_panel(const Map& map, const ValueTable& table, unsigned port,
                                      const std::function<void(Level, const std::string&)>& report) {
  auto panel = std::make_unique<DevicePanel>(map, table);
  if (const std::string problem = panel->serve(map, port); !problem.empty()) {
    report(Level::error, problem + "; there is no panel");
    return nullptr;
  }
  report(Level::info, "panel: " + panel->url());
  return panel;
}

}  // namespace coupler::host
