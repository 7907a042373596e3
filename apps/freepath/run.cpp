#include "apps/freepath/run.h"

#include <algorithm>
#include <exception>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/report_folder.h"
#include "freepath/base/error.h"
#include "freepath/base/nearest_name.h"
#include "freepath/base/thread_limit.h"
#include "freepath/base/version.h"

namespace freepath::program {
namespace {

/// "; did you mean 'name'?" where there is one that is near.
std::string suggestion(const std::string& typed, const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string_view nearest = nearest_name(typed, views);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

/// Message about words of the command line that nothing takes, in their order.
std::string unexpected_message(const CLI::App& command, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (!word.starts_with('-') || looks_numeric(word)) continue;
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    const std::string typed = word.substr(0, word.find('='));
    return fmt::format("there is no option '{}'{}", typed, suggestion(typed, names));
  }
  return fmt::format("'{}' is not expected", words.front());
}

/// What is wrong with the command line, in the form of all errors.
std::string usage_message(const CLI::App* program, const CLI::Error& error) {
  const auto chosen = program->get_subcommands();
  const std::string command = chosen.empty() ? "" : " " + chosen.front()->get_name();
  std::string what = error.what();
  if (chosen.empty() && !program->remaining().empty()) {
    const std::string typed = program->remaining().front();
    std::vector<std::string> names;
    for (const CLI::App* known : program->get_subcommands({})) names.push_back(known->get_name());
    what = fmt::format("there is no command '{}'{}", typed, suggestion(typed, names));
  } else if (!chosen.empty() && !chosen.front()->remaining().empty() &&
             error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    what = unexpected_message(*chosen.front(), chosen.front()->remaining());
  }
  std::replace(what.begin(), what.end(), '\n', ' ');
  return fmt::format("{}; freepath{} --help explains", what, command);
}

/// Lets no option have an empty value: it would pass for an option that is not given.
void refuse_empty_values(CLI::App& program) {
  const CLI::Validator not_empty(
      [](const std::string& text) { return std::string(text.empty() ? "the value is empty" : ""); },
      "");
  for (CLI::App* const command : program.get_subcommands({})) {
    for (CLI::Option* const option : command->get_options()) {
      if (option->get_expected_min() > 0) option->check(not_empty);
    }
  }
}

/// Says what CLI11 has to say: help, the version, or what is wrong with the command line.
/// @return the exit status
int end_parsing(const CLI::App& program, const CLI::ParseError& error) {
  std::ostringstream output, message;
  const int status = program.exit(error, output, message);
  print_lines(output.str());
  if (!message.str().empty()) tell("freepath: error: {}\n", message.str());
  return status;
}

int run_command(int argc, const char* const* argv, const std::function<double()>& clock) {
  set_command_line(argc, argv);
  CLI::App program{"Unbiased free paths and transmittance in heterogeneous participating media"};
  program.set_version_flag("--version", version());
  program.require_subcommand(1);
  program.failure_message(usage_message);
  program.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  program.footer("freepath COMMAND --help explains a command, with examples.");
  add_render_command(program, clock);
  add_merge_command(program);
  add_info_command(program);
  add_generate_command(program);
  add_convert_command(program);
  add_flux_command(program);
  add_slab_command(program);
  add_diff_command(program);
  add_compare_command(program);
  add_plan_command(program);
  add_lab_command(program);
  add_trackers_command(program);
  refuse_empty_values(program);
  try {
    const ThreadLimit limit;
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_parsing(program, error);
  } catch (const Error& error) {
    tell("freepath: error: {}\n", error.what());
    return 1;
  } catch (const std::exception& error) {
    return tell_unexpected(error);
  }
  return 0;
}

}  // namespace

int run(int argc, const char* const* argv, const std::function<double()>& clock) {
  prepare_console();
  return finish_console(run_command(argc, argv, clock));
}

}  // namespace freepath::program
