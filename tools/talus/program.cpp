#include "program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <string_view>

#include "help.hpp"
#include "talus/base/error.hpp"
#include "talus/base/memory.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"
#include "talus/io/gdal/input_access.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/run/startable_threads.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace {

std::atomic<bool> asked_to_end{false}, ends_at_once{true};
bool says_json = false;  // messages are lines of JSON
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

constexpr std::size_t kLongestLine = 4000;  // of a message [byte]

/// Handles a signal that ends the program.
void end(int) {
  asked_to_end = true;
  if (!ends_at_once) return;
  constexpr std::string_view kMessage = "talus: interrupted; nothing was written\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
  _exit(kInterrupted);
}

void handle_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    const auto before = std::signal(signal, end);
    if (before == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup
  }
}

/// Adds what every command that reads inputs knows.
void add_access(CLI::App& command) {
  command.add_flag_callback("--allow-network", talus::io::allow_network,
                            "inputs may be named by addresses (https://...); without it only local files are read");
  with(command
           .add_option_function<std::vector<std::string>>(
               "--allow-folder",
               [](const std::vector<std::string>& folders) {
                 for (const std::string& folder : folders) talus::io::allow_folder(folder);
               },
               "a VRT may name files below this folder, not only below its own and the scenario's; may be repeated")
           ->allow_extra_args(false)
           ->check([](const std::string& folder) {
             std::error_code none;
             return std::filesystem::is_directory(folder, none) ? "" : "there is no folder '" + folder + "'";
           }),
       folder_of_results());
}

/// {"KIND": "TEXT"} in one line; bytes that are no UTF-8 are replaced.
std::string json_line(const std::string& kind, const std::string& text) {
  const nlohmann::json line{{kind, talus::printable(text)}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<std::string> words;

/// The names of a command's options.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// The message about a wrong command line, with the way out; CLI11's own message if there is no better one.
std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands(nullptr)) commands.push_back(command->get_name());
  const auto called = app.get_subcommands();
  const CLI::App& command = called.empty() ? app : *called.front();
  const std::string see_help = "; see " + (called.empty() ? "talus" : "talus " + command.get_name()) + " --help";
  const std::string text = error.what();
  const auto is = [&error](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
  if (is(CLI::ExitCodes::ConversionError))
    return text.substr(text.find(": ") + 2) + ": is not a valid number" +
           (text.find(';') != std::string::npos ? " (the numbers of a list stand like this: 30,100,300)" : "") +
           see_help;
  const std::vector<std::string> left = called.empty() ? std::vector<std::string>() : command.remaining(true);
  const bool is_of_need = is(CLI::ExitCodes::RequiredError) || is(CLI::ExitCodes::RequiresError);
  const bool has_unknown = std::ranges::any_of(left, [](const std::string& word) { return word.starts_with("-"); });
  if (!is(CLI::ExitCodes::ExtrasError) && !called.empty() && !(is_of_need && has_unknown)) return text + see_help;
  const std::vector<std::string> given(words.begin() + 1, words.end());
  for (const std::string& word : called.empty() ? given : left) {
    if (word.starts_with("-"))
      return "unknown option '" + word + "'" + talus::known_names(word, option_names(command)) + see_help;
    if (called.empty()) return "unknown command '" + word + "'" + talus::known_names(word, commands) + see_help;
    return "'" + word + "' was not expected there" + see_help;
  }
  return text + see_help;
}

void describe(CLI::App& app) {
  app.name(words.front().ends_with("-mpi") ? "talus-mpi" : "talus");
  app.set_version_flag("--version", "talus " + std::string(talus::version()));
  app.require_subcommand(1);
  app.footer(
      "Example:\n"
      "  talus run --dem dem.tif --sources cliffs.gpkg --diameter 1.2 -o result\n\n"
      "talus COMMAND --help tells more of each command. Exit codes: 0 done, 2 the input is wrong,\n"
      "130 interrupted, 1 anything else.");
}

bool is_number(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.starts_with("INT") || type.starts_with("UINT") || type.starts_with("FLOAT");
}

/// Takes every number as decimal. CLI11 takes those that begin with 0 for octal: 010 would be 8, 0100 blocks 64.
std::string as_decimal(std::string& text) {
  const auto is = [&text](std::size_t at, int (*kind)(int)) {
    return at < text.size() && kind(static_cast<unsigned char>(text[at])) != 0;
  };
  while (is(0, std::isspace)) text.erase(0, 1);
  const std::size_t first = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  while (text.substr(first, 1) == "0" && is(first + 1, std::isdigit)) text.erase(first, 1);
  const bool other_base =
      text.substr(first, 1) == "0" && is(first + 1, std::isalpha) && text[first + 1] != 'e' && text[first + 1] != 'E';
  return other_base ? "Value " + text + " must be a decimal number" : "";
}

/// Cuts spaces around an item of a list ("theta_scale, En50").
std::string without_spaces(std::string& item) {
  item = CLI::detail::trim_copy(item);
  return {};
}

/// Puts given texts into the form that the options read, before their other checks.
void take_texts_as_meant(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands(nullptr))
    for (CLI::Option* option : command->get_options()) {
      if (is_number(*option)) option->transform(CLI::Validator(as_decimal, ""));
      if (option->get_delimiter() != '\0') option->transform(CLI::Validator(without_spaces, ""));
    }
}

/// The lists that are given for an option with a delimiter, in order.
std::vector<std::string> lists_of(const CLI::Option& option) {
  const std::string name = "--" + option.get_lnames().front();
  std::vector<std::string> lists;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == name && i + 1 < words.size())
      lists.push_back(words[++i]);
    else if (words[i].starts_with(name + "="))
      lists.push_back(words[i].substr(name.size() + 1));
  }
  return lists;
}

/// Throws InputError for a list with an empty item (30,,300), which CLI11 leaves out unnoticed, and for a second list
/// of an option, which it appends to the first.
void refuse_odd_lists(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_delimiter() == '\0') continue;
    const std::string comma(1, option->get_delimiter()), name = "--" + option->get_lnames().front();
    const std::string help = "; see talus " + command.get_name() + " --help";
    const std::vector<std::string> lists = lists_of(*option);
    for (const std::string& list : lists)
      if ((comma + list + comma).find(comma + comma) != std::string::npos)
        throw talus::InputError(name + ": '" + list + "' has an empty item" + help);
    if (lists.size() > 1)
      throw talus::InputError(name + " is given " + std::to_string(lists.size()) +
                              " times: give it once, its items with commas between them" + help);
  }
}

/// A value of no characters, as of a variable of a script that is not set, is none for the parser: the default would be
/// taken without a word.
void refuse_empty_values(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_items_expected_max() == 0 || std::ranges::count(option->results(), "") == 0) continue;
    throw talus::InputError(option->get_name() + ": has an empty value, must have one or be left out; see talus " +
                            command.get_name() + " --help");
  }
}

/// The action that prints the help of the program.
Action help_of(const CLI::App& app) {
  return [text = app.help()] {
    print_text(text);
    return 0;
  };
}

/// Opens the three standard streams where they are closed, so that no file of results gets the number of one and with
/// it what is printed. Each the wrong way round: using it remains an error.
void hold_standard_streams() {
  for (const int stream : {0, 1, 2})
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY) < 0) std::_Exit(kFailed);
}

}  // namespace

void begin_program(int argc, char** argv) {
  hold_standard_streams();
  talus::keep_freed_memory();
  std::signal(SIGPIPE, SIG_IGN);  // if the reader of the output ends, a write fails and is handled
  std::signal(SIGXFSZ, SIG_IGN);  // the same for a file above the allowed size
  words.assign(argv, argv + argc);
  handle_signals();
}

Action understood(int argc, char** argv, const std::vector<AddCommand>& commands) {
  CLI::App app("Talus maps rock-fall hazard on 3D terrain.");
  describe(app);
  Action action;
  for (const AddCommand& add : commands) add(app, action);
  for (CLI::App* command : app.get_subcommands(nullptr))
    if (command->get_name() != "presets") add_access(*command);
  take_texts_as_meant(app);
  add_help(app, action);
  if (argc < 2) return help_of(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {  // --help, --version
      const int code = app.exit(error);
      return [code] { return code; };
    }
    throw talus::InputError(explain(app, error));
  }
  refuse_odd_lists(*app.get_subcommands().front());
  refuse_empty_values(*app.get_subcommands().front());
  return action;
}

int exit_code_of(const std::function<int()>& program) {
  try {
    const int code = program();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw std::runtime_error("the output cannot be written");
    return code;
  } catch (const talus::InputError& error) {
    say("error", error.what());
    return kWrongInput;
  } catch (const Interrupted& error) {
    say("", error.what());
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    say("error", "not enough memory");
  } catch (const std::exception& error) {
    say("error", error.what());
  }
  return kFailed;
}

CLI::Validator between(double low, double high) {
  const std::string range = "[" + talus::text_of(low) + " - " + talus::text_of(high) + "]";
  return {[low, high, range](std::string& text) -> std::string {
            double value = 0.0;
            const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
            return good ? "" : "Value " + text + " not in range " + range;
          },
          "FLOAT in " + range};
}

CLI::Validator seed_number() {
  const auto check = [](std::string& text) -> std::string {
    const talus::Bounds* bounds = nullptr;
    for (const auto& field : talus::scenario_fields())
      if (field.key == "seed") bounds = &field;
    double value = 0.0;
    if (!CLI::detail::lexical_cast(text, value)) return {};  // the conversion says it
    const auto fault = talus::fault_of(*bounds, value);
    return fault ? "Value " + text + " " + *fault : "";
  };
  return {check, ""};
}

CLI::Validator startable_threads() {
  constexpr int kMost = 4096;
  const auto check = [](std::string& text) -> std::string {
    int threads = 0;
    if (!CLI::detail::lexical_cast(text, threads) || threads < 1 || threads > kMost)
      return "Value " + text + " not in range [1 - " + std::to_string(kMost) + "]";
    const int most = talus::run::startable_threads(threads);
    return most == threads ? ""
                           : "Value " + text + ": this system lets the program start " + std::to_string(most) +
                                 " threads (ulimit -v limits their memory, ulimit -u their number); give half of that "
                                 "or less";
  };
  return {check, "INT in [1 - 4096]"};
}

CLI::Validator lanes_of_machine() {
  const auto check = [](std::string& text) -> std::string {
    const auto choice = std::ranges::find(talus::kLaneChoices, text, [](int lanes) { return std::to_string(lanes); });
    if (choice == std::end(talus::kLaneChoices)) return "Value " + text + ": must be 1, 4 or 8";
    const int most = talus::most_lanes();
    return *choice <= most
               ? ""
               : "Value " + text + ": this processor has " + std::to_string(most) + (most == 1 ? " lane" : " lanes") +
                     " (8 need AVX-512, 4 need AVX2); give less, or leave it out: the results are the same";
  };
  return {check, "INT: 1, 4 or 8"};
}

void catch_signals() {
  ends_at_once = false;
}

const std::vector<std::string>& command_line() {
  return words;
}

bool interrupted() {
  return asked_to_end;
}

void add_progress(CLI::App& command, std::string& progress) {
  command
      .add_option_function<std::string>(
          "--progress",
          [&progress](const std::string& form) {
            progress = form;
            says_json = form == "json";
          },
          "machine: lines `progress 42` for other programs; json: lines {\"phase\": \"simulate\", \"share\": 0.42}, "
          "and {\"warning\": ...}, {\"error\": ...} or {\"message\": ...} in the place of each message")
      ->check(CLI::IsMember({"machine", "json"}));
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "all processors where it is not given; the results are the same")
      ->check(startable_threads());
}

void add_quiet(CLI::App& command, bool& quiet) {
  command.add_flag("-q,--quiet", quiet, "say nothing but errors");
}

void add_surface(CLI::App& command, std::optional<std::string>& surface) {
  with(command.add_option("--surface", surface, "bilinear or creased (creased): heights between the cells' centres"),
       surface_choice());
}

void add_effects(CLI::App& command, std::vector<std::string>& effects) {
  command
      .add_option(
          "--effect", effects,
          "NAME.KEY=VALUE: a number of an effect, as block-mass.preset=measured (docs/effects.md); several with "
          "; between them; may be repeated")
      ->allow_extra_args(false);
}

void say(const std::string& kind, const std::string& text) {
  if (says_json) {
    const std::string line = json_line(kind.empty() ? "message" : kind, talus::shortened(text, kLongestLine));
    std::fprintf(stderr, "%s\n", line.c_str());
    std::fflush(stderr);
    return;
  }
  std::string line =
      talus::printable("talus: " + (kind.empty() ? "" : kind + ": ") + talus::shortened(text, kLongestLine));
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  std::fprintf(stderr, "%s\n", line.c_str());
}

void print_text(const std::string& text) {
  std::fputs(talus::printable(text).c_str(), stdout);
}

void print(const char* format, ...) {
  std::va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  std::string text(static_cast<std::size_t>(std::max(0, std::vsnprintf(nullptr, 0, format, values))), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(values);
  print_text(text);
}
