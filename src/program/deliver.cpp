#include "graze/symbolic/input_error.hpp"
#include "program/commands.hpp"
#include "program/output_file.hpp"

#include <sstream>

namespace graze {

void deliver(const Table& table, const OutputArguments& output, const JsonObject& heading, const Console& console) {
    if (output.file.empty()) {
        write_table(console.out, table, output.format, output.digits, heading);
        return require_delivered(console);
    }
    std::ostringstream text;
    write_table(text, table, output.format, output.digits, heading);
    write_file(output.file, text.view());
}

void require_delivered(const Console& console) {
    console.out.flush();
    if (!console.out)
        throw InputError("standard output does not take what is written to it", "look whether the device is full");
}

} // namespace graze
