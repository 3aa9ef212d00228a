// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/foreign_connection.hpp"
#include "coupler/tools/formats/home_assistant_points.hpp"
#include "coupler/tools/formats/home_assistant_text.hpp"
#include "coupler/tools/formats/importers.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Position;
using loader::Problems;

/// Home Assistant takes one where a list may stand.
Span<const Entry> list_of(const Entry& entry) {
  if (entry.kind == Entry::Kind::list) return entry.children;
  return entry.kind == Entry::Kind::map ? Span<const Entry>(&entry, 1) : Span<const Entry>();
}

bool is_hub(const Entry& entry) {
  return loader::child(entry, "type") != nullptr || loader::child(entry, "host") != nullptr;
}

std::string name_of(const Entry& hub) {
  const Entry* name = loader::child(hub, "name");
  return name != nullptr ? name->text : "modbus_hub";
}

/// The hub that was asked for, or the only one.
const Entry* choose(const std::vector<const Entry*>& hubs, const std::string& wanted, Problems& problems) {
  std::string names;
  for (const Entry* hub : hubs) {
    if (wanted.empty() ? hubs.size() == 1 : name_of(*hub) == wanted) return hub;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name_of(*hub));
  }
  if (hubs.empty())
    problems.error(
        {1, 1}, "there is no hub of the modbus integration in the file",
        "give a configuration.yaml with the key 'modbus:' at the beginning of a line, or the list of hubs "
        "that it includes");
  else
    problems.error(hubs.back()->at,
                   wanted.empty() ? fmt::format("the file has several hubs: {}", names)
                                  : fmt::format("there is no hub '{}' in the file", wanted),
                   fmt::format("give one of them with --device: {}", names));
  return nullptr;
}

/// Reads what the map says about the connection.
class HubReader {
 public:
  HubReader(const Entry& hub, Problems& problems) : hub_(hub), settings_(hub, problems) {}

  std::vector<Entry> read() {
    transport_ = read_transport(settings_.find("type"), {}, settings_.problems());
    if (transport_.serial)
      add_line();
    else
      add_address();
    add_timeout();
    add_limits();
    for (const std::string_view key : {"name", "type"}) settings_.ignore(key);
    for (const std::string_view platform : entity_platforms()) settings_.ignore(platform);
    settings_.report_rest();
    return std::move(keys_);
  }

 private:
  void add_line() {
    constexpr LineKeys keys = {"port", "baudrate", "bytesize", "parity", "stopbits"};
    for (const std::string_view key : {keys.device, keys.baud, keys.data_bits, keys.parity, keys.stop_bits})
      settings_.ignore(key);
    if (const Entry* host = settings_.find("host"))
      settings_.problems().error(
          host->at, "a hub on a serial line has no 'host'",
          "write 'type: rtuovertcp' if the device is at that address, or remove 'host'");
    read_framing(settings_.find("method"), transport_, settings_.problems());
    keys_.push_back(read_serial_line(hub_, keys, settings_.problems()));
  }

  void add_address() {
    if (const std::string host = settings_.text("host", ""); !host.empty())
      keys_.push_back(scalar("address", host, settings_.find("host")->at));
    if (const auto port = settings_.whole("port", 65535))
      keys_.push_back(scalar("port", fmt::to_string(*port), settings_.find("port")->at));
    if (transport_.rtu) keys_.push_back(rtu_framing(settings_.find("type")->at));
  }

  /// Home Assistant waits for 3 s if nothing is said, as a map does with Modbus/TCP.
  void add_timeout() {
    constexpr double longest = 60;
    const double timeout = settings_.number("timeout").value_or(0);
    if (timeout <= 0) {
      if (transport_.rtu) keys_.push_back(scalar("timeout", "3", hub_.at));
      return;
    }
    const Position at = settings_.find("timeout")->at;
    if (timeout > longest)
      settings_.problems().warning(
          at, fmt::format("a timeout of {} s is read as 60 s, the longest of a map", timeout),
          "no action is needed");
    keys_.push_back(scalar("timeout", fmt::to_string(std::min(timeout, longest)), at));
  }

  void add_limits() {
    Entry limits = section("limits", hub_.at);
    const auto delay = settings_.whole("delay", 3600);
    if (delay.value_or(0) > 0)
      limits.children.push_back(
          scalar("connect_delay", fmt::format("{}s", *delay), settings_.find("delay")->at));
    const auto wait = settings_.whole("message_wait_milliseconds", 60'000);
    if (wait.value_or(0) > 0)
      limits.children.push_back(
          scalar("request_gap", fmt::format("{}ms", *wait), settings_.find("message_wait_milliseconds")->at));
    if (!limits.children.empty()) keys_.push_back(std::move(limits));
  }

  const Entry& hub_;
  Settings settings_;
  Transport transport_;
  std::vector<Entry> keys_;
};

/// The unit id of a hub's entities, as far as it is a secret.
struct SecretUnit {
  const Entry* first = nullptr;  ///< where it stands first; nullptr: unit ids are numbers
  bool is_only_one = true;       ///< of all entities
};

/// Looks for unit ids that are secrets. An error where some entities have another one: they may be of one
/// unit or of several.
SecretUnit find_secret_unit(const Entry& hub, Problems& problems) {
  SecretUnit found;
  const Entry* first = nullptr;  // entity
  std::string_view first_secret;
  for (const std::string_view platform : entity_platforms()) {
    const Entry* entities = loader::child(hub, platform);
    if (entities == nullptr) continue;
    for (const Entry& entity : list_of(*entities)) {
      const Entry* unit = unit_of(entity);
      const std::string_view secret = unit != nullptr ? secret_of(*unit) : std::string_view{};
      if (first == nullptr) {
        first = &entity;
        first_secret = secret;
        if (!secret.empty()) found.first = unit;
      } else if (secret != first_secret) {
        problems.error(
            unit != nullptr ? unit->at : entity.at,
            fmt::format("it is not known whether this entity is of the same unit as the one in line {}: "
                        "a unit id that is a secret is not read",
                        first->at.line),
            "write the unit ids of all entities as numbers");
        found.is_only_one = false;
        return found;
      }
    }
  }
  return found;
}

void report_old_form(const HomeAssistantFile& file, bool is_all, Problems& problems) {
  for (const Position at : file.old_form) {
    const char* what = is_all ? "'platform: modbus' is an old form that Home Assistant no longer reads"
                              : "'platform: modbus' is an old form that Home Assistant no longer reads, so "
                                "its entities are left out";
    const char* remedy =
        "write them below 'sensors:', 'binary_sensors:', 'switches:' or 'climates:' of the hub, with "
        "'address' in place of 'register' and 'coil', and 'input_type' in place of 'register_type'";
    if (is_all)
      problems.error(at, what, remedy);
    else
      problems.warning(at, what, remedy);
  }
}

/// Tells of tags in the place of hubs, or of a list of them.
void check_included_hubs(const HomeAssistantFile& file, Problems& problems) {
  Entry places;
  for (const Entry& part : file.parts) {
    if (part.kind == Entry::Kind::scalar) places.children.push_back(part);
    for (const Entry& child : part.children)
      if (child.kind == Entry::Kind::scalar && part.kind == Entry::Kind::list)
        places.children.push_back(child);
  }
  take_tags_out(places, file.tags, problems);
}

/// Returns what the names of all entities begin with if an export has made them: that of the hub; else
/// nothing.
std::string prefix_of_names(const Entry& hub) {
  std::string prefix = name_of(hub) + " ";
  for (const std::string_view platform : entity_platforms())
    if (const Entry* entities = loader::child(hub, platform))
      for (const Entry& entity : list_of(*entities))
        if (const Entry* name = loader::child(entity, "name"))
          if (name->text.size() <= prefix.size() || !starts_with(name->text, prefix)) return {};
  return prefix;
}

Entry without_prefix(Entry entity, const std::string& prefix) {
  for (Entry& key : entity.children)
    if (key.key == "name") key.text.erase(0, prefix.size());
  return entity;
}

std::vector<ForeignUnit> read_hub(const Entry& hub, Problems& problems) {
  const SecretUnit secret = find_secret_unit(hub, problems);
  if (!secret.is_only_one) return {};
  if (secret.first != nullptr)
    problems.warning(secret.first->at, "the unit id is a secret, which is not read, so it is left out",
                     "give it with --unit, or write it into the map");
  const std::vector<Entry> device = HubReader(hub, problems).read();
  const std::string prefix = prefix_of_names(hub);
  HubPoints points;
  ConversionWarnings losses;
  for (const std::string_view platform : entity_platforms())
    if (const Entry* entities = loader::child(hub, platform))
      for (const Entry& entity : list_of(*entities))
        add_entity(platform, without_prefix(entity, prefix), points, losses, problems);
  for (auto& each : points) each.second.settle(problems);
  for (const Diagnostic& loss : losses.diagnostics(""))
    problems.warning({loss.line, loss.column}, loss.what, loss.remedy);
  if (points.empty() && !problems.has_errors())
    problems.error(hub.at, fmt::format("the hub '{}' has no entities", name_of(hub)),
                   "give it sensors or switches");
  std::vector<ForeignUnit> units;
  for (auto& [number, found] : points) {
    ForeignUnit unit;
    if (secret.first == nullptr) unit.unit = number;
    unit.unit_at = found.at();
    unit.map = section("", hub.at);
    if (loader::child(hub, "name") != nullptr)
      unit.map.children.push_back(scalar(
          "name", mended_name(name_of(hub), "hub") + (points.size() > 1 ? fmt::format("_{}", number) : ""),
          hub.at));
    unit.map.children.insert(unit.map.children.end(), device.begin(), device.end());
    for (Entry& entry : found.take(hub.at)) unit.map.children.push_back(std::move(entry));
    units.push_back(std::move(unit));
  }
  return units;
}

}  // namespace

std::vector<ForeignUnit> read_home_assistant(std::string_view text, const ImportOptions& options,
                                             Problems& problems) {
  const auto file = read_home_assistant_file(text, problems);
  if (!file) return {};
  std::vector<const Entry*> hubs;
  for (const Entry& part : file->parts)
    for (const Entry& hub : list_of(part))
      if (is_hub(hub)) hubs.push_back(&hub);
  report_old_form(*file, hubs.empty(), problems);
  if (options.device.empty() || hubs.empty()) check_included_hubs(*file, problems);
  if (hubs.empty() && problems.has_errors()) return {};
  const Entry* chosen = choose(hubs, options.device, problems);
  if (chosen == nullptr) return {};
  Entry hub = *chosen;
  take_tags_out(hub, file->tags, problems);
  return read_hub(hub, problems);
}

}  // namespace coupler::formats
