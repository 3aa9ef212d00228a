// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/foreign_connection.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/serial.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Problems;
using loader::shown;

struct Spelling {
  std::string_view word;  ///< in small letters
  std::string_view value;
};
/// The numbers are those of javax.comm and of .NET.
constexpr Spelling parities[] = {{"n", "none"}, {"none", "none"}, {"0", "none"},
                                 {"o", "odd"},  {"odd", "odd"},   {"1", "odd"},
                                 {"e", "even"}, {"even", "even"}, {"2", "even"}};
constexpr Spelling stop_bits[] = {{"1", "1"},     {"1.0", "1"}, {"one", "1"},
                                  {"2", "2"},     {"2.0", "2"}, {"two", "2"},
                                  {"1.5", "1.5"}, {"3", "1.5"}, {"onepointfive", "1.5"}};

/// Empty if the word is not among them.
template <std::size_t size>
std::string_view value_of(const Spelling (&spellings)[size], std::string_view word) {
  const auto* found = std::find_if(std::begin(spellings), std::end(spellings),
                                   [&](const Spelling& each) { return each.word == lower(word); });
  return found == std::end(spellings) ? std::string_view{} : found->value;
}

bool is_given(const Entry* entry) { return entry != nullptr && entry->kind != Entry::Kind::null; }

/// Reads the settings of one port. Each function returns the map's value.
class LineReader {
 public:
  LineReader(const Entry& given, const LineKeys& keys, Problems& problems)
      : given_(given), keys_(keys), problems_(problems) {}

  Entry read() {
    Entry line = section("serial", given_.at);
    line.children.push_back(device());
    line.children.push_back(setting("baud", keys_.baud, keys_.usual_baud));
    line.children.push_back(setting("parity", keys_.parity, keys_.usual_parity));
    line.children.push_back(setting("stop_bits", keys_.stop_bits, keys_.usual_stop_bits));
    check_data_bits();
    return line;
  }

 private:
  /// nullptr if it is not there, or null.
  const Entry* find(std::string_view key) const {
    const Entry* entry = loader::child(given_, key);
    return is_given(entry) ? entry : nullptr;
  }

  Entry device() {
    const Entry* given = find(keys_.device);
    if (given == nullptr || given->text.empty() || lower(given->text) == "none") {
      problems_.warning(given != nullptr ? given->at : given_.at,
                        "the file does not name the serial port, so the map has /dev/ttyUSB0",
                        "write the port's device file as 'device' into the map");
      return scalar("device", "/dev/ttyUSB0", given_.at);
    }
    if (given->text.find("://") != std::string::npos)
      problems_.warning(given->at,
                        fmt::format("{} is a serial port behind a network address", shown(given->text)),
                        "write 'address', 'port' and 'framing: rtu' in place of 'serial' into the map");
    else if (given->text[0] != '/')
      problems_.warning(given->at, fmt::format("{} is not a device file of Linux", shown(given->text)),
                        "write the port's device file into the map, as in 'device: /dev/ttyUSB0'");
    return scalar("device", given->text, given->at, true);
  }

  Entry setting(std::string_view name, std::string_view key, std::string_view usual) {
    const std::string_view otherwise = name == "baud" ? "19200" : name == "parity" ? "even" : "1";
    const Entry* given = find(key);
    if (given != nullptr) return scalar(name, value_of_key(name, *given, otherwise), given->at);
    if (!usual.empty()) return scalar(name, std::string(usual), given_.at);
    problems_.warning(given_.at, fmt::format("there is no '{}', so the map has {}", key, otherwise),
                      fmt::format("write what the device is set to as '{}' into the map", name));
    return scalar(name, std::string(otherwise), given_.at);
  }

  /// `otherwise`, with a warning, if the map has no value for it.
  std::string value_of_key(std::string_view name, const Entry& given, std::string_view otherwise) {
    if (name == "baud") {
      const auto rate = loader::parse_unsigned(given.text);
      if (rate && *rate <= 0xFFFFFFFF && is_serial_rate(static_cast<std::uint32_t>(*rate)))
        return fmt::to_string(*rate);
      return refuse(given, otherwise,
                    fmt::format("set the device to one of {}, and", fmt::join(serial_rates, ", ")), name);
    }
    if (name == "parity") {
      const std::string_view parity = value_of(parities, given.text);
      return !parity.empty() ? std::string(parity)
                             : refuse(given, otherwise, "set the device to none, even or odd, and", name);
    }
    const std::string_view bits = value_of(stop_bits, given.text);
    if (bits == "1" || bits == "2") return std::string(bits);
    // Two are long enough for a device that waits for one and a half.
    return refuse(given, bits.empty() ? otherwise : "2", "set the device to 1 or 2, and", name);
  }

  std::string refuse(const Entry& given, std::string_view otherwise, const std::string& remedy,
                     std::string_view name) {
    problems_.warning(
        given.at,
        fmt::format("a map cannot have {} as '{}', so it has {}", shown(given.text), name, otherwise),
        fmt::format("{} write that as '{}' into the map", remedy, name));
    return std::string(otherwise);
  }

  void check_data_bits() {
    const Entry* given = find(keys_.data_bits);
    if (given == nullptr || given->text == "8" || lower(given->text) == "eight") return;
    problems_.warning(
        given->at,
        fmt::format("'{}' is {}, but RTU has 8 bits in a character", keys_.data_bits, shown(given->text)),
        "set the device to RTU with 8 bits");
  }

  const Entry& given_;
  const LineKeys& keys_;
  Problems& problems_;
};

/// What a word means, without its '_', '-' and blanks.
struct TransportWord {
  std::string_view word;
  Transport transport;
  std::string_view missing{};  ///< what of it a map does not have
};
constexpr TransportWord transports[] = {{"serial", {true, true}},
                                        {"rtu", {true, true}},
                                        {"tcp", {false, false}},
                                        {"rtuovertcp", {false, true}},
                                        {"tls", {false, false}, "TLS"},
                                        {"udp", {false, false}, "UDP"},
                                        {"rtuoverudp", {false, true}, "UDP"},
                                        {"ascii", {true, true}, "ASCII"},
                                        {"asciiovertcp", {false, true}, "ASCII"}};

std::string bare(std::string_view word) {
  std::string out = lower(word);
  out.erase(std::remove_if(out.begin(), out.end(), [](char c) { return c == '_' || c == '-' || c == ' '; }),
            out.end());
  return out;
}

enum class Framing { unsaid, tcp, rtu, other, unknown };

/// "rtu", "FramerType.RTU" and "ModbusRtuFramer" are one, as are "socket" and "ModbusSocketFramer".
Framing framing_of(std::string_view given) {
  std::string word = bare(given);
  for (const std::string_view around : {"framertype.", "modbus", "framer"})
    if (const std::size_t at = word.find(around); at != std::string::npos) word.erase(at, around.size());
  if (word.empty() || word == "default") return Framing::unsaid;
  if (word == "rtu") return Framing::rtu;
  if (word == "socket" || word == "tcp" || word == "tls") return Framing::tcp;
  return word == "ascii" || word == "binary" ? Framing::other : Framing::unknown;
}

}  // namespace

Entry read_serial_line(const Entry& given, const LineKeys& keys, Problems& problems) {
  return LineReader(given, keys, problems).read();
}

Transport read_transport(const Entry* given, Transport usual, Problems& problems) {
  if (!is_given(given)) return usual;
  const Entry& word = *given;
  const auto* found =
      std::find_if(std::begin(transports), std::end(transports),
                   [key = bare(word.text)](const TransportWord& each) { return each.word == key; });
  if (found == std::end(transports)) {
    problems.warning(word.at, fmt::format("{} is not known, so the map has Modbus/TCP", shown(word.text)),
                     "write 'framing: rtu' or 'serial' into the map if the device speaks RTU");
    return {};
  }
  if (found->missing == "UDP")
    problems.warning(word.at,
                     fmt::format("{} is Modbus over UDP, so the map has TCP in its place", shown(word.text)),
                     "check that the device also answers over TCP, or put a gateway in front of it");
  else if (found->missing == "ASCII")
    problems.warning(word.at,
                     fmt::format("{} is Modbus ASCII, so the map has RTU in its place", shown(word.text)),
                     "set the device to RTU");
  else if (found->missing == "TLS")
    problems.warning(word.at, "the certificates of TLS are not carried over, so the map has none",
                     "add 'tls' with 'certificate', 'key' and 'ca' to the map");
  return found->transport;
}

void read_framing(const Entry* given, Transport& transport, Problems& problems) {
  if (!is_given(given)) return;
  const Entry& word = *given;
  const Framing framing = framing_of(word.text);
  if (framing == Framing::unsaid) return;
  if (framing == Framing::rtu) {
    transport.rtu = true;
  } else if (transport.serial || framing == Framing::other) {
    transport.rtu = true;
    problems.warning(word.at,
                     fmt::format("a map does not have the framing {}{}, so it has RTU", shown(word.text),
                                 transport.serial ? " on a serial line" : ""),
                     "set the device to RTU");
  } else if (framing == Framing::unknown) {
    problems.warning(word.at,
                     fmt::format("the framing {} is not known, so the map has {}", shown(word.text),
                                 transport.rtu ? "RTU" : "Modbus/TCP"),
                     "write 'framing: rtu' into the map if the device speaks RTU over TCP");
  }
}

Entry rtu_framing(loader::Position at) { return scalar("framing", "rtu", at); }

}  // namespace coupler::formats
