// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/backend.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "coupler/device/gpio/libgpiod2/inputs.hpp"
#include "coupler/device/gpio/libgpiod2/request.hpp"

namespace coupler::device::backend {
namespace {

using namespace libgpiod2;

/// Outputs of one request: one system call drives them all.
class Outputs : public OutputGroup {
 public:
  Outputs(Request request, std::string name) : request_(std::move(request)), name_(std::move(name)) {}
  const std::string& name() const override { return name_; }
  bool is_plugged() override { return request_.is_plugged(); }
  int drive(Span<const int> levels) override {
    for (std::size_t i = 0; i < levels.size(); ++i)
      values_[i] = levels[i] != 0 ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    return gpiod_line_request_set_values(request_.lines.get(), values_.data()) == 0 ? 0 : errno;
  }
  int read(Span<int> levels) override {
    if (gpiod_line_request_get_values(request_.lines.get(), values_.data()) != 0) return errno;
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = values_[i] == GPIOD_LINE_VALUE_ACTIVE ? 1 : 0;
    return 0;
  }

 private:
  Request request_;
  std::array<gpiod_line_value, max_group_size> values_{};
  std::string name_;
};

std::size_t kinds(const std::vector<LineSpec>& lines) {
  std::size_t count = 0;
  for (auto line = lines.begin(); line != lines.end(); ++line)
    if (std::none_of(lines.begin(), line, [&](const LineSpec& other) { return same_kind(other, *line); }))
      ++count;
  return count;
}

/// nullopt with errno set if it cannot be opened.
std::optional<Chip> read_chip(const std::string& path) {
  const ChipHandle chip(gpiod_chip_open(path.c_str()));
  if (!chip) return std::nullopt;
  const Owned<gpiod_chip_info, gpiod_chip_info_free> info(gpiod_chip_get_info(chip.get()));
  if (!info) return std::nullopt;
  Chip read{path, gpiod_chip_info_get_name(info.get()), gpiod_chip_info_get_label(info.get()), {}};
  read.lines.resize(gpiod_chip_info_get_num_lines(info.get()));
  for (unsigned offset = 0; offset < read.lines.size(); ++offset) {
    const Owned<gpiod_line_info, gpiod_line_info_free> line(gpiod_chip_get_line_info(chip.get(), offset));
    const char* name = line ? gpiod_line_info_get_name(line.get()) : nullptr;
    if (name != nullptr) read.lines[offset] = name;
  }
  return read;
}

}  // namespace

Inventory chips() { return Inventory(read_chip); }

bool fits(const std::vector<LineSpec>& group, const LineSpec& line) {
  if (group.front().line.chip != line.line.chip || is_output(group.front()) != is_output(line)) return false;
  const bool known =
      std::any_of(group.begin(), group.end(), [&](const LineSpec& other) { return same_kind(other, line); });
  return known || kinds(group) < max_kinds;
}

tl::expected<std::unique_ptr<OutputGroup>, std::string> request_outputs(const std::vector<LineSpec>& lines) {
  auto made = request(lines);
  if (!made) return tl::unexpected(std::move(made).error());
  return std::make_unique<Outputs>(*std::move(made), names_of(lines));
}

tl::expected<backend::Inputs, std::string> request_inputs(const std::vector<LineSpec>& lines) {
  auto made = request(lines);
  if (!made) return tl::unexpected(std::move(made).error());
  auto group = std::make_unique<libgpiod2::Inputs>(*std::move(made), lines);
  const bool counted =
      std::any_of(lines.begin(), lines.end(), [](const LineSpec& line) { return line.counted.has_value(); });
  EventSource* events = counted ? group.get() : nullptr;
  return backend::Inputs{std::move(group), events};
}

}  // namespace coupler::device::backend
