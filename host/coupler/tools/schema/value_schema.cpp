// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/schema/value_schema.hpp"

#include <cmath>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/preset.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::schema {
namespace {

using loader::Key;
using loader::Owner;
using loader::ValueKind;

bool has_range(const Key& key) {
  return key.least != std::numeric_limits<double>::lowest() && key.most != std::numeric_limits<double>::max();
}

bool is_time(ValueKind kind) { return kind == ValueKind::duration || kind == ValueKind::seconds; }

/// 502 rather than 502.0.
Json plain(double number) {
  const auto whole = static_cast<std::int64_t>(number);
  return static_cast<double>(whole) == number ? Json(whole) : Json(number);
}

Json number(std::string_view type, const Key& key) {
  Json schema{{"type", type}};
  if (key.least != std::numeric_limits<double>::lowest()) schema["minimum"] = plain(key.least);
  if (key.most != std::numeric_limits<double>::max()) schema["maximum"] = plain(key.most);
  return schema;
}

/// `remedy` is what editors say of other text.
Json text(std::string_view pattern, std::string_view remedy) {
  return {{"type", "string"}, {"pattern", pattern}, {"patternErrorMessage", remedy}};
}

Json any_of(std::initializer_list<Json> schemas) {
  return {{"anyOf", Json::array_t(schemas.begin(), schemas.end())}};
}

std::string in_both_cases(char c) {
  return loader::is_letter(c) ? std::string{'[', c, static_cast<char>(c ^ ' '), ']'} : std::string(1, c);
}

Json boolean() {
  return any_of({{{"type", "boolean"}}, text(any_case({"yes", "no", "on", "off"}), "write true or false")});
}

/// YAML's other words for "on" and "off" are taken where these are choices. ros-modbus-device-driver takes
/// its words in any case.
Json choice(const Key& key) {
  const auto choices = loader::words(key.choices);
  const std::string remedy = fmt::format("write one of {}", fmt::join(choices, ", "));
  Json taken = Json::array({{{"enum", choices}}});
  for (const std::string_view choice : choices) {
    const auto truth = loader::parse_boolean(choice);
    if (!truth) continue;
    taken.push_back({{"const", *truth}});
    taken.push_back(*truth ? text(any_case({"true", "yes", "on"}), remedy)
                           : text(any_case({"false", "no", "off"}), remedy));
  }
  if (key.bits) taken.push_back({{"type", "array"}, {"minItems", 2}, {"items", boolean()}});
  if (key.owner != Owner::project) taken.push_back(text(any_case(choices), remedy));
  return taken.size() == 1 ? taken.front() : Json{{"anyOf", taken}};
}

/// Editors suggest the names of IEC 61131-3.
Json type(const Key& key) {
  const auto types = loader::words(key.choices);
  return any_of(
      {{{"enum", types}}, text(any_name(types), fmt::format("write one of {}", fmt::join(types, ", ")))});
}

Json preset() {
  Json names = Json::array();
  for (const loader::PresetFile& file : loader::preset_files()) names.push_back(file.name);
  return {{"enum", names}};
}

Json time(const Key& key) {
  Json with_unit = text(duration_up_to(key.most), "write a number with its unit: us, ms, s or min");
  if (key.least > 0) with_unit["not"] = {{"pattern", duration_below(key.least)}};
  if (key.kind == ValueKind::seconds) {
    Json bare = number("number", key);
    bare["maximum"] = loader::most_bare_seconds;
    return any_of({with_unit, bare});
  }
  return key.least > 0 ? with_unit : any_of({with_unit, {{"const", 0}}});
}

struct Unit {
  std::string_view name;
  double seconds;
};
constexpr Unit units[] = {{"us", 1e-6}, {"ms", 1e-3}, {"s", 1}, {"min", 60}};

/// The whole numbers below it, without leading zeros but for 0 itself.
std::string whole_below(const std::string& number) {
  std::string pattern;
  const auto add = [&](const std::string& each) { pattern += (pattern.empty() ? "" : "|") + each; };
  if (number.size() > 1) add(fmt::format("[0-9]{{1,{}}}", number.size() - 1));
  for (std::size_t i = 0; i < number.size(); ++i) {
    const std::size_t rest = number.size() - i - 1;
    const char least = i == 0 && rest > 0 ? '1' : '0';
    const char smaller = static_cast<char>(number[i] - 1);
    if (smaller < least) continue;
    add(fmt::format("{}[{}-{}]{}", number.substr(0, i), least, smaller,
                    rest == 0 ? "" : fmt::format("[0-9]{{{}}}", rest)));
  }
  return pattern;
}

/// The exponent, if it is a power of ten.
std::optional<int> power_of_ten(double number) {
  const double exponent = std::log10(number);
  if (std::fabs(exponent - std::round(exponent)) > 1e-9) return std::nullopt;
  return static_cast<int>(std::lround(exponent));
}

}  // namespace

std::string duration_up_to(double most) {
  std::string pattern;
  for (const Unit& unit : units) {
    const double limit = most / unit.seconds;
    const double whole = std::floor(limit + 1e-9);
    const std::string number = fmt::format("{:.0f}", whole);
    const std::string below = whole_below(number);
    // Between two whole numbers of a unit this takes too much.
    const bool is_whole = std::fabs(limit - whole) < 1e-9 * limit;
    const std::string at = fmt::format("0*{}(\\.{}*)?", number, is_whole ? "0" : "[0-9]");
    const std::string lower = below.empty() ? "" : fmt::format("0*({})(\\.[0-9]*)?|\\.[0-9]+|", below);
    const std::string fraction = below.empty() ? "|\\.[0-9]+" : "";
    pattern += fmt::format("{}({}{}{}){}", pattern.empty() ? "" : "|", lower, at, fraction, unit.name);
  }
  return "^(" + pattern + ")$";
}

std::string duration_below(double least) {
  std::string pattern = "0*\\.?0*(us|ms|s|min)";
  for (const Unit& unit : units) {
    const auto exponent = power_of_ten(least / unit.seconds);
    if (!exponent) continue;
    if (*exponent >= 0)
      pattern += fmt::format("|0*[0-9]{{0,{}}}(\\.[0-9]*)?{}", *exponent, unit.name);
    else
      pattern += fmt::format("|0*\\.0{{{}}}[0-9]*{}", -*exponent, unit.name);
  }
  return "^(" + pattern + ")$";
}

Json value_schema(const Key& key) {
  switch (key.kind) {
    case ValueKind::integer: return number("integer", key);
    case ValueKind::number: return number("number", key);
    case ValueKind::boolean: return boolean();
    // A plain scalar that looks like a number or a boolean is text to the loader.
    case ValueKind::text: return {{"type", {"string", "number", "boolean"}}};
    case ValueKind::ros_name: return text(ros_name, ros_name_rule);
    case ValueKind::host:  // With a colon it is IPv6, which has two at least.
      return text(R"(^([\w.-]*|\[?[0-9A-Fa-f]*:[0-9A-Fa-f.]*:[0-9A-Fa-f:.]*(%[\w.-]+)?\]?)$)",
                  "write a host name or an IP address, without scheme and port");
    case ValueKind::ip_address: return text(ip_address, "write an IP address of the node");
    case ValueKind::choice: return choice(key);
    case ValueKind::type: return type(key);
    case ValueKind::preset: return preset();
    case ValueKind::duration:
    case ValueKind::seconds: return time(key);
    case ValueKind::address: return {{"type", "integer"}, {"minimum", 0}, {"maximum", most_modicon_address}};
    case ValueKind::value:
      return {{"type", {"string", "number", "boolean", "array"}},
              {"items", {{"type", {"string", "number", "boolean", "array"}}}}};  // an array of WORDs, as bits
    case ValueKind::list: return {{"type", "array"}, {"minItems", 1}, {"items", {{"type", "string"}}}};
    case ValueKind::ends:
      return {{"type", "array"},
              {"items", {{"type", "number"}}},
              {"minItems", 2},
              {"maxItems", 2},
              {"uniqueItems", true}};
    case ValueKind::raw_values: {
      const Json raw{{"type", {"integer", "number", "string"}}};
      const Json range{{"type", "array"}, {"items", raw}, {"minItems", 2}, {"maxItems", 2}};
      return any_of(
          {raw, {{"type", "array"}, {"items", any_of({raw, range})}, {"minItems", 1}, {"maxItems", 16}}});
    }
    case ValueKind::names:
      return {{"type", "object"},
              {"minProperties", 1},
              {"patternProperties",
               {{"^(-?[0-9]+|0[xX][0-9A-Fa-f]+)$",
                 any_of({text("^[A-Za-z][A-Za-z0-9_]*$", "use letters, digits and '_', a letter first"),
                         {{"type", "boolean"}}})}}},
              {"additionalProperties", false}};
    case ValueKind::positions:
      return {{"type", "object"},
              {"minProperties", 2},
              {"patternProperties",
               {{"^(-?[0-9]+|0[xX][0-9A-Fa-f]+|[A-Za-z][A-Za-z0-9_]*)$", {{"type", "number"}}}}},
              {"additionalProperties", false}};
    case ValueKind::patterns:
      return any_of({{{"enum", {"all", "none"}}}, {{"type", "array"}, {"items", {{"type", "string"}}}}});
    case ValueKind::section:
    case ValueKind::named:
    case ValueKind::points: break;
  }
  return Json::object();
}

std::string describe(const Key& key) {
  std::string text(key.summary);
  if (!key.same_as.empty()) text = fmt::format("another spelling of {}", key.same_as);
  if (!key.types.empty()) text += fmt::format("; for {}", fmt::join(loader::words(key.types), ", "));
  if (has_range(key))
    text += fmt::format("; from {} to {}{}", key.least, key.most, is_time(key.kind) ? " s" : "");
  if (!key.fallback.empty()) text += fmt::format("; if not given: {}", key.fallback);
  return text + fmt::format("\n\nExample: {}: {}", key.name, key.example);
}

Json fallback_value(const Key& key) {
  switch (key.kind) {
    case ValueKind::integer:
    case ValueKind::number:
    case ValueKind::seconds:
    case ValueKind::boolean: return Json::parse(key.fallback);
    default: return key.fallback;
  }
}

std::string any_case(const std::vector<std::string_view>& words) {
  std::string pattern;
  for (const std::string_view word : words) {
    pattern += pattern.empty() ? "^(" : "|";
    for (const char c : word) pattern += c == '-' ? "[-_]?" : in_both_cases(c);
  }
  return pattern + ")$";
}

std::string any_name(const std::vector<std::string_view>& types) {
  std::string pattern;
  for (const std::string_view type : types)
    for (const std::string_view name : codec::names_of(*codec::parse_type(type))) {
      pattern += pattern.empty() ? "^(" : "|";
      // codec::folded_type_name() removes these characters.
      for (const char c : codec::folded_type_name(name)) pattern += "[-_ ]*" + in_both_cases(c);
    }
  return pattern + ")[-_ ]*$";
}

}  // namespace coupler::schema
