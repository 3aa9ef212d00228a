// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/context.h>
#include <rcl/node.h>
#include <rcl/wait.h>

#include <string>
#include <vector>

#include "coupler/base/log_line_limit.hpp"
#include "coupler/host/ros2/rcl/error.hpp"
#include "coupler/host/ros2/rcl/inbox.hpp"

namespace coupler::rcl {

/// ROS 2 in this process, with its arguments and its logging. There is one in a process.
class Context {
 public:
  /// `arguments`: the program, "--ros-args" and what follows. Throws Error.
  explicit Context(const std::vector<std::string>& arguments);

  rcl_context_t* get() { return context_.get(); }
  const rcl_arguments_t& arguments() const { return context_.get()->global_arguments; }

 private:
  Handle<rcl_context_t> context_;
};

/// A node, and the inbox of what is made in it. All of that must be destroyed before the node.
class Node {
 public:
  /// The name and "/" are overridden by `__node:=` and `__ns:=`. Throws Error.
  Node(Context& context, const std::string& name);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  rcl_node_t* get() { return node_.get(); }
  const rcl_node_t* get() const { return node_.get(); }
  Inbox& inbox() { return inbox_; }
  std::string name() const { return rcl_node_get_name(node_.get()); }
  /// "/cell/press_driver"
  std::string full_name() const { return rcl_node_get_fully_qualified_name(node_.get()); }

  /// To the terminal and to /rosout. Any thread may call. `severity`: rcutils' RCUTILS_LOG_SEVERITY.
  void log(int severity, const std::string& text) const;
  /// Logs the error of the last call in this thread that failed, at most one line a second.
  void log_failure(const std::string& what);
  /// Checks a call of rcl that takes something. `nothing` is its result if there was nothing; any other
  /// failure is logged.
  bool has_taken(rcl_ret_t result, rcl_ret_t nothing, const char* failure, const char* name);

  /// Returns the name with its namespace; `remapped`: as the arguments remap topics. Throws Error.
  std::string full_topic(const std::string& name, bool remapped = true) const;

  /// Returns whether an end of a topic or a name has come or gone since the last call. For one thread.
  bool graph_has_changed();

  /// Returns the nodes that publish it, this one too, with their namespaces; empty: the graph does not know
  /// the node (yet).
  std::vector<std::string> publishers_of(const std::string& full_topic) const;

  /// One end of a topic.
  struct End {
    std::string topic;
    std::string node;  ///< both with their namespaces
    bool publishes;    ///< or else it subscribes
    std::string type;
  };
  /// Returns the ends of all other nodes, but of several nodes with the same name only those of one. It asks
  /// by node, since each question by topic costs a look at all ends of the graph.
  std::vector<End> ends_of_others() const;

 private:
  Handle<rcl_node_t> node_;
  Handle<rcl_wait_set_t> graph_changes_;
  LogLineLimit failures_;
  Inbox inbox_;
};

}  // namespace coupler::rcl
