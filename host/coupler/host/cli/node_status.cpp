// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/node_status.hpp"

#include "coupler/host/core/node_map.hpp"
#include "coupler/host/scan/identification.hpp"

namespace coupler::cli {
namespace {

using host::Error;
using host::Result;

bool is_answer(const Error& error) { return exception_in(error) != nullptr && !is_unit_away(error); }

/// Whether the device has answered; an error ends the questions.
Result<bool> read_area(host::Transport& transport, NodeStatus& status) {
  const auto report = host::read_report(transport);
  if (!report) {
    if (is_unit_away(report.error())) return tl::make_unexpected(report.error());
    status.trouble = to_string(report.error());
    transport.close();  // a late answer must not be taken for another
    if (auto connected = transport.connect(); !connected) return tl::make_unexpected(connected.error());
    return false;
  }
  status.report = *report;
  if (!status.report) return true;
  const auto machine = host::read_machine(transport);
  if (!machine) return tl::make_unexpected(machine.error());
  status.machine = *machine;
  return true;
}

Result<> read_all(host::Transport& transport, const Identify& identify, NodeStatus& status) {
  if (auto connected = transport.connect(); !connected) return connected;
  const auto answered = read_area(transport, status);
  if (!answered) return tl::make_unexpected(answered.error());
  std::optional<Error> failure;
  const auto ask = [&](modbus::ReadDeviceIdentification wanted) -> std::optional<scan::IdentificationPage> {
    auto page = identify(wanted);
    if (page || is_answer(page.error())) status.trouble.clear();  // it is there, and foreign
    if (page) return *std::move(page);
    if (!is_answer(page.error())) failure = page.error();
    return std::nullopt;
  };
  status.identification = scan::read_identification(ask);
  // A foreign coupler may ignore this question as well.
  if (failure && (status.report || is_unit_away(*failure))) return tl::make_unexpected(*failure);
  return {};
}

}  // namespace

NodeStatus read_status(host::Transport& transport, const Identify& identify) {
  NodeStatus status;
  if (const auto done = read_all(transport, identify, status); !done)
    status.trouble = to_string(done.error());
  transport.close();
  status.at = std::chrono::system_clock::now();
  return status;
}

}  // namespace coupler::cli
