// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/logger_service.hpp"

#include <ros/console.h>
#include <ros/names.h>
#include <ros/service_manager.h>
#include <roscpp/GetLoggers.h>

#include <array>
#include <string>
#include <utility>

namespace coupler::host {
namespace {

namespace levels = ros::console::levels;

/// One logger, asked level by level: that needs no list.
class OneLogger {
 public:
  explicit OneLogger(std::string name) : name_(std::move(name)) {
    for (int i = 0; i < levels::Count; ++i)
      ros::console::initializeLogLocation(&locations_[static_cast<std::size_t>(i)], name_,
                                          static_cast<ros::console::Level>(i));
  }

  roscpp::Logger describe() {
    constexpr std::array<const char*, levels::Count> names{"debug", "info", "warn", "error", "fatal"};
    roscpp::Logger logger;
    logger.name = name_;
    for (std::size_t i = names.size(); i-- > 0;) {
      ros::console::checkLogLocationEnabled(&locations_[i]);
      if (locations_[i].logger_enabled_) logger.level = names[i];
    }
    return logger;
  }

 private:
  std::string name_;
  std::array<ros::console::LogLocation, levels::Count> locations_{};  // rosconsole keeps pointers to them
};

bool answer(roscpp::GetLoggers::Request& /*request*/, roscpp::GetLoggers::Response& response) {
  static OneLogger& all = *new OneLogger(ROSCONSOLE_ROOT_LOGGER_NAME);
  static OneLogger& own = *new OneLogger(ROSCONSOLE_DEFAULT_NAME);
  response.loggers = {all.describe(), own.describe()};
  return true;
}

}  // namespace

ros::ServiceServer advertise_loggers(ros::CallbackQueueInterface& queue) {
  ros::ServiceManager::instance()->unadvertiseService(ros::names::resolve("~get_loggers"));
  auto options =
      ros::AdvertiseServiceOptions::create<roscpp::GetLoggers>("get_loggers", answer, ros::VoidPtr(), &queue);
  return ros::NodeHandle("~").advertiseService(options);
}

}  // namespace coupler::host
