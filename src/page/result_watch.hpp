#pragma once

#include "page/event_stream.hpp"
#include "page/study_session.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace graze {

/// Reads a session's study again if its files have changed, and tells listeners so.
void look_at_study(StudySession& session, EventStream& events);

/// Looks at the files of a session now and then, and tells listeners what has changed, whoever changed it: the event
/// `runs` with the revisions of all runs, or why they cannot be read, and `study` with that of the text.
class ResultWatch {
public:
    /// @param pause between two looks
    ResultWatch(StudySession& session, EventStream& events,
                std::chrono::milliseconds pause = std::chrono::milliseconds(400));
    ~ResultWatch(); ///< stops
    ResultWatch(const ResultWatch&) = delete;
    ResultWatch& operator=(const ResultWatch&) = delete;

    /// Looks now, as after a job has ended.
    void look_now();

private:
    void work();
    void look();
    void look_at_runs();
    void tell_failure(const InputError& failure);

    StudySession* session_;
    EventStream* events_;
    std::chrono::milliseconds pause_;
    std::string seen_;                             ///< size and time of the result file when it was read
    std::shared_ptr<const Study> seen_study_;      ///< with which the runs were compared
    std::map<std::string, std::string> revisions_; ///< with their states
    std::string failure_; ///< why the runs could not be read at the last look; empty: they were
    bool failure_told_ = false;
    std::mutex mutex_;
    std::condition_variable awaited_;
    bool now_ = false;
    std::atomic<bool> ended_ = false;
    std::thread thread_;
};

} // namespace graze
