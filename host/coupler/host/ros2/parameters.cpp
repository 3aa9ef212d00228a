// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/parameters.hpp"

#include <rcl_yaml_param_parser/parser.h>
#include <rcl_interfaces/msg/parameter_type.hpp>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/host/ros2/rcl/error.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::host {
namespace {

using Kind = GivenParameter::Kind;

template <class T>
std::string list_of(const T* values, std::size_t size) {
  return fmt::format("{}", fmt::join(values, values + size, ","));
}

GivenParameter given(std::string name, const rcl_variant_t& value) {
  if (value.bool_value != nullptr)
    return {std::move(name), Kind::boolean, *value.bool_value ? "true" : "false"};
  if (value.integer_value != nullptr)
    return {std::move(name), Kind::integer, fmt::to_string(*value.integer_value)};
  if (value.double_value != nullptr)
    return {std::move(name), Kind::real, fmt::to_string(*value.double_value)};
  if (value.string_value != nullptr) return {std::move(name), Kind::text, value.string_value};
  GivenParameter list{std::move(name), Kind::list, {}};
  if (const auto* all = value.string_array_value) list.text = list_of(all->data, all->size);
  if (const auto* all = value.integer_array_value) list.text = list_of(all->values, all->size);
  if (const auto* all = value.double_array_value) list.text = list_of(all->values, all->size);
  if (const auto* all = value.bool_array_value) list.text = list_of(all->values, all->size);
  return list;
}

bool is_for_all(std::string_view node) { return node.find('*') != std::string_view::npos; }

/// `/*` is one name of the path and `/**` any number of them, as in every ROS 2 node.
bool matches(const std::string& section, std::string_view node) {
  if (!is_for_all(section)) return section == node;
  if (node.empty()) return section == "/**";
  std::string pattern = std::regex_replace(section, std::regex(R"(/\*\*)"), "(/\\w+)@");
  pattern = std::regex_replace(pattern, std::regex(R"(/\*)"), "(/\\w+)");
  std::replace(pattern.begin(), pattern.end(), '@', '*');
  return std::regex_match(node.begin(), node.end(), std::regex(pattern));
}

/// Parameters of every node, and of the client libraries.
bool is_ROSs_own(std::string_view name) {
  return name == "use_sim_time" || name == "start_type_description_service" ||
         name == "enable_logger_service" || starts_with(name, "qos_overrides.");
}

/// The setting that a name means: "rate" of "belt.rate" where belt is a device.
std::string_view setting_of(std::string_view name, const std::vector<std::string_view>& devices) {
  for (const std::string_view device : devices)
    if (starts_with(name, device) && name.substr(device.size(), 1) == ".")
      return name.substr(device.size() + 1);
  return name;
}

bool is_meant_for_a_driver(const GivenParameters::Section& section) {
  return std::any_of(section.parameters.begin(), section.parameters.end(), [](const GivenParameter& one) {
    return one.name == "map" || one.name == "maps" || one.name == "address" || one.name == "serial";
  });
}

/// Returns what is wrong if YAML has read a text as something else, or an empty text if nothing is.
std::string wrong_kind(const SettingKey& key, const GivenParameter& one) {
  const bool is_text = key.kind == SettingKey::Kind::text && key.key != "verify" && key.key != "rs485";
  if (!is_text || (one.kind != Kind::boolean && one.kind != Kind::real)) return {};
  return fmt::format(
      "YAML reads the value as {} ({}); if it is a text put it into quotes, as in {}: 'VALUE', or "
      "-p {}:=\"'VALUE'\"",
      one.kind == Kind::boolean ? "a boolean" : "a number", one.text, one.name, one.name);
}

using Type = rcl_interfaces::msg::ParameterType;

std::uint8_t type_of(SettingKey::Kind kind) {
  switch (kind) {
    case SettingKey::Kind::list: return Type::PARAMETER_STRING_ARRAY;
    case SettingKey::Kind::integer: return Type::PARAMETER_INTEGER;
    case SettingKey::Kind::real: return Type::PARAMETER_DOUBLE;
    case SettingKey::Kind::text: break;
  }
  return Type::PARAMETER_STRING;
}

ParameterServer::Descriptor describe(const SettingKey& key, const std::string& prefix) {
  ParameterServer::Descriptor descriptor;
  descriptor.name = fmt::format("{}{}", prefix, key.key);
  descriptor.type = type_of(key.kind);
  descriptor.description = std::string(key.help);
  if (key.kind == SettingKey::Kind::integer) {
    auto& range = descriptor.integer_range.emplace_back();
    range.from_value = static_cast<std::int64_t>(key.min);
    range.to_value = static_cast<std::int64_t>(key.max);
    range.step = 1;
  } else if (key.kind == SettingKey::Kind::real) {
    auto& range = descriptor.floating_point_range.emplace_back();
    range.from_value = key.min;
    range.to_value = key.max;
  }
  return descriptor;
}

ParameterServer::Value value_of(const SettingKey& key, const Settings& settings) {
  ParameterServer::Value value;
  const auto text = text_of(settings, key.key);
  if (!text) return value;
  value.type = type_of(key.kind);
  switch (key.kind) {
    case SettingKey::Kind::list: value.string_array_value = items_of(*text); break;
    case SettingKey::Kind::integer: value.integer_value = std::strtoll(text->c_str(), nullptr, 10); break;
    case SettingKey::Kind::real: value.double_value = std::strtod(text->c_str(), nullptr); break;
    case SettingKey::Kind::text: value.string_value = *text; break;
  }
  return value;
}

}  // namespace

GivenParameters GivenParameters::of(const rcl_arguments_t& arguments) {
  rcl_params_t* found = nullptr;
  rcl::check(rcl_arguments_get_param_overrides(&arguments, &found), "cannot read the parameters");
  std::vector<Section> sections;
  if (found == nullptr) return GivenParameters({});
  for (std::size_t n = 0; n < found->num_nodes; ++n) {
    Section section{found->node_names[n], {}};
    if (section.node.empty() || section.node[0] != '/') section.node.insert(0, "/");
    const rcl_node_params_t& all = found->params[n];
    for (std::size_t i = 0; i < all.num_params; ++i)
      section.parameters.push_back(given(all.parameter_names[i], all.parameter_values[i]));
    sections.push_back(std::move(section));
  }
  rcl_yaml_node_struct_fini(found);
  return GivenParameters(std::move(sections));
}

std::vector<GivenParameter> GivenParameters::for_node(std::string_view full_name) const {
  std::vector<GivenParameter> all;
  for (const Section& section : sections_)
    if (matches(section.node, full_name))
      all.insert(all.end(), section.parameters.begin(), section.parameters.end());
  return all;
}

std::string GivenParameters::driver_section() const {
  for (const Section& section : sections_)
    if (!is_for_all(section.node) && is_meant_for_a_driver(section)) return section.node;
  return {};
}

std::vector<std::string> GivenParameters::unknown(std::string_view full_name,
                                                  const std::vector<std::string_view>& devices) const {
  std::vector<std::string> lines;
  const auto names = setting_names();
  for (const Section& section : sections_) {
    if (!matches(section.node, full_name)) continue;
    for (const GivenParameter& one : section.parameters) {
      const std::string_view setting = setting_of(one.name, devices);
      if (is_setting(setting) || is_ROSs_own(one.name)) continue;
      const std::string_view behind_slash = setting.substr(setting.rfind('/') + 1);
      if (behind_slash != setting && is_setting(behind_slash)) {
        lines.push_back(fmt::format("parameter {} is ROS 1's spelling and does nothing; write {}.{}",
                                    one.name, one.name.substr(0, one.name.rfind('/')), behind_slash));
        continue;
      }
      const std::string_view behind_dot = setting.substr(setting.rfind('.') + 1);
      if (!devices.empty() && behind_dot != setting && is_setting(behind_dot)) {
        lines.push_back(
            fmt::format("parameter {} is for a device that does not exist; the maps have the names {}",
                        one.name, fmt::join(devices, ", ")));
        continue;
      }
      if (is_for_all(section.node) && nearest(setting, names).empty()) continue;
      lines.push_back(unknown_parameter(one.name, setting));
    }
  }
  const bool has_own = std::any_of(sections_.begin(), sections_.end(),
                                   [&](const Section& section) { return section.node == full_name; });
  for (const Section& section : sections_)
    if (!has_own && !matches(section.node, full_name) && is_meant_for_a_driver(section))
      lines.push_back(fmt::format("the parameters of {} are not used: the name of this node is {}",
                                  section.node, full_name));
  return lines;
}

tl::expected<Settings, std::string> settings_among(const std::vector<GivenParameter>& parameters,
                                                   std::string_view prefix) {
  return settings_among(prefix, [&](const SettingKey& key, const std::string& name) -> ParameterText {
    const std::string full = fmt::format("{}{}", prefix, name);
    const auto last = std::find_if(parameters.rbegin(), parameters.rend(),
                                   [&](const GivenParameter& one) { return one.name == full; });
    if (last == parameters.rend()) return std::nullopt;
    if (std::string wrong = wrong_kind(key, *last); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    return last->text;
  });
}

void declare_settings(ParameterServer& server, const Settings& settings) {
  for (const SettingKey& key : setting_keys()) server.declare(describe(key, ""), value_of(key, settings));
}

void declare_devices(ParameterServer& server, const Devices& devices) {
  if (devices.size() == 1)
    return declare_settings(server, with_map(devices.front().settings, devices.front().source.map));
  for (const auto& [settings, source] : devices)
    for (const SettingKey& key : setting_keys())
      if (key.key != "map" && key.key != "maps")
        server.declare(describe(key, fmt::format("{}.", source.map.name)),
                       value_of(key, with_map(settings, source.map)));
}

}  // namespace coupler::host
