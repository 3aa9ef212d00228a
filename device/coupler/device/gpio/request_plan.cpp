// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/request_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace coupler::device {
namespace {

using LineSpecs = std::vector<LineSpec>;

KeptRequest matching(std::size_t group, const HeldRequest& held, const LineSpecs& wanted) {
  KeptRequest kept{group, {}};
  for (const HeldLine& line : held.lines) {
    const auto match =
        std::find_if(wanted.begin(), wanted.end(), [&](const LineSpec& w) { return held_as(w) == line; });
    kept.wanted.push_back(match == wanted.end() ? nullptr : &*match);
  }
  return kept;
}

bool is_wanted(const LineSpec* wanted) { return wanted != nullptr; }

/// What is wanted of the request with other settings than it has.
LineSpecs changed(const HeldRequest& held, const LineSpecs& wanted) {
  LineSpecs all;
  for (const LineSpec& line : wanted)
    for (const HeldLine& as : held.lines)
      if (is_same_line(held_as(line), as) && !(held_as(line) == as)) all.push_back(line);
  return all;
}

/// To request inputs again moves nothing, so their requests go on only if none of their lines changes.
void sort_inputs(const std::vector<HeldRequest>& held, const LineSpecs& wanted, RequestPlan& result) {
  for (std::size_t group = 0; group < held.size(); ++group) {
    if (held[group].lost) continue;
    KeptRequest kept = matching(group, held[group], wanted);
    if (std::any_of(kept.wanted.begin(), kept.wanted.end(), is_wanted) &&
        changed(held[group], wanted).empty())
      result.inputs.push_back(std::move(kept));
  }
}

void sort_outputs(const std::vector<HeldRequest>& held, const LineSpecs& wanted, RequestPlan& result) {
  for (std::size_t group = 0; group < held.size(); ++group) {
    if (held[group].lost) continue;
    KeptRequest kept = matching(group, held[group], wanted);
    if (std::none_of(kept.wanted.begin(), kept.wanted.end(), is_wanted)) continue;
    for (const LineSpec& line : changed(held[group], wanted))
      result.errors += fmt::format(
          "{}point '{}': {} is held by one request together with outputs that stay, so its direction and its "
          "keys (active_low, bias, drive) cannot change while the node runs; start the node anew",
          result.errors.empty() ? "" : "\n", line.point->name, to_string(line.line));
    result.outputs.push_back(std::move(kept));
  }
}

bool is_in(const std::vector<KeptRequest>& requests, const LineSpec& wanted) {
  return std::any_of(requests.begin(), requests.end(), [&](const KeptRequest& request) {
    return std::find(request.wanted.begin(), request.wanted.end(), &wanted) != request.wanted.end();
  });
}

bool is_held(const std::vector<HeldRequest>& all, const LineSpec& wanted) {
  return std::any_of(all.begin(), all.end(), [&](const HeldRequest& held) {
    return !held.lost && std::any_of(held.lines.begin(), held.lines.end(), [&](const HeldLine& line) {
      return is_same_line(line, held_as(wanted));
    });
  });
}

}  // namespace

RequestPlan plan_requests(const LineRequests* before, const LineSpecs& wanted) {
  RequestPlan result;
  if (before == nullptr) {
    result.fresh = wanted;
    return result;
  }
  sort_outputs(before->outputs(), wanted, result);
  sort_inputs(before->inputs(), wanted, result);
  for (const LineSpec& line : wanted) {
    if (is_in(result.outputs, line) || is_in(result.inputs, line)) continue;
    const bool held = is_held(before->outputs(), line) || is_held(before->inputs(), line);
    (held ? result.later : result.fresh).push_back(line);
  }
  return result;
}

}  // namespace coupler::device
