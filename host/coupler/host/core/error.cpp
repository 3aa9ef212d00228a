// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/error.hpp"

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
  return (none != nullptr && none->has_remedy) || (broken != nullptr && broken->has_remedy);
}

std::string to_string(const Error& error) { return std::visit(Text{}, error); }

}  // namespace coupler::host
