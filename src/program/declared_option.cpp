#include "program/declared_option.hpp"

#include <map>

namespace graze {

CLI::Option* declare_format(CLI::App& command, OutputArguments& output) {
    static const std::map<std::string, TableFormat> formats{
        {"table", TableFormat::table}, {"csv", TableFormat::csv}, {"json", TableFormat::json}};
    // Read by hand: a conversion to an enumeration takes any number.
    const auto read = [&output](const std::string& word) { output.format = formats.at(word); };
    return command.add_option_function<std::string>("--format", read, "table (default), csv or json")
        ->type_name("FORMAT")
        ->check(one_of({"table", "csv", "json"}))
        ->group("Output");
}

void declare_digits(CLI::App& command, OutputArguments& output) {
    declare_format(command, output);
    declare_option(command, "Output", "--digits", output.digits, "N",
                   "Significant digits of numbers (8; 17 of csv and json, which lose nothing)")
        ->check(whole_number(1, 17));
}

void declare_output(CLI::App& command, OutputArguments& output) {
    declare_digits(command, output);
    declare_option(command, "Output", "--output", output.file, "FILE",
                   "Write the table there instead of to standard output");
}

void declare_table(CLI::App& command, OutputArguments& output) {
    declare_output(command, output);
    command.add_flag("--all", output.all, "All columns of a table, also those that do not fit a terminal")
        ->group("Output");
}

void declare_data(CLI::App& command, std::string& data) {
    declare_option(command, "Picture", "--data", data, "FILE",
                   "Keep data and commands, to be changed and drawn by `gnuplot FILE`");
}

} // namespace graze
