// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/line_requests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "coupler/device/gpio/backend.hpp"
#include "coupler/device/gpio/watched_inputs.hpp"

namespace coupler::device {
namespace {

HeldRequest held(const std::vector<LineSpec>& lines) {
  HeldRequest held;
  for (const LineSpec& line : lines) held.lines.push_back(held_as(line));
  return held;
}

}  // namespace

HeldLine held_as(const LineSpec& wanted) {
  const Line& line = wanted.point->line;
  return {
      wanted.line.chip->name, wanted.line.offset, is_output(wanted), line.active_low, line.bias, line.drive,
      line.debounce,          wanted.counted,     wanted.watched,    wanted.point};
}

bool is_same_line(const HeldLine& a, const HeldLine& b) { return a.chip == b.chip && a.offset == b.offset; }

bool is_same_request(const HeldLine& a, const HeldLine& b) {
  const auto settings = [](const HeldLine& line) {
    return std::tie(line.output, line.active_low, line.bias, line.drive, line.debounce, line.counted,
                    line.watched);
  };
  return is_same_line(a, b) && settings(a) == settings(b);
}

WiredOutputs wired_outputs(std::shared_ptr<OutputGroup> group, const std::vector<LineSpec>& lines,
                           bool readback) {
  WiredOutputs wired{std::move(group), {}, readback, held(lines)};
  for (const LineSpec& line : lines)
    wired.lines.push_back({line.point->address, line.point->safe, line.level});
  return wired;
}

WiredInputs wired_inputs(std::shared_ptr<InputGroup> group, const std::vector<LineSpec>& lines) {
  WiredInputs wired{std::move(group), {}, held(lines)};
  for (const LineSpec& line : lines) wired.addresses.emplace_back(line.point->address);
  return wired;
}

WiredInputs sampled_inputs(std::unique_ptr<InputGroup> plain, const std::vector<LineSpec>& lines) {
  auto group = std::make_shared<SampledInputs>(std::move(plain), lines, TimePoint::clock::now());
  WiredInputs wired = wired_inputs(std::move(group), lines);
  wired.request.sampled = true;
  return wired;
}

LineRequests::Prepared LineRequests::prepare_next(const Map& map, bool safe, Log& log) {
  return prepare(map, this, safe, log);
}

tl::expected<void, std::string> LineRequests::request(const std::vector<LineSpec>& lines, bool readback) {
  if (is_output(lines.front())) {
    auto group = backend::request_outputs(lines);
    if (!group) return tl::unexpected(std::move(group).error());
    lines_.add(wired_outputs(*std::move(group), lines, readback));
    return {};
  }
  if (!lines.front().watched) return request_sampled(lines, "too many inputs are watched already");
  auto group = backend::request_inputs(lines);
  if (!group) return request_apart(lines, group.error());
  lines_.add(wired_inputs(*std::move(group), lines));
  return {};
}

/// The kernel refuses a request as a whole. Lines that need their edges are refused then; of the others those
/// that report none are sampled.
tl::expected<void, std::string> LineRequests::request_apart(const std::vector<LineSpec>& lines,
                                                            const std::string& error) {
  std::vector<LineSpec> watched;
  std::vector<LineSpec> others;
  for (const LineSpec& line : lines) {
    const bool works = lines.size() > 1 && backend::request_inputs({line}).has_value();
    (works ? watched : others).push_back(line);
  }
  if (others.empty()) watched.swap(others);  // the kernel takes each, but not all of them
  const auto needed =
      std::stable_partition(others.begin(), others.end(), [](const LineSpec& line) { return !line.counted; });
  watched.insert(watched.end(), needed, others.end());
  others.erase(needed, others.end());
  if (others.empty()) return tl::unexpected(error);
  if (!watched.empty())
    if (auto made = request(watched, false); !made) return made;
  return request_sampled(others, "its chip reports no edges");
}

/// In as few requests as their settings allow.
tl::expected<void, std::string> LineRequests::request_sampled(const std::vector<LineSpec>& lines,
                                                              std::string_view why) {
  std::vector<LineSpec> group;
  std::vector<LineSpec> wanted;
  std::vector<LineSpec> rest;
  for (const LineSpec& line : lines) {
    LineSpec plain = line;
    plain.watched = false;
    const bool joins = group.empty() || backend::fits(group, plain);
    if (joins) group.push_back(plain);
    (joins ? wanted : rest).push_back(line);
  }
  auto plain = backend::request_inputs(group);
  if (!plain) return tl::unexpected(std::move(plain).error());
  log_.write(fmt::format("{}: {}, so the level is read every {} ms", names_of(wanted), why,
                         SampledInputs::period.count()));
  lines_.add(sampled_inputs(*std::move(plain), wanted));
  return rest.empty() ? tl::expected<void, std::string>() : request_sampled(rest, why);
}

void LineRequests::add_missing(const std::vector<LineSpec>& lines, bool readback) {
  if (is_output(lines.front())) {
    WiredOutputs missing = wired_outputs(std::make_shared<AbsentOutputs>(names_of(lines)), lines, readback);
    missing.request.lost = true;
    lines_.add(std::move(missing));
  } else {
    WiredInputs missing = wired_inputs(std::make_shared<AbsentInputs>(names_of(lines)), lines);
    missing.request.lost = true;
    lines_.add(std::move(missing));
  }
}

}  // namespace coupler::device
