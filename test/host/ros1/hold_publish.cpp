// SPDX-License-Identifier: Apache-2.0
// For test/ros/latched_test.py, which loads it before roscpp (LD_PRELOAD): while the file $HOLD_PUBLISH
// exists, a thread that publishes `…/online` stays between the two steps of roscpp's publish(), where a busy
// machine may take the processor from it: the message is sent, and not yet kept for those who subscribe
// later.
#include <dlfcn.h>
#include <ros/topic_manager.h>
#include <unistd.h>

#include <cstdlib>

namespace {

constexpr auto name =
    "_ZN3ros12TopicManager7publishERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKN5boost"
    "8functionIFNS_17SerializedMessageEvEEERSB_";

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

void ros::TopicManager::publish(const std::string& topic,
                                const boost::function<ros::SerializedMessage()>& serialize,
                                ros::SerializedMessage& message) {
  using Publish = void (*)(ros::TopicManager*, const std::string&,
                           const boost::function<ros::SerializedMessage()>&, ros::SerializedMessage&);
  static const auto real = reinterpret_cast<Publish>(::dlsym(RTLD_NEXT, name));
  real(this, topic, serialize, message);
  const char* const hold = std::getenv("HOLD_PUBLISH");
  if (hold == nullptr || !ends_with(topic, "/online")) return;
  while (::access(hold, F_OK) == 0) ::usleep(10'000);
}
