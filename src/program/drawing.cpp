#include "program/drawing.hpp"

#include "base/letter_case.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/xml_text.hpp"
#include "graze/model/check.hpp"
#include "graze/picture/fabrication_picture.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/layout_picture.hpp"
#include "picture/figure_layout.hpp"
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

namespace {

std::string contents_of_script(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string without_ending(const std::string& path) {
    return path.substr(0, path.rfind('.'));
}

/// Completes a picture for LaTeX: gnuplot has written a text and a PDF of the lines. The PDF gets the picture's name,
/// beside the text, and the text refers to it by that name.
void finish_latex(const FileReplacement& file, const std::string& path, double font) {
    const std::string drawn = without_ending(file.temporary_path());
    const std::string lines = contents_of_script(drawn + ".pdf");
    std::error_code error;
    std::filesystem::remove(drawn + ".pdf", error);
    std::string text = contents_of_script(file.temporary_path());
    const std::string name = std::filesystem::path(without_ending(path)).filename().string();
    for (std::size_t found = text.find(drawn); found != std::string::npos;
         found = text.find(drawn, found + name.size()))
        text.replace(found, drawn.size(), name);
    const std::string begin = "\\begingroup";
    if (const std::size_t found = text.find(begin); found != std::string::npos)
        text.insert(found + begin.size(), fmt::format("\\fontsize{{{:g}}}{{{:g}}}\\selectfont", font, 1.2 * font));
    write_file(without_ending(path) + ".pdf", lines);
    file.write(text);
}

} // namespace

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
    constexpr std::streamoff most = 64; // the last bytes, in which the end mark is searched
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
    if (const std::string mended = well_formed(text); mended != text) // already well formed in most cases
        file.write(mended);
}

void draw_by_gnuplot(const std::string& script, const FileReplacement& file, const std::string& ending,
                     const std::string& path, const std::string& remedy) {
    const std::string gnuplot =
        require_drawing_program("gnuplot", "install gnuplot (Debian: apt-get install gnuplot-nox)");
    // The commands go through a file: gnuplot reads standard input one character at a time, slow for many points.
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

void draw_figure(const Figure& figure, const std::string& path, const std::string& data_path) {
    const std::string ending = picture_ending(path, "--output", figure_endings());
    require_drawing_program("gnuplot", "install gnuplot (Debian: apt-get install gnuplot-nox)");
    require_distinct({{"the picture", path}, {"--data", data_path}});
    if (!data_path.empty())
        write_file(data_path, figure_script(figure, ending, path));
    FileReplacement file(path);
    draw_by_gnuplot(figure_script(figure, ending, file.temporary_path()), file, ending, path,
                    "keep its commands by --data FILE and run gnuplot FILE");
    if (ending == "tex")
        finish_latex(file, path, layout_of(figure).font);
    file.commit();
}

namespace {

/// Draws a picture whose gnuplot commands are not kept.
/// @param option for messages; @param script returns the commands for an ending and an output file
template <class Script>
void draw_script(const std::string& path, const std::string& option, const Script& script) {
    const std::string ending = picture_ending(path, option, {"svg", "png", "pdf"});
    FileReplacement file(path);
    draw_by_gnuplot(script(ending, file.temporary_path()), file, ending, path,
                    "look whether this gnuplot is of version 5.2 or later");
    file.commit();
}

} // namespace

void draw_layout(const Layout& layout, const std::string& path, std::optional<int> mask) {
    draw_script(path, "--picture", [&](const std::string& ending, const std::string& output) {
        return layout_picture_script(layout, ending, output, mask);
    });
}

void draw_wafer_map(const WaferYield& yield, const WaferPlan& plan, const WaferMapLabels& labels,
                    const std::string& path) {
    draw_script(path, "--folder", [&](const std::string& ending, const std::string& output) {
        return wafer_map_script(yield, plan, labels, ending, output);
    });
}

void draw_fabrication(const std::vector<ProcessStep>& steps, const std::string& path) {
    draw_script(path, "--recipe", [&](const std::string& ending, const std::string& output) {
        return fabrication_picture_script(steps, ending, output);
    });
}

void draw_graph(const Model& model, const std::string& path) {
    const std::string ending = picture_ending(path, "--graph", {"svg", "png", "pdf", "eps", "dot"});
    const std::string graph = connectivity_graph(model);
    if (ending == "dot")
        return write_file(path, graph);
    const std::string program =
        require_drawing_program("dot", "install Graphviz (Debian: apt-get install graphviz), or ask for a .dot file");
    FileReplacement file(path);
    const ProcessResult result = run_process({program, "-T" + ending, "-o", file.temporary_path()}, graph);
    if (result.status != 0)
        throw InputError(fmt::format("Graphviz could not draw '{}': {}", path, one_line(result.output)),
                         "ask for a .dot file and look at it");
    require_well_formed_picture(file, ending, path);
    file.commit();
}

} // namespace graze
