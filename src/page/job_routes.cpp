#include "graze/base/input_error.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/stored_study.hpp"
#include "page/error_answer.hpp"
#include "page/page_route.hpp"
#include "page/request_json.hpp"
#include "page/result_watch.hpp"
#include "page/stored_subject.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

/// The runs that a job computes: those that its text adds to the study, or some that the study has.
std::vector<std::string> runs_of_job(PageParts& parts, const PageCall& call) {
    const std::string text = text_member(call.body, "text", "");
    std::vector<std::string> runs = texts_member(call.body, "runs");
    if (text.empty() == runs.empty())
        throw InputError("a job needs either text or runs", "give 'text' with new runs, or 'runs' with names");
    if (!text.empty()) {
        runs = parts.session.append(text);
        parts.events.tell("study", {{"revision", parts.session.text().revision}});
        return runs;
    }
    const std::shared_ptr<const Study> study = parts.session.faultless_study();
    for (const std::string& run : runs)
        if (study->find_run(run) == nullptr)
            throw InputError(fmt::format("the study has no run '{}'", run),
                             name_advice(run, names_of(study->runs), "it has none"));
    return runs;
}

HttpAnswer begin_job(PageParts& parts, const PageCall& call) {
    if (!parts.session.can_compute())
        throw InputError(fmt::format("the folder of {} cannot be written", parts.session.results_path()),
                         "copy it into a folder of yours");
    look_at_study(parts.session, parts.events); // a file may have been changed a moment ago
    parts.jobs.require_room();                  // before the study is changed
    const Job job = parts.jobs.add(runs_of_job(parts, call));
    parts.events.tell("job", job_json(job));
    return json_answer(job_json(job));
}

HttpAnswer answer_jobs(PageParts& parts, const PageCall&) {
    nlohmann::json list = nlohmann::json::array();
    for (const Job& job : parts.jobs.jobs())
        list.push_back(job_json(job));
    return json_answer(list);
}

HttpAnswer stop_job(PageParts& parts, const PageCall& call) {
    const auto job = parts.jobs.stop(count_of(call.id, "id"));
    if (!job)
        throw RefusedRequest(404, "there is no such job", "GET /api/jobs lists them");
    // One that runs tells by itself when it has ended.
    if (job->state == JobState::stopped)
        parts.events.tell("job", job_json(*job));
    return json_answer(job_json(*job));
}

/// Refuses to remove a run from which another one begins.
void require_not_needed(const Study& study, const std::string& run) {
    for (const StudyRun& other : study.runs)
        for (const auto& [name, place] : other.needs())
            if (name == run && other.name != run)
                throw RefusedRequest(409, fmt::format("run '{}' needs run '{}'", other.name, run),
                                     fmt::format("remove '{}' first", other.name));
}

HttpAnswer remove_run(PageParts& parts, const PageCall& call) {
    if (parts.jobs.is_busy())
        throw RefusedRequest(409, "a job computes runs", "wait for its end, or stop it");
    {
        stored_record(present_results(parts.session), call.id);
        require_not_needed(*parts.session.study(), call.id);
        ResultFile file(parts.session.results_path(), ResultFile::Access::write);
        require_not_needed(stored_study(file), call.id);
        Study asked = asked_study(file); // the file has it as well
        file.remove_run(call.id);
        std::erase_if(asked.runs, [&](const StudyRun& run) { return run.name == call.id; });
        if (stored_set(file))
            store_study(asked, file);
    }
    parts.session.look_at_results();
    return json_answer({{"removed", call.id}});
}

HttpAnswer answer_events(PageParts& parts, const PageCall&) {
    return parts.events.listen();
}

} // namespace

std::vector<PageRoute> job_routes() {
    return {{"POST", "/jobs", begin_job, {"text", "runs"}},
            {"GET", "/jobs", answer_jobs},
            {"DELETE", "/jobs/", stop_job},
            {"DELETE", "/runs/*", remove_run},
            {"GET", "/events", answer_events}};
}

} // namespace graze
