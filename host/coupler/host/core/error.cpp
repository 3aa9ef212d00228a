// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/error.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::host {
namespace {

struct Text {
  std::string operator()(const NotConnected& e) const { return e.why; }
  std::string operator()(const TransportFailure& e) const { return e.why; }
  std::string operator()(const Timeout& e) const {
    return fmt::format("no reply within {} ms", e.after.count());
  }
  std::string operator()(const ExceptionReply& e) const {
    if (e.other_value)
      return fmt::format("the device acknowledged another value than was sent: {:#06x}", *e.other_value);
    return fmt::format("exception {:02X} ({})", static_cast<unsigned>(e.code), modbus::to_string(e.code));
  }
  std::string operator()(const BadFrame& e) const { return "malformed reply: " + e.why; }
};

}  // namespace

const ExceptionReply* exception_in(const Error& error) { return std::get_if<ExceptionReply>(&error); }

bool is_no_right(const Error& error) {
  const ExceptionReply* exception = exception_in(error);
  return exception != nullptr && exception->code == modbus::Exception::illegal_function;
}

bool is_unit_away(const Error& error) {
  const ExceptionReply* exception = exception_in(error);
  return exception != nullptr && (exception->code == modbus::Exception::gateway_path_unavailable ||
                                  exception->code == modbus::Exception::gateway_target_failed_to_respond);
}

bool is_unit_refusal(const Error& error) { return exception_in(error) != nullptr && !is_unit_away(error); }

bool is_no_reply(const Error& error) {
  return std::holds_alternative<Timeout>(error) || std::holds_alternative<BadFrame>(error) ||
         is_closed(error);
}

bool is_closed(const Error& error) {
  const auto* broken = std::get_if<TransportFailure>(&error);
  return broken != nullptr && broken->is_instead_of_reply;
}

bool has_remedy(const Error& error) {
  const auto* none = std::get_if<NotConnected>(&error);
  const auto* broken = std::get_if<TransportFailure>(&error);
  const auto* bad = std::get_if<BadFrame>(&error);
  return (none != nullptr && none->has_remedy) || (broken != nullptr && broken->has_remedy) ||
         (bad != nullptr && bad->has_remedy);
}

std::string to_string(const Error& error) { return std::visit(Text{}, error); }

std::string shown_bytes(modbus::Bytes bytes) {
  constexpr std::size_t most = 16;
  std::string text;
  for (std::size_t i = 0; i < std::min(bytes.size(), most); ++i)
    text += fmt::format("{}{:02x}", i > 0 ? " " : "", bytes[i]);
  return bytes.size() > most ? fmt::format("{} … ({} bytes)", text, bytes.size()) : text;
}

BadFrame bad_reply(std::string_view what, modbus::Bytes asked, modbus::Bytes came) {
  return {fmt::format("{}; asked {}, got {}", what, shown_bytes(asked), shown_bytes(came))};
}

Error error_of(const modbus::ReplyError& why, modbus::Bytes asked, modbus::Bytes came) {
  if (why.exception) return ExceptionReply{*why.exception};
  if (why.other_value) return ExceptionReply{static_cast<modbus::Exception>(0), why.other_value};
  return bad_reply("not the reply to this request", asked, came);
}

}  // namespace coupler::host
