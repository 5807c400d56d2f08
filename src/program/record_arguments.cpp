#include "program/record_arguments.hpp"

#include "graze/picture/record_table.hpp"
#include "program/commands.hpp"
#include "program/declared_option.hpp"

#include <string>
#include <vector>

namespace graze {

namespace {

constexpr const char* record_text = R"(Look at measured records: sections, extremes, spectra, impacts.
A record is a table of channels against time: text with names and units in its first line (t [s], V [V], q [mm]), HDF5
with a dataset for each channel, or five plain columns time, V, I, q, dq/dt. Records of any length are read part by part.
What is processed comes in this order: units, the part that is wanted, filter, derivative, and then the table: channels
says what is there; samples are all rows; periods, sections and extremes need a reference, whose rising crossings begin
the periods.)";

constexpr const char* record_examples = R"(Examples:
  graze record run.csv                             channels, how often they were sampled, their ranges
  graze record run.csv --what sections --reference V --phase 0,0.5
  graze record *.dat --what sections --reference V --negate I --plot diagram.svg
  graze record run.csv --what impacts --channel v --displacement q --format csv
  graze record run.csv --what spectrum --channel I --part 4096
  graze record run.csv --every 10 --derivative q --write slow.h5)";

void declare_processing(CLI::App& command, RecordArguments& arguments) {
    const char* group = "Filter and derivative";
    declare_option(command, group, "--pass", arguments.pass, "F", "Take away what is faster than this frequency")
        ->check(positive_number());
    auto* stop =
        declare_option(command, group, "--stop", arguments.stop, "F", "And all that is faster than this one (1.5 F)")
            ->check(positive_number());
    stop->needs("--pass");
    declare_option(command, group, "--every", arguments.every, "N",
                   "Keep one of so many samples, without what is too fast for them")
        ->check(whole_number(1, RecordProcessing::most_every));
    declare_option(command, group, "--derivative", arguments.derivative, "NAME",
                   "Two channels more: the derivative of this one, and its error");
    declare_option(command, group, "--half-width", arguments.half_width, "N",
                   "Samples on each side that tell the derivative (those for which its error is least)")
        ->check(whole_number(RecordProcessing::least_half_width, RecordProcessing::most_half_width))
        ->needs("--derivative");
}

void declare_record_tables(CLI::App& command, RecordArguments& arguments) {
    const char* group = "What to show";
    declare_option(command, group, "--what", arguments.what, "TABLE",
                   "channels (default), samples, periods, sections, extremes, spectrum or impacts")
        ->check(one_of(record_table_names()));
    declare_option(command, group, "--channel", arguments.channels, "NAME", "Only these channels (all)");
    declare_option(command, group, "--reference", arguments.reference, "NAME",
                   "Channel whose rising crossings begin periods");
    declare_option(command, group, "--level", arguments.level, "VALUE", "That it crosses (0)");
    declare_option(command, group, "--hysteresis", arguments.hysteresis, "VALUE",
                   "How far it has to be below and then above (a tenth of its range)")
        ->check(positive_number());
    declare_option(command, group, "--phase", arguments.phases, "PARTS", "Sections at these parts of a period (0)");
    declare_option(command, group, "--negate", arguments.negated, "NAME",
                   "Sections: half a period later too, as images with the signs of these channels changed");
    declare_option(command, group, "--displacement", arguments.displacement, "NAME",
                   "Impacts: a channel whose corners tell their times");
    declare_option(command, group, "--window", arguments.impacts.window, "N",
                   "Impacts: samples on each side that tell velocities (12)")
        ->check(whole_number(ImpactWindow::least_window, ImpactWindow::most_window));
    declare_option(command, group, "--transition", arguments.impacts.transition, "N",
                   "Impacts: samples on each side that the impact itself disturbs (0)")
        ->check(whole_number(0, ImpactWindow::most_window));
    declare_option(command, group, "--least-jump", arguments.impacts.least_jump, "VALUE",
                   "Impacts: smaller jumps are none (0)")
        ->check(non_negative_number());
    declare_option(command, group, "--part", arguments.part, "N",
                   "Spectrum: averaged over parts of so many samples (the whole record as one)")
        ->check(whole_number(8, 4'000'000));
}

void declare_record(CLI::App& app, RecordArguments& arguments) {
    CLI::App& command = *app.add_subcommand("record", record_text);
    command.footer(record_examples);
    command.add_option("FILE", arguments.files, "Records; of several each row tells which")->type_name("")->required();
    declare_reading(command, arguments);
    declare_processing(command, arguments);
    declare_record_tables(command, arguments);
    declare_table(command, arguments.output);
    declare_option(command, "Output", "--write", arguments.write, "FILE",
                   "Write the processed record there instead: HDF5 where the name ends in .h5, otherwise text");
    declare_option(command, "Picture", "--plot", arguments.plot, "FILE", "Draw the table instead, as svg, png or pdf");
    declare_data(command, arguments.data);
}

} // namespace

void declare_reading(CLI::App& command, RecordArguments& arguments) {
    const char* group = "What is read";
    declare_option(command, group, "--columns", arguments.columns, "NAMES",
                   "Names and units of the columns of texts without a first line that says it: 't [s], V [V]'");
    declare_option(command, group, "--skip", arguments.skip, "N", "Pass over the first N lines of a text (0)")
        ->check(whole_number(0, 1'000'000'000));
    declare_option(command, group, "--names-line", arguments.names_line, "N",
                   "Line with the names of the columns of a text, from 1 on (found)")
        ->check(whole_number(1, 1'000'000'000));
    declare_option(command, group, "--units-line", arguments.units_line, "N", "Line with their units (found)")
        ->check(whole_number(1, 1'000'000'000));
    declare_option(command, group, "--group", arguments.group, "NAME",
                   "Of HDF5: the group whose datasets are the channels");
    declare_option(command, group, "--scale", arguments.scales, "NAME=FACTOR[+OFFSET][:UNIT]",
                   "What readings of a channel mean, such as q=2.011:mm");
    declare_option(command, group, "--from", arguments.from, "T", "Rows from this time on");
    declare_option(command, group, "--to", arguments.to, "T", "Rows up to this time");
}

void declare_record_commands(CLI::App& app, Arguments& arguments) {
    declare_record(app, arguments.record);
    arguments.add_command("record", record_command, arguments.record);
}

} // namespace graze
