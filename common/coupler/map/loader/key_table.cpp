// SPDX-License-Identifier: Apache-2.0
#include "coupler/base/enumeration.hpp"
#include "coupler/map/loader/address.hpp"
#include "coupler/map/loader/keys.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::loader {
namespace {

using K = ValueKind;
using S = Section;

/// A row of the table.
struct KeyRow : Key {
  constexpr explicit KeyRow(Key essentials) : Key(essentials) {}

  template <class T>
  constexpr KeyRow with(T Key::*member, T value) const {
    KeyRow row = *this;
    row.*member = value;
    return row;
  }
  constexpr KeyRow within(double from, double to) const {
    return with(&Key::least, from).with(&Key::most, to);
  }
  template <class E>
  constexpr KeyRow one_of() const {
    return with(&Key::choices, JoinedWords<E>::text());
  }
  constexpr KeyRow or_bits() const { return with(&Key::bits, true); }
  constexpr KeyRow spells(std::string_view other) const { return with(&Key::same_as, other); }
  constexpr KeyRow holds(Section section) const { return with(&Key::inside, section); }
  constexpr KeyRow lists(Section section) const { return holds(section).with(&Key::several, true); }
  constexpr KeyRow needed() const { return with(&Key::required, true); }
  constexpr KeyRow needed_with(std::string_view other) const { return with(&Key::required_with, other); }
  constexpr KeyRow needless_with(std::string_view other) const { return with(&Key::needless_with, other); }
  constexpr KeyRow only_for(std::string_view point_types) const { return with(&Key::types, point_types); }
  constexpr KeyRow otherwise(std::string_view value) const { return with(&Key::fallback, value); }
};

constexpr KeyRow inherited(std::string_view name, S sections, K kind, std::string_view example,
                           std::string_view summary) {
  return KeyRow({name, sections, kind, Owner::inherited, example, summary});
}
constexpr KeyRow project(std::string_view name, S sections, K kind, std::string_view example,
                         std::string_view summary) {
  return KeyRow({name, sections, kind, Owner::project, example, summary});
}

/// One of `limits:`, which is the most that Modbus has if not given.
constexpr KeyRow limit(std::string_view name, std::string_view text, double most, std::string_view summary) {
  return project(name, S::limits, K::integer, text, summary).otherwise(text).within(1, most);
}

constexpr S bits = S::coil | S::discrete_input;
constexpr S registers = S::input_register | S::holding_register;
constexpr S point = bits | registers;
constexpr S line = S::coil_line | S::input_line;
constexpr S treatment = point | S::defaults;
constexpr S writing = S::coil | S::holding_register | S::defaults;

constexpr std::string_view byte_types = "BYTE|SINT|USINT|CHAR";
constexpr std::string_view float_types = "REAL|LREAL";
constexpr double most_address = 65535;
constexpr double most_seconds = 3600;
constexpr double most_double = std::numeric_limits<double>::max();

constexpr Key keys[] = {
    // The map: the keys of ros-modbus-device-driver.
    inherited("name", S::map, K::ros_name, "press", "namespace of the topics").needed(),
    inherited("address", S::map, K::host, "192.168.0.10", "host name or IP address of the device"),
    inherited("port", S::map, K::integer, "502", "TCP port").otherwise("502").within(1, 65535),
    inherited("unit", S::map, K::integer, "1", "unit id").otherwise("1").within(0, 255),
    inherited("timeout", S::map, K::seconds, "3", "longest wait for a reply")
        .otherwise("3")
        .within(0.001, most_seconds),
    inherited("rate", S::map, K::number, "10", "polling rate in Hz").otherwise("10").within(0.001, 10000),
    inherited("byteorder_reverse", S::map, K::boolean, "false", "the low byte of a register comes first")
        .otherwise("false"),
    inherited("wordorder_reverse", S::map, K::boolean, "false", "the most significant register comes first")
        .otherwise("false"),
    inherited("discrete_read_continuous", S::map, K::boolean, "false", "unmapped bits may be read, too")
        .otherwise("false"),
    inherited("discrete_read_separation_gap", S::map, K::integer, "64", "gap from which bits are read apart")
        .otherwise("64")
        .within(0, most_address),
    inherited("registers_read_continuous", S::map, K::boolean, "false", "unmapped registers may be read, too")
        .otherwise("false"),
    inherited("registers_read_separation_gap", S::map, K::integer, "12",
              "gap from which registers are read apart")
        .otherwise("12")
        .within(0, most_address),
    inherited("register_read_separation_gap", S::map, K::integer, "12", "another spelling")
        .spells("registers_read_separation_gap")
        .within(0, most_address),
    inherited("mapping", S::map, K::section, "{coils: {valve: 0}}", "the points, by table")
        .holds(S::mapping)
        .needed(),
    // The map: this project's keys.
    project("addressing", S::map, K::choice, "modicon", "what the addresses count")
        .otherwise("zero_based")
        .one_of<Addressing>(),
    project("framing", S::map, K::choice, "rtu", "what frames at the address look like")
        .otherwise("tcp")
        .one_of<Framing>(),
    project("serial", S::map, K::section, "{device: /dev/ttyUSB0}",
            "the serial port to the device, instead of an address")
        .holds(S::serial),
    project("tls", S::map, K::section, "{certificate: cell1.pem, key: cell1.key, ca: authority.pem}",
            "how this machine proves itself to the device, and the device to it")
        .holds(S::tls),
    project("preset", S::map, K::preset, "wago_750", "a kind of coupler, and what is true of all of them"),
    project("limits", S::map, K::section, "{read_registers: 64}", "what the device takes in one request")
        .holds(S::limits),
    project("sim", S::map, K::section, "[{from: valve, to: valve_is_open}]", "wires of the simulated chip")
        .lists(S::wire),
    project("reserve", S::map, K::section, "[{table: coils, from: 8, to: 15}]", "addresses kept free")
        .lists(S::area),
    project("listen", S::map, K::ip_address, "127.0.0.1", "interface of the node"),
    project("allow", S::map, K::list, "[192.168.0.0/24, 10.0.0.7]", "who may connect to the node"),
    project("watchdog", S::map, K::section, "{timeout: 500ms}", "safe state when the client is silent")
        .holds(S::watchdog),
    project("security", S::map, K::section, "{roles: {viewer: {read: all}}, plain: viewer}",
            "who may read and write which points of the node")
        .holds(S::security),
    project("readback", S::map, K::boolean, "true", "compare a line's level after driving it")
        .otherwise("false"),
    // The tables.
    inherited("coils", S::mapping, K::points, "{valve: 0}", "bits that can be written").holds(S::coil),
    inherited("discrete_inputs", S::mapping, K::points, "{button: 0}", "bits that can be read")
        .holds(S::discrete_input),
    inherited("input_registers", S::mapping, K::points, "{weight: {address: 0, type: INT}}",
              "registers that can be read")
        .holds(S::input_register),
    inherited("holding_registers", S::mapping, K::points, "{speed: {address: 0, type: INT}}",
              "registers that can be written")
        .holds(S::holding_register),
    // Points.
    inherited("address", point, K::address, "0", "where the point is in its table"),
    inherited("type", registers, K::type, "INT", "data type of IEC 61131-3").needed().one_of<codec::Type>(),
    inherited("offset", registers, K::choice, "high", "which byte of the register an 8-bit value is")
        .only_for(byte_types)
        .needed_with("address")
        .needless_with("bits")
        .one_of<codec::Half>(),
    inherited("length", registers, K::integer, "12", "bytes of a STRING")
        .only_for("STRING")
        .needed()
        .within(1, codec::longest_text),
    inherited("encoding", registers, K::choice, "utf-8", "how a STRING is encoded")
        .only_for("STRING")
        .otherwise("utf-8")
        .one_of<codec::Encoding>(),
    inherited("ignore_byteorder", registers, K::boolean, "true", "the older name of 'order: AB' of a STRING")
        .only_for("STRING")
        .otherwise("false"),
    project("order", registers, K::choice, "ABCD",
            "order of the bytes, A the most significant; AB or BA for one register and for a STRING")
        .one_of<codec::Order>(),
    project("bit", registers, K::integer, "3", "which bit of the register a BOOL is")
        .only_for("BOOL")
        .needed_with("address")
        .within(0, 15),
    project("bits", registers, K::ends, "[8, 11]",
            "the first and last bit of the register that make the number")
        .only_for("BYTE|USINT|WORD|UINT"),
    project("description", point, K::text, "the left door", "for people"),
    project("units", point, K::text, "mm", "for people"),
    project("initial", point, K::value, "0", "value when the node starts"),
    project("access", point, K::choice, "read", "what the client may do with it").one_of<Access>(),
    project("counter", registers, K::section, "{of: pulse, edge: rising}",
            "counts the edges of a discrete input")
        .holds(S::edge),
    project("latched", S::coil | S::holding_register, K::section, "{of: pulse, edge: rising}",
            "set by an edge of a discrete input, cleared by writing 0")
        .holds(S::edge),
    project("line", S::coil, K::text, "{chip: gpiochip0, offset: 17}", "the GPIO line; just its name will do")
        .holds(S::coil_line),
    project("line", S::discrete_input, K::text, "{chip: gpiochip0, offset: 17}",
            "the GPIO line; just its name will do")
        .holds(S::input_line),
    project("safe", S::coil, K::choice, "off",
            "what the output does when nobody is in command; an array takes a list of on and off, too")
        .otherwise("off")
        .one_of<Safe>()
        .or_bits(),
    project("pulse", S::coil, K::duration, "200ms", "how long the node drives a 1 before it ends it")
        .within(0.001, 3600),
    project("active_low", bits | line, K::boolean, "true", "on is the low level").otherwise("false"),
    project("bias", bits | line, K::choice, "pull_up", "the line's resistor").one_of<Bias>(),
    project("drive", S::coil | S::coil_line, K::choice, "open_drain", "how the line is driven")
        .otherwise("push_pull")
        .one_of<Drive>(),
    project("debounce", S::discrete_input | S::input_line, K::duration, "5ms",
            "how long a level must last to count")
        .within(0, 60),
    project("count", point, K::integer, "4", "an array of so many values")
        .otherwise("1")
        .within(1, modbus::max_read_bits),
    project("scale", registers, K::number, "0.1", "published value = raw × gain + offset").holds(S::scale),
    project("min", registers, K::number, "0", "the least value, as it is published"),
    project("max", registers, K::number, "100", "the greatest value, as it is published"),
    project("allow_nonfinite", S::holding_register, K::boolean, "true",
            "NaN and the infinities may be written")
        .only_for(float_types)
        .otherwise("false"),
    project("values", registers, K::names, "{0: idle, 1: running}",
            "what the values of an integer are called"),
    project("invalid", registers, K::raw_values, "0x8000", "raw values that mean 'no value'"),
    project("fault_below", registers, K::number, "3600",
            "a smaller raw value means that something is broken"),
    project("fault_above", registers, K::number, "21000",
            "a greater raw value means that something is broken"),
    project("iio", registers, K::section, "{device: adc0, channel: voltage0}", "an analogue channel")
        .holds(S::iio),
    project("pwm", S::holding_register, K::section, "{chip: pwmchip0, channel: 0, period: 1ms}",
            "a PWM channel; the value is its duty in percent")
        .holds(S::pwm),
    project("safe", S::holding_register, K::value, "0", "value when nobody is in command; or hold"),
    // How the host treats a point: for one, or in `defaults:` for all.
    project("rate", treatment, K::number, "1", "polling rate in Hz").within(0.001, 10000),
    project("publish", treatment, K::choice, "on_change", "when a value is published")
        .otherwise("always")
        .one_of<HostOptions::Publish>(),
    project("deadband", registers | S::defaults, K::number, "0.5", "changes up to this are not published")
        .otherwise("0")
        .within(0, most_double),
    project("max_interval", treatment, K::duration, "1s", "the longest silence of a topic")
        .within(0, most_seconds),
    project("latch", treatment, K::boolean, "true", "late subscribers get the last value").otherwise("false"),
    project("stamped", treatment, K::boolean, "true", "a topic that also says when the value was true")
        .otherwise("false"),
    project("queue_size", treatment, K::integer, "10", "messages that wait for a subscriber")
        .otherwise("10")
        .within(1, 10000),
    project("write_function", writing, K::choice, "single", "function codes of writes: 5 and 6, or 15 and 16")
        .one_of<HostOptions::WriteFunction>(),
    project("verify_write", writing, K::boolean, "true", "read back after a write").otherwise("false"),
    project("write_queue", writing, K::choice, "every", "which of the waiting writes are sent")
        .otherwise("latest")
        .one_of<HostOptions::WriteQueue>(),
    project("priority", writing, K::choice, "high", "whether its writes go before all others that wait")
        .otherwise("normal")
        .one_of<HostOptions::Priority>(),
    project("deadman", writing, K::section, "{timeout: 1s, value: 0}",
            "what is written when no message comes")
        .holds(S::deadman),
    project("read_address", S::coil | S::holding_register, K::address, "512", "where the output reads back"),
    // The map: the host's manners.
    project("defaults", S::map, K::section, "{rate: 5}", "how the host treats all points").holds(S::defaults),
    project("on_reconnect", S::map, K::choice, "restore", "what becomes of outputs when the link returns")
        .otherwise("drop")
        .one_of<OnReconnect>(),
    project("on_shutdown", S::map, K::choice, "safe", "what becomes of outputs when the driver ends")
        .otherwise("hold")
        .one_of<OnShutdown>(),
    project("poll", S::map, K::choice, "subscribed", "which points the driver reads")
        .otherwise("all")
        .one_of<Poll>(),
    project("changes", S::map, K::boolean, "off",
            "whether the driver listens to changes that a node announces")
        .otherwise("true"),
    project("verify", S::map, K::choice, "warn", "what the host does if the device has another map")
        .otherwise("require")
        .one_of<Verify>(),
    project("wait_for", S::map, K::boolean, "true",
            "whether the driver serves an action that waits for values")
        .otherwise("false"),
    project("tools", S::map, K::named, "{clamp: {close: valve, travel: 300ms}}",
            "what the driver opens and closes: grippers, clamps, cylinders, vacuum cups")
        .holds(S::tool),
    project("axes", S::map, K::named, "{glue: {point: valve}}", "outputs that are joints of a trajectory")
        .holds(S::axis),
    project("joint_rate", S::map, K::number, "25",
            "at how many Hz the driver publishes the positions of tools and axes")
        .otherwise("10")
        .within(0.1, 1000),
    project("unreadable", S::map, K::section, "[{table: coils, from: 8, to: 15}]",
            "addresses that the device refuses")
        .lists(S::area),
    project("read_whole", S::map, K::section, "[{table: input_registers, from: 8, to: 15}]",
            "addresses that the device gives in one piece only")
        .lists(S::area),
    project("$schema", S::map, K::text, "map.schema.json", "in a JSON file: the schema, for editors"),
    project("table", S::area, K::choice, "coils", "the area's table").needed().one_of<Table>(),
    project("from", S::area, K::address, "8", "its first address").needed(),
    project("to", S::area, K::address, "15", "its last address").needed(),
    // `tools:`
    project("close", S::tool, K::text, "valve_close", "the output that is on to close it"),
    project("open", S::tool, K::text, "valve_open", "the output that is on to open it"),
    project("closed", S::tool, K::text, "sensor_closed", "the bit that is on where it is closed"),
    project("opened", S::tool, K::text, "sensor_opened", "the bit that is on where it is open"),
    project("holds", S::tool, K::text, "part_present", "the bit that is on while it holds a part"),
    project("travel", S::tool, K::duration, "300ms", "how long it takes to an end that has no sensor")
        .within(0.001, most_seconds),
    project("timeout", S::tool, K::duration, "800ms", "after that it is stuck")
        .otherwise("2s")
        .within(0.001, most_seconds),
    project("settle", S::tool, K::duration, "30ms", "a sensor counts when it has been on for so long")
        .otherwise("0ms")
        .within(0, 60),
    project("hold", S::tool, K::boolean, "false", "whether the output stays on at the end").otherwise("true"),
    project("empty", S::tool, K::choice, "ok", "what it means to be closed without a part")
        .otherwise("abort")
        .one_of<OnEmpty>(),
    project("direct", S::tool, K::boolean, "true", "whether programs may also write its outputs directly")
        .otherwise("false"),
    project("joint", S::tool, K::text, "clamp_joint",
            "its name as a joint of MoveIt; NAME/TOOL if not given"),
    project("positions", S::tool, K::section, "{open: 0.04, closed: 0}",
            "its ends as positions of the joint, in metres or radians")
        .holds(S::positions),
    project("on_cancel", S::tool, K::choice, "open", "what it does when its goal is cancelled")
        .otherwise("stay")
        .one_of<OnCancel>(),
    project("open", S::positions, K::number, "0.04", "the joint's position where the tool is open")
        .otherwise("1"),
    project("closed", S::positions, K::number, "0.01", "the joint's position where the tool is closed")
        .otherwise("0"),
    // `axes:`
    project("point", S::axis, K::text, "valve", "the output: a BOOL or a number").needed(),
    project("joint", S::axis, K::text, "belt_joint", "its name as a joint; NAME/AXIS if not given"),
    project("positions", S::axis, K::positions, "{off: 0, on: 1}",
            "the positions of its values; if not given, a number's position is the published value"),
    // `scale:`, `iio:`, `pwm:`, `deadman:`
    project("gain", S::scale, K::number, "0.1", "raw is multiplied by it").otherwise("1"),
    project("offset", S::scale, K::number, "-40", "and this is added").otherwise("0"),
    project("raw", S::scale, K::ends, "[4000, 20000]", "two raw values, in place of gain and offset")
        .needed_with("value"),
    project("value", S::scale, K::ends, "[0, 10]", "what they are published as").needed_with("raw"),
    project("exponent_of", S::scale, K::text, "power_sf",
            "the point with the exponent n: the gain is multiplied by 10^n"),
    project("device", S::iio, K::text, "adc0", "name or label of the device, or iio:device0").needed(),
    project("channel", S::iio, K::text, "voltage0", "the channel's id").needed(),
    project("chip", S::pwm, K::text, "pwmchip0", "the PWM chip").needed(),
    project("channel", S::pwm, K::integer, "0", "its channel").needed().within(0, 255),
    project("period", S::pwm, K::duration, "1ms", "of the pulses").needed().within(1e-6, 10),
    project("timeout", S::deadman, K::duration, "1s", "the longest silence of the topic")
        .needed()
        .within(0.001, most_seconds),
    project("value", S::deadman, K::value, "0", "what is written then").needed(),
    // `line:`
    project("chip", line, K::text, "gpiochip0", "the chip: name, device file or label"),
    project("offset", line, K::integer, "17", "the line's number on the chip").within(0, 65535),
    project("name", line, K::text, "GPIO17", "the line's name, instead of chip and offset"),
    // `limits:`
    limit("read_registers", "125", modbus::max_read_registers, "registers in one read"),
    limit("read_bits", "2000", modbus::max_read_bits, "bits in one read"),
    limit("write_registers", "123", modbus::max_write_registers, "registers in one write"),
    limit("write_bits", "1968", modbus::max_write_bits, "bits in one write"),
    project("request_gap", S::limits, K::duration, "5ms", "pause between a reply and the next request")
        .otherwise("0ms")
        .within(0, most_seconds),
    project("connect_delay", S::limits, K::duration, "100ms", "pause after connecting")
        .otherwise("0ms")
        .within(0, most_seconds),
    project("connections", S::limits, K::integer, "1", "connections that the device takes")
        .otherwise("1")
        .within(1, 65535),
    project("mask_write", S::limits, K::boolean, "true", "the device has FC 22").otherwise("false"),
    project("transaction_ids", S::limits, K::boolean, "false",
            "replies have the transaction id of the request")
        .otherwise("true"),
    // `sim:`
    project("from", S::wire, K::text, "valve", "the coil that drives the wire"),
    project("to", S::wire, K::text, "valve_is_open", "the discrete input at its end").needed(),
    project("invert", S::wire, K::boolean, "true", "the input is on when the coil is off").otherwise("false"),
    project("square", S::wire, K::duration, "1s", "a square wave instead of a coil: its period")
        .within(0.001, most_seconds),
    // `counter:` and `latched:`
    project("of", S::edge, K::text, "pulse", "the discrete input").needed(),
    project("edge", S::edge, K::choice, "rising", "which of its edges").otherwise("rising").one_of<Edge>(),
    // `watchdog:`
    project("timeout", S::watchdog, K::duration, "500ms", "the longest silence of a client")
        .needed()
        .within(0.01, most_seconds),
    project("fed_by", S::watchdog, K::choice, "any", "which requests count")
        .otherwise("any")
        .one_of<Watchdog::FedBy>(),
    project("recovery", S::watchdog, K::choice, "automatic", "how outputs are freed again")
        .otherwise("automatic")
        .one_of<Watchdog::Recovery>(),
    project("heartbeat", S::watchdog, K::address, "100", "the register that a PLC's program watches"),
    // `security:`
    project("roles", S::security, K::named, "{viewer: {read: all}}", "what clients of each role may do")
        .holds(S::role)
        .needed(),
    project("plain", S::security, K::text, "viewer", "the role of clients without TLS").otherwise("none"),
    project("no_role", S::security, K::text, "viewer",
            "the role of clients whose certificate has none of these")
        .otherwise("none"),
    project("certificate", S::security, K::text, "press.pem", "the file of the node's certificate"),
    project("key", S::security, K::text, "press.key", "the file of its key"),
    project("ca", S::security, K::text, "authority.pem", "the file of the authority of the clients"),
    project("revoked", S::security, K::text, "revoked.pem", "the file of what it has revoked"),
    project("port", S::security, K::integer, "802", "the TCP port for TLS").otherwise("802").within(1, 65535),
    project("read", S::role, K::patterns, "[door, \"valve_*\"]", "which points it may read")
        .otherwise("none"),
    project("write", S::role, K::patterns, "[lamp, \"valve_*\"]", "which points it may write")
        .otherwise("none"),
    // `tls:`
    project("certificate", S::tls, K::text, "cell1.pem", "the file of this machine's certificate").needed(),
    project("key", S::tls, K::text, "cell1.key", "the file of its key").needed(),
    project("ca", S::tls, K::text, "authority.pem", "the file of the device's authority"),
    project("name", S::tls, K::text, "press", "the name in the device's certificate, if not its address"),
    project("pin", S::tls, K::text, "\"sha256:0d0e…\"",
            "of the device's certificate, in place of `ca` and `name`"),
    project("port", S::tls, K::integer, "802", "the device's TCP port for TLS; without it `port`, or 802")
        .within(1, 65535),
    // `serial:`
    project("device", S::serial, K::text, "/dev/ttyUSB0", "the port's device file").needed(),
    project("baud", S::serial, K::integer, "9600", "bits a second").otherwise("19200").within(50, 4000000),
    project("parity", S::serial, K::choice, "none", "the parity bit")
        .otherwise("even")
        .one_of<Serial::Parity>(),
    project("stop_bits", S::serial, K::integer, "2", "stop bits").otherwise("1").within(1, 2),
    project("rs485", S::serial, K::boolean, "true", "the port's driver switches the direction of RS-485")
        .otherwise("false"),
};

}  // namespace

Span<const Key> all_keys() { return keys; }

}  // namespace coupler::loader
