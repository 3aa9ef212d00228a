// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/libgpiod1/chips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace coupler::node::libgpiod1 {
namespace {

Chip open(const std::string& path) {
  gpiod_chip* chip = gpiod_chip_open(path.c_str());
  return chip == nullptr ? nullptr : Chip(chip, gpiod_chip_close);
}

std::string name_of(gpiod_line* line) {
  const char* name = gpiod_line_name(line);
  return name == nullptr ? "" : name;
}

/// gpiochip2 before gpiochip10.
bool shorter_first(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

std::string names_of_lines(const Chip& chip) {
  constexpr std::size_t enough = 64;
  std::size_t count = 0;
  std::string text;
  for (unsigned offset = 0; offset < gpiod_chip_num_lines(chip.get()); ++offset) {
    gpiod_line* line = gpiod_chip_get_line(chip.get(), offset);
    if (line == nullptr || name_of(line).empty()) continue;
    if (++count > enough) return text + ", …";
    text += fmt::format("{}'{}'", count == 1 ? "" : ", ", name_of(line));
  }
  return text;
}

}  // namespace

std::string to_string(const FoundLine& found) {
  const std::string name = name_of(found.line);
  return fmt::format("{} line {}{}", gpiod_chip_name(found.chip.get()), gpiod_line_offset(found.line),
                     name.empty() ? "" : " (" + name + ")");
}

Chips::Chips() {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", error))
    if (entry.path().filename().string().rfind("gpiochip", 0) == 0) paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end(), shorter_first);
  for (const std::string& path : paths) {
    if (Chip chip = open(path))
      chips_.push_back(std::move(chip));
    else
      unopened_ += fmt::format("{}{}: {}", unopened_.empty() ? "" : ", ", path, std::strerror(errno));
  }
}

std::string Chips::inventory() const {
  std::string text;
  for (const Chip& chip : chips_)
    text += fmt::format("{}{} '{}' ({} lines)", text.empty() ? "; this machine has " : ", ",
                        gpiod_chip_name(chip.get()), gpiod_chip_label(chip.get()),
                        gpiod_chip_num_lines(chip.get()));
  if (!unopened_.empty())
    text += fmt::format("; cannot be opened: {} (join the group that owns it, see ls -l /dev/gpiochip*)",
                        unopened_);
  if (text.empty()) text = "; this machine has no GPIO chip (run with --sim to do without)";
  return text;
}

tl::expected<FoundLine, std::string> Chips::find(const Line& line) const {
  return line.chip.empty() ? find_by_name(std::string(line.name))
                           : find_by_offset(std::string(line.chip), line.offset);
}

tl::expected<FoundLine, std::string> Chips::find_by_name(const std::string& name) const {
  std::vector<FoundLine> found;
  for (const Chip& chip : chips_)
    for (unsigned offset = 0; offset < gpiod_chip_num_lines(chip.get()); ++offset) {
      gpiod_line* line = gpiod_chip_get_line(chip.get(), offset);
      if (line != nullptr && name_of(line) == name) found.push_back({chip, line});
    }
  if (found.size() == 1) return found.front();
  if (found.size() > 1)
    return tl::unexpected(fmt::format("the name '{}' belongs to {} and to {}; choose one by chip and offset",
                                      name, to_string(found[0]), to_string(found[1])));
  std::string named;
  for (const Chip& chip : chips_)
    if (const std::string names = names_of_lines(chip); !names.empty())
      named += fmt::format("; named on {}: {}", gpiod_chip_name(chip.get()), names);
  return tl::unexpected(fmt::format("no GPIO line is named '{}'{}{}", name, inventory(), named));
}

tl::expected<FoundLine, std::string> Chips::find_by_offset(const std::string& wanted, unsigned offset) const {
  auto chip = find_chip(wanted);
  if (!chip) return tl::unexpected(std::move(chip).error());
  const unsigned lines = gpiod_chip_num_lines(chip->get());
  gpiod_line* line = offset < lines ? gpiod_chip_get_line(chip->get(), offset) : nullptr;
  if (line == nullptr)
    return tl::unexpected(fmt::format("{} has no line {}; it has lines 0 … {}", gpiod_chip_name(chip->get()),
                                      offset, lines - 1));
  return FoundLine{*std::move(chip), line};
}

tl::expected<Chip, std::string> Chips::find_chip(const std::string& wanted) const {
  // A path may be a link that udev made: the kernel's name is what it leads to.
  std::error_code error;
  const std::string real = wanted.find('/') == std::string::npos
                               ? wanted
                               : std::filesystem::canonical(wanted, error).filename().string();
  for (const Chip& chip : chips_)
    if (gpiod_chip_name(chip.get()) == real || gpiod_chip_label(chip.get()) == wanted) return chip;
  return tl::unexpected(
      fmt::format("there is no GPIO chip '{}' (by name, path or label){}", wanted, inventory()));
}

}  // namespace coupler::node::libgpiod1
