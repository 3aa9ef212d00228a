// SPDX-License-Identifier: Apache-2.0
#include "coupler/record/reader.hpp"

#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/json/json_text.hpp"

namespace coupler::record {
namespace {

using nlohmann::json;

constexpr double longest = 1e9;         ///< s: 30 years
constexpr double longest_period = 1e6;  ///< s

/// Thrown for a member that is missing or has another type.
class Wrong : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class T>
T get(const json& object, const char* key) {
  const auto member = object.find(key);
  if (member == object.end()) throw Wrong(fmt::format("it has no '{}'", key));
  try {
    return member->get<T>();
  } catch (const json::exception&) {
    throw Wrong(fmt::format("'{}' is of another type", key));
  }
}

/// Reads a whole number that has to be 0 to `most`.
template <class T>
T whole(const json& number, const char* key, T most = std::numeric_limits<T>::max()) {
  if (!number.is_number()) throw Wrong(fmt::format("'{}' is of another type", key));
  if (!number.is_number_unsigned() || number.get<std::uint64_t>() > most)
    throw Wrong(fmt::format("'{}' has a number that is not 0 to {}", key, most));
  return number.get<T>();
}

Nanoseconds time_of(const json& object) {
  const auto seconds = get<double>(object, "t");
  if (!(seconds >= 0 && seconds < longest)) throw Wrong("'t' is no time of a recording");
  return std::chrono::round<Nanoseconds>(std::chrono::duration<double>(seconds));
}

/// "2026-11-21T13:20:11.123Z"
Nanoseconds wall_of(const std::string& text) {
  std::tm parts{};
  int millisecond = 0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d.%3dZ", &parts.tm_year, &parts.tm_mon, &parts.tm_mday,
                  &parts.tm_hour, &parts.tm_min, &parts.tm_sec, &millisecond) != 7)
    throw Wrong(fmt::format("'{}' is no time, as 2026-11-21T13:20:11.123Z", text));
  if (parts.tm_year < 1970 || parts.tm_year > 2200)  // nanoseconds reach no further
    throw Wrong(fmt::format("'{}' is no time of a recording", text));
  parts.tm_year -= 1900;
  parts.tm_mon -= 1;
  return std::chrono::seconds(::timegm(&parts)) + std::chrono::milliseconds(millisecond);
}

Moment moment_of(const json& object) { return {time_of(object), wall_of(get<std::string>(object, "utc"))}; }

std::vector<std::uint16_t> bits_of(const json& value) {
  std::vector<std::uint16_t> bits;
  const auto add = [&](const json& bit) {
    if (!bit.is_boolean()) throw Wrong("'value' of a point without 'registers' is true or false");
    bits.push_back(bit.get<bool>() ? 1 : 0);
  };
  if (value.is_array())
    for (const json& bit : value) add(bit);
  else
    add(value);
  return bits;
}

Value value_of(const json& object) {
  if (object.contains("registers")) {
    Value value{get<std::string>(object, "point"), {}};
    for (const json& each : get<std::vector<json>>(object, "registers"))
      value.registers.push_back(whole<std::uint16_t>(each, "registers"));
    return value;
  }
  return {get<std::string>(object, "point"), bits_of(object.value("value", json()))};
}

/// APP 7: an exception's code is 1 to 0x7F, since one with bit 7 would be no reply.
std::uint8_t exception_of(const json& number) {
  constexpr std::uint8_t most = 0x7F;
  const auto code = whole<std::uint8_t>(number, "exception", most);
  if (code == 0) throw Wrong("'exception' has the number 0; codes begin with 1");
  return code;
}

DeviceState state_of(const json& object) {
  return {get<std::string>(object, "device") == "online",
          object.contains("foreign") && get<bool>(object, "foreign")};
}

Line line_of(const json& object) {
  if (!object.is_object()) throw Wrong("it is not a JSON object");
  const Moment at = moment_of(object);
  if (object.contains("record")) throw Wrong("another recording begins here; play each by itself");
  if (object.contains("device")) return {at, state_of(object)};
  if (!object.contains("point")) return {at, Remark{}};
  if (object.contains("exception"))
    return {at, NoValue{get<std::string>(object, "point"), get<std::string>(object, "quality"),
                        exception_of(object["exception"])}};
  constexpr std::uint8_t device_failure = 4;  // there was no reply, but a node that plays it has to give one
  if (object.value("quality", "good") == "rejected")
    return {at, NoValue{get<std::string>(object, "point"), "rejected", device_failure}};
  return {at, value_of(object)};
}

Head head_of(const json& object) {
  Head head{get<std::string>(object, "name"), get<std::string>(object, "device"),
            get<std::string>(object, "fingerprint"), get<std::string>(object, "map")};
  const json left_out = get<json>(object, "not_recorded");
  for (const auto& [point, why] : left_out.items())
    if (why.is_string()) head.not_recorded.emplace_back(point, why.get<std::string>());
  const json periods = get<json>(object, "periods");
  for (const auto& [point, period] : periods.items())
    if (period.is_number() && period.get<double>() > 0 && period.get<double>() <= longest_period)
      head.periods.emplace_back(point, period.get<double>());
  return head;
}

}  // namespace

std::string Reader::error(std::string_view what) const {
  return fmt::format("{}:{}: {}", file_, number_, what);
}

tl::expected<Reader, std::string> Reader::open(std::istream& text, std::string file) {
  Reader reader(text, std::move(file));
  std::string first;
  std::getline(text, first);
  const json object = parse_json(first);
  if (!object.is_object() || !object.contains("record"))
    return tl::unexpected(reader.error("this is no recording; `coupler record` makes one"));
  try {
    if (const int version = get<int>(object, "record"); version != format_version)
      return tl::unexpected(reader.error(fmt::format(
          "the recording has version {}, and this program reads {}; play it with the release that made it",
          version, format_version)));
    reader.begin_ = moment_of(object);
    reader.head_ = head_of(object);
  } catch (const Wrong& wrong) {
    return tl::unexpected(reader.error(wrong.what()));
  }
  return reader;
}

tl::expected<std::optional<Line>, std::string> Reader::next() {
  std::string text;
  while (std::getline(*text_, text)) {
    ++number_;
    if (text.empty()) continue;
    const json object = parse_json(text);
    if (object.is_discarded() && text_->eof()) return std::nullopt;  // cut short
    if (object.is_discarded()) return tl::unexpected(error("this is no JSON"));
    try {
      return line_of(object);
    } catch (const Wrong& wrong) {
      return tl::unexpected(error(wrong.what()));
    }
  }
  return std::nullopt;
}

}  // namespace coupler::record
