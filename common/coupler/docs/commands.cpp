// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/document.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/docs/words.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::docs {
namespace {

using codec::Order;
using codec::Type;

/// Returns a text as one word of a POSIX shell, since the map's address and file name are any text.
std::string quoted(std::string_view text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string_view::npos) return std::string(text);
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// mbpoll's type, "4:float -B", and how many of it; registers in hexadecimal if it has none that fits.
std::string mbpoll_type(const Point& point) {
  constexpr std::array<int, tables.size()> number{0, 1, 3, 4};  // in the order of Table
  const int table = number[index(point.table)];
  if (holds_bits(point.table)) return fmt::format("{} -c {}", table, point.count);
  const Type type = point.format.type;
  const Order order = point.format.order;
  const bool wide = type == Type::DINT || type == Type::UDINT || type == Type::REAL;
  if (wide && !codec::bytes_swapped(order))
    return fmt::format("{}:{}{} -c {}", table, type == Type::REAL ? "float" : "int",
                       order == Order::ABCD ? " -B" : "", point.count);
  if ((type == Type::INT || type == Type::UINT) && order == Order::ABCD)
    return fmt::format("{} -c {}", table, point.count);
  return fmt::format("{}:hex -c {}", table, range(point).count());
}

std::string example_value(const Point& point) {
  if (point.format.type == Type::STRING) return "text";
  return point.format.type == Type::BOOL ? "true" : "1";
}

template <class Rule>
const Point* first(const Map& map, Rule&& rule) {
  const auto found = std::find_if(map.points.begin(), map.points.end(), rule);
  return found == map.points.end() ? nullptr : &*found;
}

}  // namespace

std::vector<Command> mbpoll_commands(const Map& map) {
  const Connection& at = map.connection;
  const std::string host = at.address.empty() ? "HOST" : quoted(at.address);
  const Serial& line = at.serial;
  const std::string where = line.present() ? fmt::format("rtu -b {} -P {} -s {} -1 -0 -a {}", line.baud,
                                                         to_string(line.parity), line.stop_bits, at.unit)
                                           : fmt::format("tcp -1 -0 -a {} -p {}", at.unit, at.port);
  std::vector<Command> commands;
  for (const Table table : tables) {
    const Point* point = first(map, [&](const Point& p) {
      return p.table == table && is_readable(p) && plan::read_extent(map, p) == read_range(p);
    });
    if (point == nullptr) continue;
    commands.push_back(
        {fmt::format("{} of the {}", point->name, words(table)),
         fmt::format("mbpoll -m {} -t {} -r {} {}", where, mbpoll_type(*point), read_range(*point).start(),
                     line.present() ? quoted(line.device) : host)});
  }
  return commands;
}

std::vector<Command> ros_commands(const Map& map, const std::string& file) {
  std::vector<Command> commands{
      {"every point as a topic", fmt::format("coupler_driver --map {}", quoted(file))}};
  if (const Point* point = first(map, [](const Point& p) { return is_readable(p); })) {
    const std::string topic = fmt::format("/{}/{}", map.name, point->name);
    commands.push_back({"one point as it is read, in ROS 2", "ros2 topic echo " + topic});
    commands.push_back({"the same in ROS 1", "rostopic echo " + topic});
  }
  constexpr std::string_view std_msgs = "std_msgs/";
  // Messages of several values need a layout or a list of the right length: no line to begin with.
  const auto single = [&](const Point& p) {
    return is_writable(p) && p.count == 1 && starts_with(ros_message(p), std_msgs) &&
           tool_with_output(map, p.name) == nullptr;
  };
  if (const Point* point = first(map, single)) {
    const std::string topic = fmt::format("/{}/{}/write", map.name, point->name);
    const std::string message = ros_message(*point);
    const std::string value = example_value(*point);
    commands.push_back({"one point is written, in ROS 2",
                        fmt::format("ros2 topic pub --once {} std_msgs/msg/{} '{{data: {}}}'", topic,
                                    message.substr(std_msgs.size()), value)});
    commands.push_back(
        {"the same in ROS 1", fmt::format("rostopic pub --once {} {} {}", topic, message, value)});
  }
  if (!map.tools.empty()) {
    const std::string service = fmt::format("/{}/{}/close", map.name, map.tools[0].name);
    commands.push_back(
        {"a tool is closed, in ROS 2", fmt::format("ros2 service call {} std_srvs/srv/Trigger", service)});
    commands.push_back({"the same in ROS 1", "rosservice call " + service});
  }
  return commands;
}

}  // namespace coupler::docs
