#include "program/study_pictures.hpp"

#include "graze/symbolic/input_error.hpp"
#include "program/output_file.hpp"
#include "program/picture_kinds.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

namespace graze {

StudyPicture default_picture(const RunRecord& run) {
    StudyPicture picture;
    picture.name = run.name;
    picture.runs = {run.name};
    if (run.kind == "sweep")
        picture.kind = "bifurcation";
    else if (run.kind == "basin" && run.coordinates.size() > 1)
        picture.kind = "basin";
    else if (run.kind == "basin")
        picture.kind = "scatter";
    else
        picture.kind = "history";
    return picture;
}

ResultPicture make_picture(const StudyPicture& given, const ResultFile& file) {
    StudyPicture picture = given;
    if (picture.kind.empty())
        if (const auto run = file.find_run(picture.runs.front()))
            picture.kind = default_picture(*run).kind;
    ResultPicture result;
    if (picture.kind == "basin")
        result = basin_picture(picture, file);
    else if (picture.kind == "spectrum")
        result = spectrum_picture(picture, file);
    else if (picture.kind == "regression")
        result = regression_picture(picture, file);
    else if (picture.kind == "history" || picture.kind == "portrait")
        result.figure = motion_picture(picture, file, picture.kind == "portrait");
    else if (picture.kind == "scatter")
        result.figure = scatter_picture(picture, file);
    else
        result.figure = bifurcation_picture(picture, file);
    result.figure.title = picture.title;
    return result;
}

std::vector<std::string> draw_study_pictures(const Study& study, const ResultFile& file, const std::string& folder,
                                             const Console& console) {
    std::vector<StudyPicture> pictures = study.pictures;
    if (pictures.empty())
        for (const StudyRun& run : study.runs)
            if (const auto record = file.find_run(run.name))
                pictures.push_back(default_picture(*record));
    std::vector<std::string> written;
    for (const StudyPicture& picture : pictures) {
        const std::string base = (std::filesystem::path(folder) / picture.name).string();
        try {
            const ResultPicture made = make_picture(picture, file);
            if (made.table.rows() > 0) {
                std::ostringstream text;
                write_table(text, made.table, TableFormat::csv, 17, {});
                write_file(base + ".csv", text.view());
                written.push_back(base + ".csv");
            }
            draw_figure(made.figure, base + "." + picture.format, "");
            written.push_back(base + "." + picture.format);
        } catch (const InputError& error) {
            console.err << fmt::format("graze: warning: picture '{}' was not drawn: {}\n", picture.name, error.what());
        }
    }
    return written;
}

} // namespace graze
