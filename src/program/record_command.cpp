#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/record/record_writer.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"
#include "program/interrupt.hpp"
#include "program/output_file.hpp"
#include "program/record_request.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace graze {

namespace {

/// Writes one processed record to a file. @return the exit code
int write_processed(const RecordArguments& arguments, const Console& console) {
    if (arguments.files.size() > 1)
        throw InputError("several records cannot be written to one file", "give one record");
    const InterruptGuard guard; // a file that is half written is taken away
    FileReplacement replacement(arguments.write);
    with_place({arguments.files.front(), 0, 0}, [&] {
        ProcessedRecord record(arguments.files.front(), record_processing(arguments, console));
        const std::vector<std::size_t> channels =
            record.header().chosen_channels(split_list(arguments.request.channels), "--channel");
        replacement.written_by([&](const std::string& path) {
            write_record(record.source(), channels, path, [] { return InterruptGuard::requested(); });
        });
    });
    if (InterruptGuard::requested()) {
        console.err << fmt::format("graze: interrupted; '{}' is not written\n", arguments.write);
        return InterruptGuard::exit_code();
    }
    replacement.commit();
    console.out << arguments.write << '\n';
    return exit_success;
}

} // namespace

int record_command(const RecordArguments& arguments, const Console& console) {
    if (!arguments.plot.empty())
        picture_ending(arguments.plot, "--plot", {"svg", "png", "pdf", "eps"});
    if (!arguments.write.empty())
        return write_processed(arguments, console);
    const RecordProcessing processing = record_processing(arguments, console);
    const std::unique_ptr<RecordTable> table =
        record_table(record_table_request(arguments), arguments.files.size() > 1);
    for (const std::string& file : arguments.files)
        with_place({file, 0, 0}, [&] {
            ProcessedRecord record(file, processing);
            table->add(file, record);
        });
    if (!arguments.plot.empty()) {
        draw_figure(table->figure(), arguments.plot, arguments.data);
        console.out << arguments.plot << '\n';
        return exit_success;
    }
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    heading.add("what", arguments.what);
    if (arguments.files.size() == 1)
        heading.add("file", arguments.files.front());
    deliver(table->table(), arguments.output, heading, console);
    return exit_success;
}

} // namespace graze
