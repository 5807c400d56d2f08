#include "program/study_outputs.hpp"
#include "program/drawing.hpp"

#include "graze/base/input_error.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/study/study_table.hpp"
#include "program/interrupt.hpp"
#include "program/kept_inputs.hpp"
#include "program/output_file.hpp"
#include "program/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace graze {

namespace {

/// Version of the way in which results are drawn: pictures of other versions are drawn again.
constexpr int drawing_version = 5;

std::string contents_of(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The files of one picture of a study, and the note in the result file that tells what they were made from.
class PictureFiles {
public:
    PictureFiles(const StudyPicture& picture, ResultFile& file, const std::string& folder)
        : picture_(&picture), file_(&file), base_((std::filesystem::path(folder) / picture.name).string()) {}

    std::string table() const { return base_ + ".csv"; }
    std::string drawing_file() const { return base_ + "." + picture_->format; }
    /// All files of the drawing: for LaTeX a text, and a PDF of the lines.
    std::vector<std::string> drawing_files() const {
        std::vector<std::string> files{drawing_file()};
        if (picture_->format == "tex")
            files.push_back(base_ + ".pdf");
        return files;
    }

    /// The existing files, if they show the present results and have not changed since; otherwise none.
    std::vector<std::string> present() const {
        const auto note = file_->note(key());
        if (!note)
            return {};
        for (const bool with_table : {false, true}) {
            std::vector<std::string> files = drawing_files();
            if (with_table)
                files.insert(files.begin(), table());
            if (*note == made_of(files))
                return files;
        }
        return {};
    }
    void remember(const std::vector<std::string>& files) { file_->set_note(key(), made_of(files)); }

private:
    std::string key() const { return "picture " + picture_->name; }
    /// Fingerprint of everything that the picture depends on, and of the contents of its files.
    std::string made_of(const std::vector<std::string>& files) const {
        std::string text = fmt::format("{} {} {}", drawing_version, GRAZE_VERSION, settings_of(*picture_));
        std::vector<std::string> names = picture_->runs;
        names.insert(names.end(), picture_->over.begin(), picture_->over.end());
        for (const RunRecord& run : file_->runs())
            if (!has_own_picture(run, *file_)) // the picture of its atlas shows it
                names.push_back(run.name);
        for (const std::string& name : names)
            if (const auto run = file_->find_run(name)) {
                text += fmt::format("\n{} {} {} {}", name, run->fingerprint, file_->point_count(name),
                                    run->status == RunStatus::complete);
                for (const PointName& point : run->point_names)
                    text += fmt::format(" {} {}", point.label, point.name);
            }
        for (const std::string& path : files) {
            std::error_code error;
            if (!std::filesystem::is_regular_file(path, error))
                return "";
            text += '\n' + fingerprint_of(contents_of(path));
        }
        return fingerprint_of(text);
    }

    const StudyPicture* picture_;
    ResultFile* file_;
    std::string base_;
};

/// @return the files that were written
std::vector<std::string> draw_pictures(const StudyPicture& picture, const PictureFiles& files, const ResultFile& file) {
    std::vector<std::string> written;
    const ResultPicture made = make_picture(picture, file);
    if (made.table.rows() > 0) {
        std::ostringstream text;
        write_table(text, made.table, TableFormat::csv, 17, {});
        write_file(files.table(), text.view());
        written.push_back(files.table());
    }
    draw_figure(made.figure, files.drawing_file(), "");
    for (const std::string& path : files.drawing_files())
        written.push_back(path);
    return written;
}

/// Leaves runs without points, as after a failure, out of a picture. @throws InputError when no run is left
void leave_out_empty_runs(StudyPicture& picture, const ResultFile& file, const Console& console) {
    const auto is_empty = [&](const std::string& run) { return file.point_count(run) == 0; };
    if (std::all_of(picture.runs.begin(), picture.runs.end(), is_empty))
        throw InputError(fmt::format("run '{}' has no points", picture.runs.front()), "see why above");
    std::vector<std::string> names = picture.runs;
    names.insert(names.end(), picture.over.begin(), picture.over.end());
    for (const std::string& run : names)
        if (is_empty(run))
            console.err << fmt::format("graze: warning: picture '{}' was drawn without run '{}', which has no points\n",
                                       picture.name, run);
    std::erase_if(picture.runs, is_empty);
    std::erase_if(picture.over, is_empty);
}

} // namespace

DrawnPictures draw_study_pictures(const Study& study, ResultFile& file, const std::string& folder,
                                  const Console& console) {
    std::vector<StudyPicture> pictures = study.pictures;
    if (pictures.empty() && study.tables.empty())
        for (const StudyRun& run : study.runs)
            if (const auto record = file.find_run(run.name);
                record && file.point_count(run.name) > 0 && has_own_picture(*record, file))
                pictures.push_back(default_picture(*record));
    DrawnPictures drawn;
    for (StudyPicture& picture : pictures) {
        if ((drawn.interrupted = InterruptGuard::requested()))
            break;
        try {
            leave_out_empty_runs(picture, file, console);
            PictureFiles files(picture, file, folder);
            std::vector<std::string> targets = files.drawing_files();
            targets.push_back(files.table());
            for (const std::string& path : targets) {
                require_inside(path, folder);
                KeptInputs::require_none_at(path);
            }
            std::vector<std::string> paths = files.present();
            if (!paths.empty())
                ++drawn.kept;
            else
                files.remember(paths = draw_pictures(picture, files, file));
            drawn.paths.insert(drawn.paths.end(), paths.begin(), paths.end());
        } catch (const InputError& error) {
            if ((drawn.interrupted = InterruptGuard::requested())) // Ctrl-C has also ended gnuplot
                break;
            console.err << fmt::format("graze: warning: picture '{}' was not drawn: {}\n", picture.name, error.what());
            drawn.complete = false;
        }
    }
    return drawn;
}

WrittenTables write_study_tables(const Study& study, const ResultFile& file, const std::string& folder,
                                 const Console& console) {
    WrittenTables written;
    for (const StudyTable& table : study.tables) {
        try {
            const std::string path = (std::filesystem::path(folder) / (table.name + ".csv")).string();
            require_inside(path, folder);
            if (const std::string text = csv_text(make_table(table, file)); contents_of(path) != text)
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
