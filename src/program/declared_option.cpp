#include "program/declared_option.hpp"

#include <map>

namespace graze {

CLI::Option* declare_format(CLI::App& command, OutputArguments& output) {
    static const std::map<std::string, TableFormat> formats{
        {"table", TableFormat::table}, {"csv", TableFormat::csv}, {"json", TableFormat::json}};
    // CLI11's own conversion to an enumeration would accept any number.
    const auto read = [&output](const std::string& word) { output.format = formats.at(word); };
    return command.add_option_function<std::string>("--format", read, "table (default), csv or json")
        ->type_name("FORMAT")
        ->check(one_of({"table", "csv", "json"}))
        ->group("Output");
}

void declare_digits(CLI::App& command, OutputArguments& output) {
    declare_format(command, output);
    declare_option(command, "Output", "--digits", output.digits, "N",
                   "Significant digits of numbers (8 in tables; 17, which is exact, in csv and json)")
        ->check(whole_number(1, 17));
}

void declare_output(CLI::App& command, OutputArguments& output) {
    declare_digits(command, output);
    declare_option(command, "Output", "--output", output.file, "FILE",
                   "Write the table to FILE instead of to standard output");
}

void declare_table(CLI::App& command, OutputArguments& output) {
    declare_output(command, output);
    command.add_flag("--all", output.all, "Show all columns of a table, even if they do not fit the terminal")
        ->group("Output");
}

void declare_data(CLI::App& command, std::string& data) {
    declare_option(command, "Picture", "--data", data, "FILE",
                   "Keep the data and commands of the picture; `gnuplot FILE` draws it again after changes");
}

} // namespace graze
