// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/inventory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "coupler/base/starts_with.hpp"

namespace coupler::device {
namespace {

/// gpiochip2 before gpiochip10.
bool shorter_first(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

std::string names_of_lines(const Chip& chip) {
  constexpr std::size_t enough = 64;
  std::size_t count = 0;
  std::string text;
  for (const std::string& name : chip.lines) {
    if (name.empty()) continue;
    if (++count > enough) return text + ", ...";
    text += fmt::format("{}'{}'", count == 1 ? "" : ", ", name);
  }
  return text;
}

std::string busy_lines(const std::vector<LineSpec>& lines, const HolderOf& holder_of) {
  std::string text;
  for (const LineSpec& wanted : lines) {
    const auto holder = holder_of(wanted.line.offset);
    if (!holder) continue;
    text += fmt::format("{}point '{}': {} is busy: held by {}; release it there or choose another line",
                        text.empty() ? "" : "\n", wanted.point->name, to_string(wanted.line),
                        holder->empty() ? "the kernel" : fmt::format("'{}'", *holder));
  }
  return text;
}

}  // namespace

std::string to_string(const FoundLine& found) {
  const std::string& name = found.chip->lines[found.offset];
  return fmt::format("{} line {}{}", found.chip->name, found.offset, name.empty() ? "" : " (" + name + ")");
}

Inventory::Inventory(ReadChip read, const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code error;
  // Raspberry Pi OS has a link gpiochip4 to gpiochip0: followed, each of its names would belong to two lines.
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (starts_with(entry.path().filename().string(), "gpiochip") && !entry.is_symlink(error))
      paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end(), shorter_first);
  for (const std::string& path : paths) {
    if (auto chip = read(path))
      chips_.push_back(*std::move(chip));
    else
      unopened_ += fmt::format("{}{}: {}", unopened_.empty() ? "" : ", ", path, std::strerror(errno));
  }
}

std::string Inventory::contents() const {
  std::string text;
  for (const Chip& chip : chips_)
    text += fmt::format("{}{} '{}' ({} lines)", text.empty() ? "; this machine has " : ", ", chip.name,
                        chip.label, chip.lines.size());
  if (!unopened_.empty())
    text += fmt::format("; cannot be opened: {} (join the group that owns it, see ls -l /dev/gpiochip*)",
                        unopened_);
  if (text.empty()) text = "; this machine has no GPIO chip (run with --sim to do without)";
  return text;
}

tl::expected<FoundLine, std::string> Inventory::find(const Line& line) const {
  return line.chip.empty() ? find_by_name(line.name) : find_by_offset(std::string(line.chip), line.offset);
}

tl::expected<FoundLine, std::string> Inventory::find_by_name(std::string_view name) const {
  std::vector<FoundLine> found;
  for (const Chip& chip : chips_)
    for (unsigned offset = 0; offset < chip.lines.size(); ++offset)
      if (chip.lines[offset] == name) found.push_back({&chip, offset});
  if (found.size() == 1) return found.front();
  if (found.size() > 1)
    return tl::unexpected(fmt::format("the name '{}' belongs to {} and to {}; choose one by chip and offset",
                                      name, to_string(found[0]), to_string(found[1])));
  std::string named;
  for (const Chip& chip : chips_)
    if (const std::string names = names_of_lines(chip); !names.empty())
      named += fmt::format("; named on {}: {}", chip.name, names);
  if (named.empty() && !chips_.empty() && unopened_.empty()) {
    const Chip& first = chips_.front();
    const bool by_label = !first.label.empty() && find_chip(first.label) == &first;
    named = fmt::format(
        "; none of their lines has a name: write 'line: {{chip: \"{}\", offset: 0}}' for the first one",
        by_label ? first.label : first.name);
  }
  return tl::unexpected(fmt::format("no GPIO line is named '{}'{}{}", name, contents(), named));
}

tl::expected<FoundLine, std::string> Inventory::find_by_offset(const std::string& wanted,
                                                               unsigned offset) const {
  const auto chip = find_chip(wanted);
  if (!chip) return tl::unexpected(chip.error());
  const std::size_t lines = (*chip)->lines.size();
  if (offset >= lines)
    return tl::unexpected(
        fmt::format("{} has no line {}; it has lines 0 to {}", (*chip)->name, offset, lines - 1));
  return FoundLine{*chip, offset};
}

tl::expected<const Chip*, std::string> Inventory::find_chip(const std::string& wanted) const {
  // A path may be a link that udev made: the kernel's name is what it leads to.
  std::error_code error;
  const std::string real = wanted.find('/') == std::string::npos
                               ? wanted
                               : std::filesystem::canonical(wanted, error).filename().string();
  for (const Chip& chip : chips_)
    if (chip.name == real) return &chip;
  std::vector<const Chip*> labelled;
  for (const Chip& chip : chips_)
    if (chip.label == wanted) labelled.push_back(&chip);
  if (labelled.size() == 1) return labelled.front();
  if (labelled.size() > 1)
    return tl::unexpected(fmt::format("the label '{}' belongs to {} and to {}; choose one by path or by name",
                                      wanted, labelled[0]->name, labelled[1]->name));
  return tl::unexpected(
      fmt::format("there is no GPIO chip '{}' (by name, path or label){}", wanted, contents()));
}

std::string names_of(const std::vector<LineSpec>& lines) {
  constexpr std::size_t enough = 8;
  std::string text = to_string(lines.front().line);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (i == enough) return text + fmt::format(" and {} more", lines.size() - i);
    text += ", " + to_string(lines[i].line);
  }
  return text;
}

std::string request_error(const std::vector<LineSpec>& lines, int error, const HolderOf& holder_of) {
  if (error == EBUSY)
    if (std::string busy = busy_lines(lines, holder_of); !busy.empty()) return busy;
  const char* remedy = "";
  if (error == EACCES || error == EPERM)
    remedy = "; run as a user who may write to the chip's device in /dev";
  if (error == EINVAL || error == ENOTSUP || error == ENXIO || error == EIO || error == ENODEV)
    remedy =
        "; check that the chip can do what the map asks (direction, bias, drive, edges for counters, latched "
        "points and debounce)";
  return fmt::format("point '{}': {} cannot be requested: {}{}", lines.front().point->name, names_of(lines),
                     std::strerror(error), remedy);
}

}  // namespace coupler::device
