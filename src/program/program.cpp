#include "program/program.hpp"

#include "graze/base/input_errors.hpp"
#include "graze/base/printable.hpp"
#include "program/command_line.hpp"
#include "program/commands.hpp"
#include "program/kept_inputs.hpp"
#include "program/option_rules.hpp"
#include "program/option_words.hpp"
#include "program/printable_buffer.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>

namespace graze {

namespace {

int dispatch(std::span<const std::string> words, const Console& console) {
    CommandLine line;
    CLI::App& app = line.app;
    std::vector<std::string> reversed = with_joined_words({words.begin(), words.end()});
    std::reverse(reversed.begin(), reversed.end()); // CLI11 expects the last argument first
    try {
        app.parse(reversed);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            app.exit(error, console.out, console.err);
            return exit_success;
        }
        throw InputError(explain(error, app), "");
    }
    refuse_useless_options(app);
    const KeptInputs kept;
    for (const CLI::App* command : app.get_subcommands())
        keep_inputs_of(*command);
    return line.commands.at(app.get_subcommands().front()->get_name())(console);
}

/// Prints one line for each error, at most as many as fit a terminal.
void tell_mistakes(const InputErrors& errors, const Console& console, std::span<const std::string> arguments) {
    constexpr std::size_t most = 20;
    const std::size_t count = errors.all().size();
    for (std::size_t i = 0; i < std::min(count, most); ++i)
        console.err << "graze: " << in_options(errors.all()[i].what(), arguments) << '\n';
    if (count > most)
        console.err << "graze: and " << (count < Mistakes::most ? "" : "at least ") << count - most
                    << " more; mend these first\n";
}

int tell_internal(const std::string& problem, const Console& console) {
    console.err << "graze: internal error: " << problem << "; please report it with the command and the model\n";
    return exit_internal_error;
}

int tell_error(const Error& error, const Console& console, std::span<const std::string> arguments) {
    if (error.kind() == ErrorKind::order || error.kind() == ErrorKind::internal)
        return tell_internal(error.problem(), console);
    console.err << "graze: " << in_options(error.what(), arguments) << '\n';
    return exit_bad_input;
}

} // namespace

int run_program(std::span<const std::string> arguments, const Console& given) {
    PrintableBuffer out_buffer(given.out), err_buffer(given.err);
    std::ostream out(&out_buffer), err(&err_buffer);
    const Console console{out, err, given.terminal, &given.err, given.width};
    try {
        const int code = dispatch(arguments, console);
        require_delivered(console);
        return code;
    } catch (const InputErrors& errors) {
        tell_mistakes(errors, console, arguments);
        return exit_bad_input;
    } catch (const Error& error) {
        return tell_error(error, console, arguments);
    } catch (const std::filesystem::filesystem_error& error) {
        console.err << "graze: " << shortened(error.path1().string(), 200) << ": " << error.code().message()
                    << "; give another path\n";
        return exit_bad_input;
    } catch (const std::bad_alloc&) {
        console.err << "graze: what is asked for takes more memory than there is; ask for less\n";
        return exit_bad_input;
    } catch (const std::exception& error) {
        return tell_internal(error.what(), console);
    }
}

} // namespace graze
