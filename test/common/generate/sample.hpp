// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coupler/generate/generate.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::testing {

using namespace std::chrono_literals;

/// Where its generated files come from.
inline const generate::Provenance provenance{"cell", "cell.yaml", "1.2.3"};

/// A small map with something in every field that the generator writes.
inline std::shared_ptr<const OwnedMap> sample() {
  auto owned = std::make_shared<OwnedMap>();
  Point lamp;
  lamp.name = "lamp";
  lamp.table = Table::coils;
  lamp.address = 3;
  lamp.access = Access::read_write;
  lamp.initial = owned->keep(std::vector<std::uint16_t>{1});
  lamp.safe = Safe::hold;
  lamp.line = {"gpiochip0", 17, "", true, Bias::pull_up, Drive::open_drain, 0us};
  lamp.description = "Lamp above the door";
  Point button;
  button.name = "button";
  button.table = Table::discrete_inputs;
  button.line = {"", 0, "GPIO4", false, Bias::as_is, Drive::push_pull, 5000us};
  Point level;
  level.name = "tank/level";
  level.table = Table::input_registers;
  level.address = 100;
  level.format = {codec::Type::REAL, codec::Order::CDAB};
  level.units = "°C";
  Point label;
  label.name = "label";
  label.table = Table::holding_registers;
  label.address = 7;
  label.format = {codec::Type::STRING, codec::Order::BADC, codec::Half::high, 0, 3, codec::Encoding::latin1};
  label.access = Access::write;
  label.initial = owned->keep(std::vector<std::uint16_t>{0x6261, 0x0063});
  Point flag;
  flag.name = "flag";
  flag.table = Table::holding_registers;
  flag.address = 9;
  flag.format = {codec::Type::BOOL, codec::Order::ABCD, codec::Half::high, 12};
  flag.latched = {"button", Edge::both};
  Point parts;
  parts.name = "parts";
  parts.table = Table::holding_registers;
  parts.address = 10;
  parts.format = {codec::Type::UDINT, codec::Order::ABCD};
  parts.counter = {"button", Edge::falling};

  Map head;
  head.name = "cell";
  head.connection = {"cell.local", 1502, 7, 250ms};
  head.polling = {2.5, true, 65, false, 13};
  head.limits = {100, 1000, 90, 900, 2ms, 3ms, 4, true};
  head.text = "name: cell\nrest: \"ü?\?/\\\"";
  const auto allow = owned->keep(std::vector<std::string_view>{"10.0.0.7", "fd00::/8"});
  head.service = {"::1", allow, {500ms, Watchdog::FedBy::write, Watchdog::Recovery::manual}, true};
  Tool clamp;
  clamp.name = "clamp";
  clamp.close = "lamp";
  clamp.closed = "button";
  clamp.travel = 300ms;
  clamp.positions.open = 0.04;
  clamp.on_cancel = OnCancel::open;
  head.tools = owned->keep(std::vector<Tool>{clamp});
  Axis glue;
  glue.name = "glue";
  glue.point = "flag";
  glue.joint = "glue_joint";
  glue.positions = owned->keep(std::vector<AxisPosition>{{1, -0.5}, {0, 0.25}});
  Axis flow;
  flow.name = "flow";
  flow.point = "level";
  head.axes = owned->keep(std::vector<Axis>{glue, flow});
  owned->finish(head, {lamp, button, level, label, flag, parts},
                {{"lamp", "button", true, 0us}, {"", "button", false, 1000000us}});
  return owned;
}

}  // namespace coupler::testing
