// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/write_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/host/core/error.hpp"

namespace coupler::host {
namespace {

using Outcome = WriteResult::Outcome;

std::string registers_text(Span<const std::uint16_t> registers) {
  return fmt::format("{:#06x}", fmt::join(registers.begin(), registers.end(), " "));
}

std::string exception_text(const WriteResult& result) {
  return to_string(Error(ExceptionReply{result.exception.value_or(modbus::Exception{})}));
}

std::string not_taken_text(const WriteResult& result) {
  if (result.found.empty())
    return fmt::format("not taken: acknowledged, but it cannot be read back: {}", exception_text(result));
  return fmt::format("not taken: acknowledged, but {} was written and {} reads back",
                     registers_text(result.written), registers_text(result.found));
}

}  // namespace

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::ok: return "ok";
    case Outcome::superseded: return "superseded";
    case Outcome::exception: return "exception";
    case Outcome::not_taken: return "not taken";
    case Outcome::lost: return "lost";
    case Outcome::dropped: return "dropped";
    case Outcome::kept: return "kept";
    case Outcome::refused: return "refused";
  }
  return "?";
}

std::string to_string(const WriteResult& result) {
  switch (result.outcome) {
    case Outcome::exception: return exception_text(result);
    case Outcome::not_taken: return not_taken_text(result);
    case Outcome::kept: return "kept: it is written when the device is back";
    case Outcome::ok:
    case Outcome::superseded: return std::string(to_string(result.outcome));
    case Outcome::lost:
    case Outcome::dropped:
    case Outcome::refused: break;
  }
  return fmt::format("{}: {}", to_string(result.outcome), result.why);
}

}  // namespace coupler::host
