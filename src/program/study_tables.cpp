#include "program/study_tables.hpp"

#include "graze/base/input_error.hpp"
#include "graze/study/study_table.hpp"
#include "program/output_file.hpp"
#include "program/table.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace graze {

namespace {

bool holds(const std::string& path, const std::string& text) {
    std::ifstream stream(path, std::ios::binary);
    return stream && std::string(std::istreambuf_iterator<char>(stream), {}) == text;
}

} // namespace

WrittenTables write_study_tables(const Study& study, const ResultFile& file, const std::string& folder,
                                 const Console& console) {
    WrittenTables written;
    for (const StudyTable& table : study.tables) {
        try {
            const std::string path = (std::filesystem::path(folder) / (table.name + ".csv")).string();
            require_inside(path, folder);
            if (const std::string text = csv_text(make_table(table, file)); !holds(path, text))
                write_file(path, text);
            written.paths.push_back(path);
        } catch (const InputError& error) {
            console.err << fmt::format("graze: warning: table '{}' was not written: {}\n", table.name, error.what());
            written.complete = false;
        }
    }
    return written;
}

} // namespace graze
