#include "program/study_pictures.hpp"

#include "graze/symbolic/input_error.hpp"
#include "program/figure.hpp"
#include "program/output_file.hpp"
#include "program/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace graze {

DrawnPictures draw_study_pictures(const Study& study, const ResultFile& file, const std::string& folder,
                                  const Console& console) {
    const std::vector<std::string> inputs = input_files(study);
    std::vector<StudyPicture> pictures = study.pictures;
    if (pictures.empty())
        for (const StudyRun& run : study.runs)
            if (const auto record = file.find_run(run.name); record && file.point_count(run.name) > 0)
                pictures.push_back(default_picture(*record));
    DrawnPictures drawn;
    for (const StudyPicture& picture : pictures) {
        const std::string base = (std::filesystem::path(folder) / picture.name).string();
        try {
            if (std::none_of(picture.runs.begin(), picture.runs.end(),
                             [&](const std::string& run) { return file.point_count(run) > 0; }))
                throw InputError(fmt::format("run '{}' has no points", picture.runs.front()), "see why above");
            const ResultPicture made = make_picture(picture, file);
            for (const std::string& path : {base + ".csv", base + "." + picture.format}) {
                require_inside(path, folder);
                for (const std::string& input : inputs)
                    require_distinct({{"the study, or what it reads,", input}, {"picture " + picture.name, path}});
            }
            if (made.table.rows() > 0) {
                std::ostringstream text;
                write_table(text, made.table, TableFormat::csv, 17, {});
                write_file(base + ".csv", text.view());
                drawn.paths.push_back(base + ".csv");
            }
            draw_figure(made.figure, base + "." + picture.format, "");
            drawn.paths.push_back(base + "." + picture.format);
        } catch (const InputError& error) {
            console.err << fmt::format("graze: warning: picture '{}' was not drawn: {}\n", picture.name, error.what());
            drawn.complete = false;
        }
    }
    return drawn;
}

} // namespace graze
