// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/backend.hpp"

#include <cerrno>
#include <utility>

#include "coupler/device/gpio/libgpiod1/event_line.hpp"
#include "coupler/device/gpio/libgpiod1/request.hpp"

namespace coupler::device::backend {
namespace {

using libgpiod1::Request;

/// Outputs of one request: one system call drives them all.
class ValueOutputs : public OutputGroup {
 public:
  explicit ValueOutputs(std::unique_ptr<Request> request) : request_(std::move(request)) {}
  const std::string& name() const override { return request_->name(); }
  bool is_plugged() override { return request_->is_plugged(); }
  int drive(Span<const int> levels) override {
    return gpiod_line_set_value_bulk(request_->bulk(), levels.data()) == 0 ? 0 : errno;
  }
  int read(Span<int> levels) override {
    return gpiod_line_get_value_bulk(request_->bulk(), levels.data()) == 0 ? 0 : errno;
  }

 private:
  std::unique_ptr<Request> request_;
};

/// Inputs of one request: one system call reads them all.
class ValueInputs : public InputGroup {
 public:
  explicit ValueInputs(std::unique_ptr<Request> request) : request_(std::move(request)) {}
  const std::string& name() const override { return request_->name(); }
  bool is_plugged() override { return request_->is_plugged(); }
  int read(Span<int> levels, TimePoint) override {
    return gpiod_line_get_value_bulk(request_->bulk(), levels.data()) == 0 ? 0 : errno;
  }

 private:
  std::unique_ptr<Request> request_;
};

/// libgpiod 1 has no debounce: it is made of both edges and their times.
std::optional<Edge> edges_of(const LineSpec& wanted) {
  if (is_output(wanted)) return std::nullopt;
  return wanted.point->line.debounce.count() > 0 ? Edge::both : wanted.counted;
}

int request_type(Edge edge) {
  switch (edge) {
    case Edge::rising: return GPIOD_LINE_REQUEST_EVENT_RISING_EDGE;
    case Edge::falling: return GPIOD_LINE_REQUEST_EVENT_FALLING_EDGE;
    case Edge::both: break;
  }
  return GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES;
}

/// nullopt with errno set if it cannot be opened.
std::optional<Chip> read_chip(const std::string& path) {
  const libgpiod1::ChipHandle chip(gpiod_chip_open(path.c_str()), gpiod_chip_close);
  if (!chip) return std::nullopt;
  Chip read{path, gpiod_chip_name(chip.get()), gpiod_chip_label(chip.get()), {}};
  read.lines.resize(gpiod_chip_num_lines(chip.get()));
  for (unsigned offset = 0; offset < read.lines.size(); ++offset) {
    gpiod_line* line = gpiod_chip_get_line(chip.get(), offset);
    const char* name = line == nullptr ? nullptr : gpiod_line_name(line);
    if (name != nullptr) read.lines[offset] = name;
  }
  return read;
}

}  // namespace

Inventory chips() { return Inventory(read_chip); }

bool fits(const std::vector<LineSpec>& group, const LineSpec& line) {
  const LineSpec& first = group.front();
  return first.line.chip == line.line.chip && is_output(first) == is_output(line) && !edges_of(first) &&
         !edges_of(line) && libgpiod1::flags_of(first.point->line) == libgpiod1::flags_of(line.point->line);
}

tl::expected<std::unique_ptr<OutputGroup>, std::string> request_outputs(const std::vector<LineSpec>& lines) {
  auto request = Request::make(lines, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT);
  if (!request) return tl::unexpected(std::move(request).error());
  return std::make_unique<ValueOutputs>(*std::move(request));
}

tl::expected<Inputs, std::string> request_inputs(const std::vector<LineSpec>& lines) {
  const auto edges = edges_of(lines.front());
  auto request = Request::make(lines, edges ? request_type(*edges) : GPIOD_LINE_REQUEST_DIRECTION_INPUT);
  if (!request) return tl::unexpected(std::move(request).error());
  if (!edges) return Inputs{std::make_unique<ValueInputs>(*std::move(request)), nullptr};
  auto line =
      std::make_unique<libgpiod1::EventLine>(*std::move(request), *edges, lines.front().point->line.debounce);
  EventSource* events = line.get();
  return Inputs{std::move(line), events};
}

}  // namespace coupler::device::backend
