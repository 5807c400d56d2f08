#include "graze/base/input_error.hpp"
#include "graze/base/name_list.hpp"
#include "program/commands.hpp"
#include "program/output_file.hpp"
#include "program/table_fit.hpp"

#include <fmt/format.h>

#include <sstream>

namespace graze {

void deliver(const Table& given, const OutputArguments& output, const JsonObject& heading, const Console& console,
             const std::vector<std::string>& kept) {
    const int digits = output.shown_digits();
    FittedTable chosen;
    const bool fits = output.format == TableFormat::table && !output.all;
    if (fits)
        chosen = fitted(given, digits, console.width, kept);
    const Table& table = fits ? chosen.table : given;
    if (output.file.empty()) {
        write_table(console.out, table, output.format, digits, heading, fits ? console.width : 0);
        require_delivered(console);
    } else {
        std::ostringstream text;
        write_table(text, table, output.format, digits, heading, fits ? console.width : 0);
        write_file(output.file, text.view());
    }
    if (const std::size_t count = chosen.left_out.size(); count > 0)
        console.err << fmt::format("graze: {} column{} left out for lack of room ({}); --all shows everything\n", count,
                                   count == 1 ? " is" : "s are", name_list(chosen.left_out));
    else if (chosen.shortened)
        console.err << "graze: long signatures are shortened; --all shows them whole\n";
}

JsonObject heading_of_point(const ResultFile& file, const StoredOrbit& stored) {
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    heading.add("file", file.path());
    heading.add("model", stored.run.model.name);
    heading.add("run", stored.run.record.name);
    heading.add("number", static_cast<double>(stored.record.number));
    heading.add("label", stored.record.label);
    return heading;
}

void require_delivered(const Console& console) {
    console.out.flush();
    if (!console.out)
        throw InputError("standard output does not take what is written to it", "look whether the device is full");
}

} // namespace graze
