// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/tools/formats/home_assistant_points.hpp"
#include "coupler/tools/formats/importers.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Position;
using loader::Problems;
using loader::shown;

std::string_view first_line(std::string_view text) {
  return text.substr(0, std::min(text.find('\n'), text.size()));
}

/// "modbus:", and "modbus second:" of a configuration in several parts.
bool is_modbus_key(std::string_view line) {
  const std::string_view key = line.substr(0, line.find(':'));
  return key.size() < line.size() && (key == "modbus" || key.substr(0, 7) == "modbus ");
}

/// Blank lines in place of all that stands below other keys than `modbus:`, which need not be YAML that a
/// map's loader reads. False if there is no such key.
bool keep_modbus_only(std::string& text) {
  std::string kept;
  bool keep = false;
  bool any = false;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = first_line(rest);
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const bool begins_key = !line.empty() &&
                            std::string_view(" \t#\r").find(line[0]) == std::string_view::npos &&
                            line.substr(0, 2) != "- " && line != "-";
    if (begins_key) keep = is_modbus_key(line);
    any = any || keep;
    if (keep) kept += line;
    kept += '\n';
  }
  if (any) text = std::move(kept);
  return any;
}

/// The tags of values, as `!secret` and `!include`, become plain text of the same length. Returns where they
/// were.
std::set<std::pair<int, int>> blank_tags(std::string& text) {
  std::set<std::pair<int, int>> places;
  int line = 1;
  std::size_t line_begins = 0;
  char quote = '\0';
  char before = '\n';  // the last character that is not a blank
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      line_begins = i + 1;
      quote = '\0';
    } else if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '#' && i > line_begins && (text[i - 1] == ' ' || text[i - 1] == '\t')) {
      i = std::min(text.find('\n', i), text.size()) - 1;
      continue;
    } else if ((c == '"' || c == '\'') &&
               std::string_view("\n:-,[{").find(before) != std::string_view::npos) {
      quote = c;
    } else if (c == '!' && std::string_view(":-,[{").find(before) != std::string_view::npos) {
      places.emplace(line, static_cast<int>(i - line_begins) + 1);
      text[i] = '~';
    }
    if (c != ' ' && c != '\t' && c != '\r') before = c;
  }
  return places;
}

/// A secret is left out with a warning; what stands in other files is an error.
void take_tags_out(Entry& entry, const std::set<std::pair<int, int>>& places, Problems& problems) {
  const auto is_tagged = [&](const Entry& child) {
    if (child.kind != Entry::Kind::scalar || places.count({child.at.line, child.at.column}) == 0)
      return false;
    const std::string tag = '!' + child.text.substr(1, child.text.find(' ') - 1);
    const std::string where = child.key.empty() ? "the value" : fmt::format("'{}'", child.key);
    if (tag == "!secret")
      problems.warning(child.at, fmt::format("{} is a secret, which is not read, so it is left out", where),
                       "write it into the map, or in the place of the tag");
    else if (tag.substr(0, 8) == "!include")
      problems.error(child.at, fmt::format("{} stands in another file", where),
                     "give that file, or put its text in the place of the tag");
    else
      problems.error(child.at, fmt::format("the tag {} of {} is not known", shown(tag), where),
                     "write the value in its place");
    return true;
  };
  entry.children.erase(std::remove_if(entry.children.begin(), entry.children.end(), is_tagged),
                       entry.children.end());
  for (Entry& child : entry.children) take_tags_out(child, places, problems);
}

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
    Problems& problems = settings_.problems();
    const std::string type = settings_.text("type", "");
    if (type == "serial" || type == "udp" || type == "rtuovertcp")
      problems.warning(settings_.find("type")->at,
                       fmt::format("the hub is of the type '{}', but a map is for Modbus/TCP", type),
                       "give the address of a gateway in the map");
    if (type == "serial")
      for (const std::string_view key : {"port", "baudrate", "bytesize", "method", "parity", "stopbits"})
        settings_.ignore(key);  // the warning above is about them
    if (const std::string host = settings_.text("host", ""); !host.empty())
      keys_.push_back(scalar("address", host, settings_.find("host")->at));
    if (type != "serial")
      if (const auto port = settings_.whole("port", 65535))
        keys_.push_back(scalar("port", fmt::to_string(*port), settings_.find("port")->at));
    add_timeout();
    add_limits();
    for (const std::string_view key : {"name", "type"}) settings_.ignore(key);
    for (const std::string_view platform : entity_platforms()) settings_.ignore(platform);
    settings_.report_rest();
    return std::move(keys_);
  }

 private:
  void add_timeout() {
    constexpr double longest = 60;
    const double timeout = settings_.number("timeout").value_or(0);
    if (timeout <= 0) return;
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
  std::vector<Entry> keys_;
};

std::vector<ForeignUnit> read_hub(const Entry& hub, Problems& problems) {
  const std::vector<Entry> device = HubReader(hub, problems).read();
  HubPoints points;
  ConversionWarnings losses;
  for (const std::string_view platform : entity_platforms())
    if (const Entry* entities = loader::child(hub, platform))
      for (const Entry& entity : list_of(*entities)) add_entity(platform, entity, points, losses, problems);
  for (const Diagnostic& loss : losses.diagnostics("")) problems.warning(hub.at, loss.what, loss.remedy);
  if (points.empty() && !problems.has_errors())
    problems.error(hub.at, fmt::format("the hub '{}' has no entities", name_of(hub)),
                   "give it sensors or switches");
  std::vector<ForeignUnit> units;
  for (auto& [number, found] : points) {
    ForeignUnit unit;
    unit.unit = number;
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
  std::string kept(text);
  const bool whole = keep_modbus_only(kept);
  const auto places = blank_tags(kept);
  auto root = loader::parse_document(kept, problems);
  if (!root) return {};
  take_tags_out(*root, places, problems);
  std::vector<const Entry*> hubs;
  for (const Entry& part : whole ? Span<const Entry>(root->children) : Span<const Entry>(&*root, 1))
    for (const Entry& hub : list_of(part))
      if (is_hub(hub)) hubs.push_back(&hub);
  if (hubs.empty() && problems.has_errors()) return {};
  const Entry* hub = choose(hubs, options.device, problems);
  return hub != nullptr ? read_hub(*hub, problems) : std::vector<ForeignUnit>{};
}

}  // namespace coupler::formats
