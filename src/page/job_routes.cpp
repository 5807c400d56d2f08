#include "graze/base/input_error.hpp"
#include "graze/results/name_advice.hpp"
#include "page/error_answer.hpp"
#include "page/page_route.hpp"
#include "page/request_json.hpp"
#include "page/result_watch.hpp"

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

HttpAnswer answer_events(PageParts& parts, const PageCall&) {
    return parts.events.listen();
}

} // namespace

std::vector<PageRoute> job_routes() {
    return {{"POST", "/jobs", begin_job, {"text", "runs"}},
            {"GET", "/jobs", answer_jobs},
            {"DELETE", "/jobs/", stop_job},
            {"GET", "/events", answer_events}};
}

} // namespace graze
