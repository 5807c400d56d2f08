#include "program/command_line.hpp"

#include "graze/picture/record_table.hpp"
#include "program/commands.hpp"

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

void declare_processing(CommandOptions& options, RecordArguments& record) {
    options.in("Filter and derivative");
    options.add("--pass F", record.processing.pass, "Take away what is faster than this frequency", positive_number());
    options.add("--stop F", record.processing.stop, "And all that is faster than this one (1.5 F)", positive_number())
        ->needs("--pass");
    options.add("--every N", record.processing.every, "Keep one of so many samples, without what is too fast for them",
                whole_number(1, RecordProcessing::most_every));
    options.add("--derivative NAME", record.processing.derivative,
                "Two channels more: the derivative of this one, and its error");
    options
        .add("--half-width N", record.processing.half_width,
             "Samples on each side that tell the derivative (those for which its error is least)",
             whole_number(RecordProcessing::least_half_width, RecordProcessing::most_half_width))
        ->needs("--derivative");
}

void declare_record_tables(CommandOptions& options, RecordArguments& record) {
    options.in("What to show");
    options.add("--what TABLE", record.what,
                "channels (default), samples, periods, sections, extremes, spectrum or impacts",
                one_of(record_table_names()));
    options.add("--channel NAME", record.request.channels, "Only these channels (all)");
    options.add("--reference NAME", record.request.reference, "Channel whose rising crossings begin periods");
    options.add("--level VALUE", record.request.level, "That it crosses (0)");
    options.add("--hysteresis VALUE", record.request.hysteresis,
                "How far it has to be below and then above (a tenth of its range)", positive_number());
    options.add("--phase PARTS", record.phases, "Sections at these parts of a period (0)");
    options.add("--negate NAME", record.request.negated,
                "Sections: half a period later too, as images with the signs of these channels changed");
    options.add("--displacement NAME", record.request.displacement,
                "Impacts: a channel whose corners tell their times");
    options.add("--window N", record.request.impacts.window, "Impacts: samples on each side that tell velocities (12)",
                whole_number(ImpactWindow::least_window, ImpactWindow::most_window));
    options.add("--transition N", record.request.impacts.transition,
                "Impacts: samples on each side that the impact itself disturbs (0)",
                whole_number(0, ImpactWindow::most_window));
    options.add("--least-jump VALUE", record.request.impacts.least_jump, "Impacts: smaller jumps are none (0)",
                non_negative_number());
    options.add("--part N", record.request.part,
                "Spectrum: averaged over parts of so many samples (the whole record as one)",
                whole_number(8, 4'000'000));
}

} // namespace

void declare_reading(CommandOptions& options, RecordArguments& record) {
    options.in("What is read");
    options.add("--columns NAMES", record.processing.layout.columns,
                "Names and units of the columns of texts without a first line that says it: 't [s], V [V]'");
    options.add("--skip N", record.processing.layout.skip, "Pass over the first N lines of a text (0)",
                whole_number(0, 1'000'000'000));
    options.add("--names-line N", record.processing.layout.names_line,
                "Line with the names of the columns of a text, from 1 on (found)", whole_number(1, 1'000'000'000));
    options.add("--units-line N", record.processing.layout.units_line, "Line with their units (found)",
                whole_number(1, 1'000'000'000));
    options.add("--group NAME", record.processing.layout.group, "Of HDF5: the group whose datasets are the channels");
    options.add("--scale NAME=FACTOR[+OFFSET][:UNIT]", record.scales,
                "What readings of a channel mean, such as q=2.011:mm");
    options.add("--from T", record.processing.begin, "Rows from this time on");
    options.add("--to T", record.processing.end, "Rows up to this time");
}

void declare_record_command(CommandLine& line) {
    auto [options, record] = line.command("record", record_text, record_examples, record_command);
    options.add("FILE", record.files, "Records; of several each row tells which");
    declare_reading(options, record);
    declare_processing(options, record);
    declare_record_tables(options, record);
    options.table(record.output);
    options.add("--write FILE", record.write,
                "Write the processed record there instead: HDF5 where the name ends in .h5, otherwise text");
    options.picture(record.plot, record.data, "Draw the table instead, as svg, png or pdf");
}

} // namespace graze
