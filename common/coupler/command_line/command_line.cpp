// SPDX-License-Identifier: Apache-2.0
#include "coupler/command_line/command_line.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace coupler::command_line {
namespace {

int exit_status(int of_cli11) { return of_cli11 == 0 ? 0 : 2; }

/// With the version, if it does not know an argument.
CLI::Error told(const CLI::App& program, const CLI::ParseError& error) {
  std::string what = error.what();
  const std::string version = program.version();
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !version.empty())
    what += " (this is " + version + ", and a newer one may know it)";
  return {error.get_name(), what, error.get_exit_code()};
}

/// CLI11 would only say that a command is required.
void refuse_unknown_command(const CLI::App& program, int argc, const char* const* argv) {
  const std::string first = argc > 1 ? argv[1] : "-";
  const auto is_named = [&first](const CLI::App* command) { return command->get_name() == first; };
  if (first[0] != '-' && program.get_subcommands(is_named).empty())
    throw CLI::ParseError("'" + first + "' is not a command", CLI::ExitCodes::ExtrasError);
}

}  // namespace

Option Option::required() { return Option(option_->required()); }
Option Option::type_name(const std::string& name) { return Option(option_->type_name(name)); }
Option Option::show_default() { return Option(option_->capture_default_str()); }
Option Option::needs(Option other) { return Option(option_->needs(other.option_)); }
Option Option::excludes(Option other) { return Option(option_->excludes(other.option_)); }

Option Option::optional_value() { return Option(option_->expected(0, 1)); }
Option Option::one_value() {
  return Option(option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll));
}
Option Option::no_extra_values() { return Option(option_->allow_extra_args(false)); }
Option Option::delimiter(char sign) { return Option(option_->delimiter(sign)); }

Option Option::path() {
  return Option(option_->transform(
      [](const std::string& text) { return text.empty() ? text : std::filesystem::absolute(text).string(); },
      ""));
}
Option Option::in_range(int min, int max) { return Option(option_->check(CLI::Range(min, max))); }
Option Option::in_range(double min, double max) { return Option(option_->check(CLI::Range(min, max))); }
Option Option::one_of(std::vector<std::string> values) {
  return Option(option_->check(CLI::IsMember(std::move(values))));
}
Option Option::positive() { return Option(option_->check(CLI::PositiveNumber)); }

bool Option::given() const { return option_->count() > 0; }
void Option::refuse_missing() const { throw CLI::RequiredError(option_->get_name()); }

Option Command::add_option(const std::string& name, std::string& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, std::vector<std::string>& value,
                           const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, double& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, std::uint32_t& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, std::optional<std::uint16_t>& value,
                           const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Command::add_option(const std::string& name, std::optional<std::string>& value,
                           const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Command::add_flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_->add_flag(name, value, help));
}

void Command::footer(const std::string& text) { app_->footer(text); }
void Command::allow_extras() { app_->allow_extras(); }
void Command::callback(std::function<void()> run) { app_->callback(std::move(run)); }

Program::Program(const std::string& description, const std::string& name)
    : Command(new CLI::App(description, name)), owned_(app_) {}
Program::~Program() = default;

void Program::version(const std::string& text) { app_->set_version_flag("--version", text); }

Command Program::add_command(const std::string& name, const std::string& description) {
  app_->require_subcommand(1);
  return Command(app_->add_subcommand(name, description));
}

void Program::explain(
    const std::function<std::string(const std::string& command, const std::string& what)>& how) {
  app_->failure_message([how](const CLI::App* program, const CLI::Error& error) {
    std::string command = program->get_name();
    for (const auto* subcommand : program->get_subcommands()) command += ' ' + subcommand->get_name();
    return how(command, error.what());
  });
}

std::optional<int> Program::parse(int argc, const char* const* argv) {
  try {
    if (app_->get_require_subcommand_min() > 0) refuse_unknown_command(*app_, argc, argv);
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& stopped) {
    return exit_status(app_->exit(told(*app_, stopped)));
  }
  return std::nullopt;
}

std::optional<int> Program::parse(std::vector<std::string> arguments, std::string& text) {
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  try {
    app_->parse(std::move(arguments));
  } catch (const CLI::ParseError& stopped) {
    std::ostringstream out;
    std::ostringstream err;
    const int status = exit_status(app_->exit(told(*app_, stopped), out, err));
    text += out.str() + err.str();
    return status;
  }
  return std::nullopt;
}

}  // namespace coupler::command_line
