#include "graze/atlas/run_atlas.hpp"
#include "graze/base/input_error.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/study/study_part.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/merge.hpp"
#include "program/output_file.hpp"
#include "program/progress_line.hpp"
#include "program/study_reports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sys/resource.h>

namespace graze {

namespace {

namespace fs = std::filesystem;

/// The files of parts in a folder, or in the folder of parts in it, in an order that does not depend on the machine.
std::vector<std::string> parts_in(const std::string& folder) {
    std::error_code error;
    const fs::path own = fs::path(folder) / folder_of_parts;
    std::vector<std::string> paths;
    for (const auto& entry : fs::directory_iterator(fs::is_directory(own, error) ? own : fs::path(folder), error))
        if (entry.path().extension() == ".sqlite")
            paths.push_back(entry.path().string());
    if (paths.empty())
        throw InputError(Place{folder, 0, 0}, "there are no parts of a study in this folder",
                         "let them be computed by graze run STUDY --output FOLDER --part 1/2, and 2/2");
    std::ranges::sort(paths);
    return paths;
}

std::vector<std::string> part_paths(const std::vector<std::string>& given) {
    std::vector<std::string> paths;
    std::error_code error;
    for (const std::string& one : given)
        if (fs::is_directory(one, error))
            std::ranges::copy(parts_in(one), std::back_inserter(paths));
        else
            paths.push_back(one);
    return paths;
}

/// Where the results go if nothing is said: the folder that holds the parts, or their folder.
std::string usual_folder(const std::vector<std::string>& given) {
    std::error_code error;
    if (given.size() != 1 || !fs::is_directory(given.front(), error))
        throw InputError({"--output", 0, 0}, "it is not said where the results go", "name a folder by --output");
    const fs::path folder = fs::path(given.front()).lexically_normal();
    const fs::path named = folder.has_filename() ? folder : folder.parent_path(); // without a slash at its end
    if (named.filename() != folder_of_parts)
        return given.front();
    return named.has_parent_path() ? named.parent_path().string() : ".";
}

std::vector<ResultFile> opened_parts(const std::vector<std::string>& paths) {
    allow_many_files();
    std::vector<ResultFile> parts;
    for (const std::string& path : paths) {
        ResultFile file(path, ResultFile::Access::read);
        const bool is_begun = part_in(file).has_value();
        if (is_begun)
            parts.push_back(std::move(file));
        else if (!file.runs().empty() || paths.size() == 1) // otherwise the part was ended in its first moment
            throw InputError(Place{path, 0, 0}, "this is no part of a study",
                             "name files that graze run --part has written, or their folder");
    }
    if (parts.empty())
        throw InputError(Place{paths.front(), 0, 0}, "no part of a study has been begun yet",
                         "let parts be computed by graze run STUDY --output FOLDER --part 1/2, and 2/2");
    return parts;
}

} // namespace

void allow_many_files() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == limit.rlim_max)
        return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

MergedParts merge_files(Study& study, const std::vector<ResultFile>& parts, const std::vector<std::string>& only,
                        ResultFile& file, const StudyArguments& arguments, const Console& console) {
    for (const ResultFile& part : parts)
        require_same_values(study, part);
    require_same_values(study, file);
    ProgressLine progress(console, arguments.progress || console.terminal);
    RunnerOptions options;
    options.only = only;
    options.interrupted = [] { return InterruptGuard::requested(); };
    options.progress = [&](const StudyProgress& made) { progress.update(made); };
    forget_outdated_atlases(study, file);
    add_atlas_runs(study, file);
    MergedParts merged = merge_parts(study, parts, file, options);
    if (!merged.complete() || is_interrupted(merged.reports))
        return merged;
    Study further = study;
    if (const std::vector<std::string> next = add_atlas_runs(further, file); !next.empty())
        merged.missing.push_back(
            fmt::format("{} of atlases can begin, from '{}' on: compute the parts again, then merge "
                        "them again, or let graze run explore the rest",
                        next.size() == 1 ? "a run" : fmt::format("{} runs", next.size()), next.front()));
    return merged;
}

int finish_merge(const Study& study, const MergedParts& merged, ResultFile& file, const std::string& folder,
                 const StudyArguments& arguments, const Console& console) {
    if (merged.complete() || is_interrupted(merged.reports))
        return finish_study(study, merged.reports, file, folder, arguments, console);
    const std::vector<RunReport> asked = asked_for(study, merged.reports);
    list_runs(asked, file, arguments, console);
    tell_failures(asked, console);
    for (const std::string& sentence : merged.missing)
        console.err << fmt::format("graze: {}\n", sentence);
    return exit_irregular;
}

int merge_command(const MergeArguments& arguments, const Console& console) {
    const std::vector<ResultFile> parts = opened_parts(part_paths(arguments.parts));
    const std::string folder = arguments.folder.empty() ? usual_folder(arguments.parts) : arguments.folder;
    Study study = asked_study(parts.front());
    make_folder(folder, "--output");
    const InterruptGuard guard;
    ResultFile file((fs::path(folder) / "results.sqlite").string(), ResultFile::Access::write);
    const MergedParts merged = merge_files(study, parts, {}, file, arguments, console);
    return finish_merge(study, merged, file, folder, arguments, console);
}

} // namespace graze
