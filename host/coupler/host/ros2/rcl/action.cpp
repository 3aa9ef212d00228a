// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/action.hpp"

#include <action_msgs/msg/goal_status_array.hpp>

#include <algorithm>

namespace coupler::rcl {
namespace {

using host::GoalEnd;
using host::GoalNumber;

rcl_clock_t no_clock() { return {}; }

rcl_action_goal_event_t event_of(GoalEnd how) {
  switch (how) {
    case GoalEnd::succeeded: return GOAL_EVENT_SUCCEED;
    case GoalEnd::aborted:
    case GoalEnd::replaced: return GOAL_EVENT_ABORT;
    case GoalEnd::cancelled: break;
  }
  return GOAL_EVENT_CANCELED;
}

rcl_action_goal_info_t info_of(const ActionServer::Uuid& id) {
  rcl_action_goal_info_t info = rcl_action_get_zero_initialized_goal_info();
  std::copy(id.begin(), id.end(), info.goal_id.uuid);
  return info;
}

template <class Id>
ActionServer::Uuid uuid_of(const Id& id) {
  ActionServer::Uuid uuid;
  std::copy_n(std::begin(id.uuid), uuid.size(), uuid.begin());
  return uuid;
}

/// From a message of C to one of C++.
void put_info(const rcl_action_goal_info_t& from, action_msgs::msg::GoalInfo& to) {
  to.goal_id.uuid = uuid_of(from.goal_id);
  to.stamp.sec = from.stamp.sec;
  to.stamp.nanosec = from.stamp.nanosec;
}

std::int8_t status_of(const rcl_action_goal_handle_t* goal) {
  rcl_action_goal_state_t state = GOAL_STATE_UNKNOWN;
  ignore(rcl_action_goal_handle_get_status(goal, &state));
  return state;
}

}  // namespace

ActionServer::ActionServer(Node& node, std::string name, const rosidl_action_type_support_t* type,
                           std::function<void(GoalNumber)> cancel)
    : node_(node),
      name_(std::move(name)),
      cancel_(std::move(cancel)),
      clock_(no_clock(), [](rcl_clock_t* clock) { return rcl_clock_fini(clock); }),
      server_(rcl_action_get_zero_initialized_server(),
              [&node](auto* server) { return rcl_action_server_fini(server, node.get()); }) {
  const std::string failure = "cannot offer the action " + name_;
  rcl_allocator_t allocator = rcl_get_default_allocator();
  check(rcl_clock_init(RCL_SYSTEM_TIME, clock_.get(), &allocator), failure);
  const rcl_action_server_options_t options = rcl_action_server_get_default_options();
  check(rcl_action_server_init(server_.get(), node.get(), clock_.get(), type, name_.c_str(), &options),
        failure);
}

ActionServer::~ActionServer() {
  for (auto& [id, handle] : handles_) ignore(rcl_action_goal_handle_fini(&handle));
}

void ActionServer::listen(std::function<bool()> take_goal, std::function<bool()> take_result) {
  const std::string failure = "cannot offer the action " + name_;
  const auto follow = [&](std::optional<Inbox::Source>& source, auto set_callback,
                          std::function<bool()> take) {
    source.emplace(node_.inbox(), static_cast<const rcl_action_server_t*>(server_.get()), set_callback,
                   std::move(take), failure);
  };
  follow(goal_requests_, rcl_action_server_set_goal_service_callback, std::move(take_goal));
  follow(cancel_requests_, rcl_action_server_set_cancel_service_callback, [this] { return take_cancel(); });
  follow(result_requests_, rcl_action_server_set_result_service_callback, std::move(take_result));
}

void ActionServer::stop_listening() {
  goal_requests_.reset();
  cancel_requests_.reset();
  result_requests_.reset();
}

bool ActionServer::has_taken(rcl_ret_t result) {
  return node_.has_taken(result, RCL_RET_ACTION_SERVER_TAKE_FAILED, "cannot read a call of ", name_.c_str());
}

void ActionServer::check_answer(rcl_ret_t result) {
  if (result != RCL_RET_OK) node_.log_failure("cannot answer a call of " + name_);
}

bool ActionServer::exists(const Uuid& id) const {
  const rcl_action_goal_info_t info = info_of(id);
  return rcl_action_server_goal_exists(server_.get(), &info);
}

std::optional<ActionServer::Uuid> ActionServer::running(GoalNumber number) const {
  const auto at = goals_.find(number);
  return at == goals_.end() ? std::nullopt : std::optional(at->second);
}

std::optional<GoalNumber> ActionServer::accept(const Uuid& id, builtin_interfaces::msg::Time& at) {
  if (exists(id)) return std::nullopt;
  rcl_action_goal_info_t info = info_of(id);
  rcl_action_goal_handle_t* const goal = rcl_action_accept_new_goal(server_.get(), &info);
  if (goal == nullptr) {
    check_answer(RCL_RET_ERROR);
    return std::nullopt;
  }
  check_answer(rcl_action_update_goal_state(goal, GOAL_EVENT_EXECUTE));
  ignore(rcl_action_goal_handle_get_info(goal, &info));
  at.sec = info.stamp.sec;
  at.nanosec = info.stamp.nanosec;
  handles_.emplace(id, *goal);
  goals_.emplace(++last_, id);
  return last_;
}

std::optional<std::pair<ActionServer::Uuid, std::int8_t>> ActionServer::end(GoalNumber number, GoalEnd how) {
  const auto at = goals_.find(number);
  if (at == goals_.end()) return std::nullopt;
  const Uuid id = at->second;
  goals_.erase(at);
  rcl_action_goal_handle_t& goal = handles_.at(id);
  check_answer(rcl_action_update_goal_state(&goal, event_of(how)));
  check_answer(rcl_action_notify_goal_done(server_.get()));
  publish_status();
  return std::pair{id, status_of(&goal)};
}

std::vector<ActionServer::Uuid> ActionServer::expired() {
  std::vector<Uuid> result;
  for (;;) {
    std::array<rcl_action_goal_info_t, 16> infos{};
    std::size_t count = 0;
    if (rcl_action_expire_goals(server_.get(), infos.data(), infos.size(), &count) != RCL_RET_OK)
      rcl_reset_error();
    for (std::size_t i = 0; i < count; ++i) {
      result.push_back(uuid_of(infos[i].goal_id));
      if (const auto handle = handles_.find(result.back()); handle != handles_.end()) {
        ignore(rcl_action_goal_handle_fini(&handle->second));
        handles_.erase(handle);
      }
    }
    if (count < infos.size()) return result;
  }
}

/// rcl gives it as a message of C; the server's types are those of C++.
void ActionServer::publish_status() {
  Handle<rcl_action_goal_status_array_t> status(rcl_action_get_zero_initialized_goal_status_array(),
                                                rcl_action_goal_status_array_fini);
  check_answer(rcl_action_get_goal_status_array(server_.get(), status.get()));
  action_msgs::msg::GoalStatusArray message;
  const auto& list = status.get()->msg.status_list;
  for (std::size_t i = 0; i < list.size; ++i) {
    auto& goal = message.status_list.emplace_back();
    goal.status = list.data[i].status;
    put_info(list.data[i].goal_info, goal.goal_info);
  }
  check_answer(rcl_action_publish_status(server_.get(), &message));
}

/// rcl chooses the goals that a request means: one, all, or those before a time.
std::vector<GoalNumber> ActionServer::cancel_goals(const action_msgs::srv::CancelGoal::Request& request,
                                                   action_msgs::srv::CancelGoal::Response& response) {
  rcl_action_cancel_request_t asked = rcl_action_get_zero_initialized_cancel_request();
  asked.goal_info = info_of(uuid_of(request.goal_info.goal_id));
  asked.goal_info.stamp.sec = request.goal_info.stamp.sec;
  asked.goal_info.stamp.nanosec = request.goal_info.stamp.nanosec;
  Handle<rcl_action_cancel_response_t> chosen(rcl_action_get_zero_initialized_cancel_response(),
                                              rcl_action_cancel_response_fini);
  std::vector<GoalNumber> cancelled;
  const rcl_ret_t result = rcl_action_process_cancel_request(server_.get(), &asked, chosen.get());
  check_answer(result);
  if (result != RCL_RET_OK) {
    response.return_code = action_msgs::srv::CancelGoal::Response::ERROR_REJECTED;
    return cancelled;
  }
  response.return_code = chosen.get()->msg.return_code;
  const auto& infos = chosen.get()->msg.goals_canceling;
  for (std::size_t i = 0; i < infos.size; ++i) {
    const Uuid id = uuid_of(infos.data[i].goal_id);
    const auto goal =
        std::find_if(goals_.begin(), goals_.end(), [&](const auto& each) { return each.second == id; });
    if (goal == goals_.end()) continue;
    rcl_action_goal_handle_t& handle = handles_.at(id);
    if (status_of(&handle) != GOAL_STATE_CANCELING)
      check_answer(rcl_action_update_goal_state(&handle, GOAL_EVENT_CANCEL_GOAL));
    cancelled.push_back(goal->first);
    put_info(infos.data[i], response.goals_canceling.emplace_back());
  }
  return cancelled;
}

bool ActionServer::take_cancel() {
  action_msgs::srv::CancelGoal::Request request;
  action_msgs::srv::CancelGoal::Response response;
  RequestId id;
  std::vector<GoalNumber> cancelled;
  {
    const std::lock_guard lock(mutex_);
    if (!has_taken(rcl_action_take_cancel_request(server_.get(), &id, &request))) return false;
    cancelled = cancel_goals(request, response);
    check_answer(rcl_action_send_cancel_response(server_.get(), &id, &response));
    publish_status();
  }
  for (const GoalNumber number : cancelled) cancel_(number);
  return true;
}

}  // namespace coupler::rcl
