#include "program/picture.hpp"

#include "base/letter_case.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/xml_text.hpp"
#include "program/process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

namespace graze {

std::string picture_ending(const std::string& path, const std::string& option, const std::vector<std::string>& known) {
    std::string ending = in_small_letters(std::filesystem::path(path).extension().string());
    ending.erase(0, 1);
    if (std::find(known.begin(), known.end(), ending) == known.end())
        throw InputError({option, 0, 0},
                         fmt::format("the ending of '{}' does not say what kind of file to write", path),
                         fmt::format("let the name end in .{}", fmt::join(known, ", .")));
    return ending;
}

std::string require_drawing_program(const std::string& name, const std::string& remedy) {
    const auto path = find_program(name);
    if (!path)
        throw InputError(fmt::format("the program '{}', which draws pictures, is not on the PATH", name), remedy);
    return *path;
}

void require_whole_picture(const std::string& file, const std::string& ending, const std::string& path) {
    constexpr std::streamoff most = 64; // bytes in which the end is looked for
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    const std::streamoff size = stream.tellg();
    std::string tail(static_cast<std::size_t>(std::clamp<std::streamoff>(size, 0, most)), ' ');
    stream.seekg(-static_cast<std::streamoff>(tail.size()), std::ios::end);
    stream.read(tail.data(), static_cast<std::streamsize>(tail.size()));
    const char* end = ending == "png"                      ? "IEND"
                      : ending == "pdf" || ending == "eps" ? "%%EOF"
                      : ending == "tex"                    ? "\\endgroup"
                                                           : "</svg>";
    if (!stream || tail.find(end) == std::string::npos)
        throw InputError(fmt::format("'{}' was not drawn to its end", path), "look whether the disk is full");
}

void require_well_formed_picture(const FileReplacement& file, const std::string& ending, const std::string& path) {
    require_whole_picture(file.temporary_path(), ending, path);
    if (ending != "svg")
        return;
    std::ifstream stream(file.temporary_path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (const std::string mended = well_formed(text); mended != text) // programs leave all of it alone
        file.write(mended);
}

void draw_by_gnuplot(const std::string& script, const FileReplacement& file, const std::string& ending,
                     const std::string& path, const std::string& remedy) {
    const std::string gnuplot =
        require_drawing_program("gnuplot", "install gnuplot (Debian: apt-get install gnuplot-nox)");
    // From a file: gnuplot reads standard input letter by letter, which takes it long for many points.
    const FileReplacement commands(path + ".gp");
    commands.write(script);
    const ProcessResult result = run_process({gnuplot, "-d", commands.temporary_path()}, "");
    if (result.status != 0)
        throw InputError(fmt::format("gnuplot could not draw '{}': {}", path, one_line(result.output)), remedy);
    require_well_formed_picture(file, ending, path);
}

std::string one_line(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0;
        if (blank && (result.empty() || result.back() == ' '))
            continue;
        result += blank ? ' ' : c;
    }
    if (!result.empty() && result.back() == ' ')
        result.pop_back();
    return result;
}

} // namespace graze
