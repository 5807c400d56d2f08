#include "graze/study/whole_run.hpp"

#include "graze/study/stored_study.hpp"
#include "study/copied_run.hpp"
#include "study/point_bytes.hpp"
#include "study/run_schedule.hpp"
#include "study/same_version.hpp"
#include "study/scratch_folder.hpp"

#include <algorithm>
#include <set>

namespace graze {

namespace {

const std::string run_mark = "graze-run-1\n"; ///< the first bytes; they change with what follows

/// Calls a function with each place in the study's file that belongs to a run, for messages; results do not keep them.
void each_place(StudyRun& run, const std::function<void(Place& place)>& use) {
    use(run.place);
    use(run.parameters_place);
    if (run.start)
        use(run.start->place);
    if (run.is_branch())
        use(run.branch().signature_place);
    if (run.kind != RunKind::identify)
        return;
    use(run.identify().records_place);
    for (IdentifyRequest::Unknown& unknown : run.identify().unknowns)
        use(unknown.place);
    for (IdentifyRequest::Reading& reading : run.identify().readings)
        use(reading.place);
}

std::string text_of_run(StudyRun run) {
    ByteWriter bytes(run_mark);
    bytes(std::string(GRAZE_VERSION), run.name);
    each_place(run, [&](const Place& place) { bytes(place.file, place.line, place.column); });
    return bytes.take();
}

/// The name of the run that a text asks for, which gets its places in the study.
std::string asked_run(std::string_view text, Study& study) {
    ByteReader bytes(text, run_mark);
    std::string version, name;
    bytes(version, name);
    require_same_version(version, "run of a study");
    const auto run = std::ranges::find(study.runs, name, &StudyRun::name);
    if (run == study.runs.end())
        ByteReader::fail();
    each_place(*run, [&](Place& place) { bytes(place.file, place.line, place.column); });
    bytes.require_end();
    return name;
}

/// Bytes of a file with the study, as far as the run needs it, and the results of the runs that it needs.
std::string needed_by(const StudyRun& run, const Study& study, const std::string& results) {
    const std::set<std::string> wanted = wanted_runs(study, {run.name});
    Study alone = study;
    std::erase_if(alone.runs, [&](const StudyRun& one) { return !wanted.contains(one.name); });
    alone.pictures.clear();
    alone.tables.clear();
    const ScratchFolder folder;
    {
        ResultFile file(folder / "needed", ResultFile::Access::write);
        store_study(alone, file);
        if (wanted.size() > 1) {
            const ResultFile from(results, ResultFile::Access::read);
            for (const std::string& name : wanted)
                if (const auto record = from.find_run(name); record && name != run.name)
                    copy_run(from, *record, file, *record);
        }
    } // which closes it
    return bytes_in(folder / "needed");
}

} // namespace

bool is_whole_run(std::string_view text) {
    return text.starts_with(run_mark);
}

std::string computed_run(std::string_view text, const std::string& needed, const std::function<bool()>& interrupted) {
    const ScratchFolder folder;
    write_bytes(folder / "needed", needed);
    {
        ResultFile file(folder / "needed", ResultFile::Access::write);
        Study study = stored_study(file);
        const std::string name = asked_run(text, study);
        run_study(study, file, {.only = {name}, .interrupted = interrupted});
        const auto record = file.find_run(name);
        if (!record || record->status == RunStatus::unfinished)
            return "";
        ResultFile result(folder / "result", ResultFile::Access::write);
        copy_run(file, *record, result, *record);
    } // which closes them
    return bytes_in(folder / "result");
}

ResultsElsewhere results_by(const std::shared_ptr<PartExchange>& parts, const Study& study,
                            const std::string& results) {
    // The files stay as long as their results may be read.
    return [parts, study = &study, results,
            folder = std::make_shared<ScratchFolder>()](const AskedResults& asked) -> std::optional<ResultFile> {
        const std::string needed = needed_by(asked.run, *study, results);
        const std::string path = *folder / asked.run.name;
        const auto take = [&](ItemRange, const std::string& file, bool) { write_bytes(path, file); };
        const bool complete = parts->await({text_of_run(asked.run), {{0, 1}}, [&](ItemRange) { return needed; }, take},
                                           asked.interrupted);
        if (!complete)
            return std::nullopt;
        return ResultFile(path, ResultFile::Access::read);
    };
}

} // namespace graze
