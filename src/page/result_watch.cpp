#include "page/result_watch.hpp"

#include "graze/base/input_error.hpp"
#include "graze/results/query_interruption.hpp"
#include "page/error_answer.hpp"
#include "page/runs_json.hpp"
#include "page/study_file.hpp"

#include <nlohmann/json.hpp>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace graze {

namespace {

/// Gives free memory back to the system: the allocator keeps most of what threads have used for studies and results,
/// which is much where runs vary many values.
void give_memory_back() {
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

} // namespace

void look_at_study(StudySession& session, EventStream& events) {
    if (session.look())
        events.tell("study", {{"revision", session.text().revision}});
}

ResultWatch::ResultWatch(StudySession& session, EventStream& events, std::chrono::milliseconds pause)
    : session_(&session), events_(&events), pause_(pause), thread_([this] { work(); }) {}

ResultWatch::~ResultWatch() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    awaited_.notify_one();
    thread_.join();
}

void ResultWatch::look_now() {
    {
        const std::lock_guard lock(mutex_);
        now_ = true;
    }
    awaited_.notify_one();
}

void ResultWatch::work() {
    const QueryInterruption stoppable([this] { return ended_.load(); }); // a file may have queries that take long
    std::unique_lock lock(mutex_);
    while (!ended_) {
        lock.unlock();
        look();
        lock.lock();
        awaited_.wait_for(lock, pause_, [this] { return now_ || ended_; });
        now_ = false;
    }
}

void ResultWatch::look() {
    try {
        look_at_study(*session_, *events_);
    } catch (const std::exception&) { // NOLINT(bugprone-empty-catch): as while it is written; it looks again soon
    }
    try {
        look_at_runs();
    } catch (const InputError& failure) {
        tell_failure(failure);
    } catch (const std::exception&) { // NOLINT(bugprone-empty-catch): as without memory; it looks again soon
    }
}

/// A file that is being written or replaced cannot be read for a moment: only what two looks find is told, once.
void ResultWatch::tell_failure(const InputError& failure) {
    const bool again = failure_ == failure.what();
    failure_told_ = failure_told_ && again;
    failure_ = failure.what();
    if (!again || failure_told_)
        return;
    failure_told_ = true;
    revisions_.clear();
    events_->tell("runs", {{"runs", nlohmann::json::array()}, {"error", error_json(failure)}});
}

void ResultWatch::look_at_runs() {
    const std::string traces = results_trace(session_->results_path());
    const std::shared_ptr<const Study> study = session_->study();
    if (traces == seen_ && study == seen_study_ && failure_.empty())
        return;
    const auto file = session_->results();
    const std::set<std::string> outdated = file ? session_->outdated(*file) : std::set<std::string>();
    std::map<std::string, std::string> revisions;
    nlohmann::json list = nlohmann::json::array();
    if (file)
        for (const RunRecord& run : file->runs()) {
            const std::string revision = run_revision(*file, run);
            const std::string status(outdated.contains(run.name) ? "outdated" : name_of(run.status));
            revisions[run.name] = revision + status;
            list.push_back({{"name", run.name}, {"revision", revision}, {"status", status}});
        }
    const bool others = revisions.size() != revisions_.size() ||
                        !std::equal(revisions.begin(), revisions.end(), revisions_.begin(),
                                    [](const auto& one, const auto& other) { return one.first == other.first; });
    if (others && file)
        session_->look_at_results();
    // What was read may be older than the traces, never newer: a later change leaves other ones.
    seen_ = traces;
    seen_study_ = study;
    failure_.clear();
    give_memory_back();
    if (revisions == revisions_ && !failure_told_)
        return;
    failure_told_ = false;
    revisions_ = std::move(revisions);
    events_->tell("runs", {{"runs", std::move(list)}});
}

} // namespace graze
