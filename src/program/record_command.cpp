#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/record/record_writer.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"
#include "program/interrupt.hpp"
#include "program/output_file.hpp"
#include "program/record_tables.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace graze {

namespace {

/// @return the exit code
int write_record(const RecordArguments& arguments, const Console& console) {
    if (arguments.files.size() > 1)
        throw InputError("several records cannot be written to one file", "give one record");
    const InterruptGuard guard; // a file that is half written is taken away
    FileReplacement replacement(arguments.write);
    with_place({arguments.files.front(), 0, 0}, [&] {
        RecordStages stages(arguments.files.front(), arguments, console);
        const std::vector<std::size_t> channels = stages.channels(arguments.channels);
        RecordHeader header{stages.header().time, {}};
        for (const std::size_t c : channels)
            header.channels.push_back(stages.header().channels[c]);
        replacement.written_by([&](const std::string& path) {
            RecordWriter writer(path, header);
            Samples samples, chosen;
            while (!InterruptGuard::requested() && stages.source().read(samples)) {
                chosen.times = samples.times;
                chosen.values.clear();
                for (const std::size_t c : channels)
                    chosen.values.push_back(samples.values[c]);
                writer.write(chosen);
            }
            writer.close();
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
        return write_record(arguments, console);
    const std::unique_ptr<RecordTable> table = record_table(arguments);
    for (const std::string& file : arguments.files)
        with_place({file, 0, 0}, [&] {
            RecordStages stages(file, arguments, console);
            table->add(file, stages);
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
