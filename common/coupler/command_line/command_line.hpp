// SPDX-License-Identifier: Apache-2.0
// The command line of a program, by CLI11. What we use of CLI11 is behind these classes because each file
// that includes its headers takes about 10 s to compile; so one does.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace coupler::command_line {

/// An option, a flag or a positional argument. A copy is the same option.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required();
  Option type_name(const std::string& name);
  Option show_default();
  Option needs(Option other);
  Option excludes(Option other);

  // How many values there are.
  Option optional_value();      ///< none or one; of a number none is 0
  Option one_value();           ///< each time; of a list each gives one more
  Option no_extra_values();     ///< the same, but the help text says "..." of a list
  Option delimiter(char sign);  ///< between the values of a list

  // The values that an option may have.
  Option in_range(int min, int max);
  Option in_range(double min, double max);
  Option one_of(std::vector<std::string> values);
  Option positive();
  /// A path, which becomes absolute: its value holds wherever it is used.
  Option path();

  /// Once the command line is parsed.
  bool given() const;

  /// Within a callback: refuses the call, as required() would.
  [[noreturn]] void refuse_missing() const;

 private:
  CLI::Option* option_;
};

/// Has options. A copy is the same command.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  /// `name`: "--long", "--long,--alias", or "ARGUMENT". `value` holds the default and gets what is given.
  Option add_option(const std::string& name, std::string& value, const std::string& help);
  Option add_option(const std::string& name, std::vector<std::string>& value, const std::string& help);
  Option add_option(const std::string& name, double& value, const std::string& help);
  Option add_option(const std::string& name, std::uint32_t& value, const std::string& help);
  Option add_option(const std::string& name, std::optional<std::uint16_t>& value, const std::string& help);
  Option add_option(const std::string& name, std::optional<std::string>& value, const std::string& help);
  Option add_flag(const std::string& name, bool& value, const std::string& help);

  /// The last lines of the help text.
  void footer(const std::string& text);
  /// Takes whatever is given.
  void allow_extras();
  /// Run if the user calls this command.
  void callback(std::function<void()> run);

 protected:
  CLI::App* app_;
};

/// The candidate that was most likely meant by the word; empty if none is near.
using Nearest = std::string_view (*)(std::string_view word, const std::vector<std::string_view>& candidates);

/// The options that are proposed for one stray argument and for several; empty: none.
struct OptionsOfStrays {
  std::string one;
  std::string several;
};

/// footer() and explain() hold for every command that is added after them.
class Program : public Command {
 public:
  Program(const std::string& description, const std::string& name);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void version(const std::string& text);
  /// Proposes the word that a wrong option or command is near to; `nearest` finds it, or is empty.
  void propose(Nearest nearest) { nearest_ = nearest; }
  /// Proposes an option for a stray argument, "--map", and one that takes a list for several, "--maps". What
  /// these options were given counts as the first of several.
  void stray_is_of(const std::string& option, const std::string& of_several) {
    options_of_strays_ = {option, of_several};
  }
  /// The user has to call one of the commands that are added.
  Command add_command(const std::string& name, const std::string& description);
  /// The message after a wrong call; `command`: "coupler check".
  void explain(const std::function<std::string(const std::string& command, const std::string& what)>& how);

  /// The exit status if there is nothing more to do: 0 after --help and --version, 2 after a wrong call,
  /// which is explained on standard error.
  std::optional<int> parse(int argc, const char* const* argv);
  /// `arguments`: without the program. Help and messages are added to `text`.
  std::optional<int> parse(std::vector<std::string> arguments, std::string& text);

 private:
  void refuse_unknown_command(int argc, const char* const* argv) const;

  std::unique_ptr<CLI::App> owned_;
  Nearest nearest_ = nullptr;
  OptionsOfStrays options_of_strays_;
};

}  // namespace coupler::command_line
