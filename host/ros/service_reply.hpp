// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/ros/node.hpp"

// They fill the responses of services of either ROS.
namespace coupler::driver {

/// coupler_driver/Write.
template <class Response>
void fill(Response& response, const WriteTicket::Outcome& outcome) {
  using Outcome = WriteResult::Outcome;
  static_assert(outcome_number(Outcome::ok) == Response::OK &&
                outcome_number(Outcome::superseded) == Response::SUPERSEDED &&
                outcome_number(Outcome::exception) == Response::EXCEPTION &&
                outcome_number(Outcome::not_taken) == Response::NOT_TAKEN &&
                outcome_number(Outcome::lost) == Response::LOST &&
                outcome_number(Outcome::dropped) == Response::DROPPED &&
                outcome_number(Outcome::kept) == Response::KEPT &&
                outcome_number(Outcome::refused) == Response::REFUSED);
  response.success = outcome.outcome == Outcome::ok;
  response.outcome = outcome_number(outcome.outcome);
  response.exception = outcome.exception ? static_cast<std::uint8_t>(*outcome.exception) : std::uint8_t{0};
  response.message = outcome.text;
}

/// coupler_driver/Read.
template <class Response>
void fill(Response& response, const ServiceThread::ReadAnswer& answer) {
  response.success = answer.success;
  response.value = answer.value;
  response.message = answer.message;
}

/// std_srvs/SetBool and std_srvs/Trigger.
template <class Response>
void fill(Response& response, const Calls::Answer& answer) {
  response.success = answer.success;
  response.message = answer.text;
}

}  // namespace coupler::driver
