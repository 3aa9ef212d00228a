// SPDX-License-Identifier: Apache-2.0
#include "coupler/command_line/command_line.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>
#include <utility>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace coupler::command_line {
namespace {

int exit_status(int of_cli11) { return of_cli11 == 0 ? 0 : 2; }

std::string or_newer(const std::string& version) {
  return version.empty() ? std::string() : " (this is " + version + ", and a newer one may know it)";
}

/// The program, or its command, that has arguments left which it does not know.
const CLI::App* with_extras(const CLI::App& app) {
  if (!app.remaining().empty()) return &app;
  for (const CLI::App* command : app.get_subcommands())
    if (const CLI::App* found = with_extras(*command)) return found;
  return nullptr;
}

/// "--unit" as help texts name such a value: "UNIT".
std::string placeholder(std::string_view option) {
  std::string word(option.substr(2));
  for (char& c : word)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return word;
}

bool has_word(const std::string& text, const std::string& word) {
  const auto is_letter = [&text](std::size_t at) {
    return at < text.size() && std::isalpha(static_cast<unsigned char>(text[at])) != 0;
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + word.size())) return true;
  return false;
}

/// The option of `app` that was meant by "--word" or "--word=value"; empty if none is near.
std::string meant_option(const CLI::App& app, const std::string& given, Nearest nearest) {
  const std::string_view word = std::string_view(given).substr(0, given.find('='));
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  const std::string_view near =
      nearest(word.substr(2), std::vector<std::string_view>(names.begin(), names.end()));
  if (!near.empty()) return "--" + std::string(near);
  const std::string part = placeholder(word);
  if (part.empty()) return {};
  for (const CLI::Option* option : app.get_options())
    if (!option->get_lnames().empty() && has_word(option->get_description(), part))
      return "--" + option->get_lnames()[0] + ", which has the " + part;
  return {};
}

/// Returns what was given by the options of strays: of a shell's *.yaml they have got only the first. The
/// signs around a list as "[a, 'b']", which can be written in place of "a,b", are left out.
std::vector<std::string> given_values(const CLI::App& app, const OptionsOfStrays& of_strays) {
  std::vector<std::string> values;
  for (const std::string& name : {of_strays.one, of_strays.several}) {
    const CLI::Option* option = name.empty() ? nullptr : app.get_option_no_throw(name);
    if (option == nullptr) continue;
    for (std::string value : option->results()) {
      if (!value.empty() && value[0] == '[')
        for (const char sign : {'[', ']', '\'', '"', ' '})
          value.erase(std::remove(value.begin(), value.end(), sign), value.end());
      if (!value.empty()) values.push_back(value);
    }
  }
  return values;
}

/// Returns the proposal for the first of the arguments that is near to something; empty if none is.
std::string proposal(const CLI::App& app, const std::vector<std::string>& extras, Nearest nearest,
                     const OptionsOfStrays& of_strays) {
  for (const std::string& extra : extras) {
    if (extra.size() < 3 || extra.compare(0, 2, "--") != 0) continue;
    if (const std::string meant = meant_option(app, extra, nearest); !meant.empty()) return meant;
  }
  const bool are_strays = std::all_of(extras.begin(), extras.end(), [](const std::string& extra) {
    return !extra.empty() && extra[0] != '-';
  });
  if (!are_strays) return {};
  std::vector<std::string> values = given_values(app, of_strays);
  values.insert(values.end(), extras.begin(), extras.end());
  const std::string& option = values.size() == 1 ? of_strays.one : of_strays.several;
  if (option.empty()) return {};
  std::string list;
  for (const std::string& value : values) list += (list.empty() ? "" : ",") + value;
  return option + ' ' + list;
}

/// Returns the error; if it is about an unknown argument, with what was meant, or else with the version.
CLI::Error told(const CLI::App& program, const CLI::ParseError& error, Nearest nearest,
                const OptionsOfStrays& of_strays) {
  std::string what = error.what();
  const CLI::App* app = with_extras(program);
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && app != nullptr) {
    const std::vector<std::string> extras = app->remaining();
    what = extras.size() > 1 ? "The following arguments were not expected:"
                             : "The following argument was not expected:";
    for (const std::string& extra : extras) what += ' ' + extra;  // CLI11 has them from the last to the first
    const std::string meant = nearest == nullptr ? std::string() : proposal(*app, extras, nearest, of_strays);
    what += meant.empty() ? or_newer(program.version()) : "; did you mean " + meant + '?';
  }
  return {error.get_name(), what, error.get_exit_code()};
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

/// CLI11 would only say that a command is required.
void Program::refuse_unknown_command(int argc, const char* const* argv) const {
  const std::string first = argc > 1 ? argv[1] : "-";
  if (first.empty() || first[0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : std::as_const(*app_).get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), first) != names.end()) return;
  std::string what = "'" + first + "' is not a command";
  const std::string_view near =
      nearest_ == nullptr ? std::string_view()
                          : nearest_(first, std::vector<std::string_view>(names.begin(), names.end()));
  what += near.empty() ? or_newer(app_->version()) : "; did you mean '" + std::string(near) + "'?";
  throw CLI::ParseError(what, CLI::ExitCodes::ExtrasError);
}

std::optional<int> Program::parse(int argc, const char* const* argv) {
  try {
    if (app_->get_require_subcommand_min() > 0) refuse_unknown_command(argc, argv);
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& stopped) {
    return exit_status(app_->exit(told(*app_, stopped, nearest_, options_of_strays_)));
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
    const int status = exit_status(app_->exit(told(*app_, stopped, nearest_, options_of_strays_), out, err));
    text += out.str() + err.str();
    return status;
  }
  return std::nullopt;
}

}  // namespace coupler::command_line
