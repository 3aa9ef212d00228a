// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "coupler/host/ros/node.hpp"

namespace coupler::host {

// They fill the responses of services of either ROS.

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

/// The services of either ROS. Types names the types of its services; `Adapter::serve<S>(name, function)`
/// offers one whose calls are function(request, response) in the adapter's thread.
template <class Adapter, class Types>
class TypedServiceThread : public ServiceThread {
 public:
  void offer_write(
      const std::string& name,
      std::function<WriteTicket::Outcome(const std::string&, const std::string&)> call) override {
    serve<typename Types::Write>(name, [call = std::move(call)](const auto& request, auto& response) {
      fill(response, call(request.point, request.value));
    });
  }
  void offer_read(const std::string& name, std::function<ReadAnswer(const std::string&)> call) override {
    serve<typename Types::Read>(name, [call = std::move(call)](const auto& request, auto& response) {
      fill(response, call(request.point));
    });
  }
  void offer_set(const std::string& name, std::function<Calls::Answer(bool)> call) override {
    serve<typename Types::SetBool>(name, [call = std::move(call)](const auto& request, auto& response) {
      fill(response, call(request.data != 0));
    });
  }
  void offer_trigger(const std::string& name, std::function<Calls::Answer()> call) override {
    serve<typename Types::Trigger>(
        name, [call = std::move(call)](const auto&, auto& response) { fill(response, call()); });
  }

 private:
  template <class S, class Function>
  void serve(const std::string& name, Function function) {
    static_cast<Adapter&>(*this).template serve<S>(name, std::move(function));
  }
};

}  // namespace coupler::host
