#pragma once

#include "page/event_stream.hpp"
#include "page/http_message.hpp"
#include "page/job_queue.hpp"
#include "page/loopback_server.hpp"
#include "page/runs_json.hpp"
#include "page/study_session.hpp"

#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace graze {

/// What requests are answered from.
struct PageParts {
    StudySession& session;
    JobQueue& jobs;
    EventStream& events;
    RunsMemory& runs;
    LoopbackLimits limits;
    const std::atomic<bool>& stopping; ///< ends long answers
    std::chrono::milliseconds work;    ///< for the queries of one answer
};

/// A request whose address is known, with what is in it.
struct PageCall {
    const HttpRequest& http;
    nlohmann::json body; ///< an object; empty for requests without a body
    std::string id;      ///< the last part of an address that ends in a number or a name

    /// A member of the query. @throws InputError if it is missing
    const std::string& query(const char* name) const;
    bool has_query(const char* name) const { return http.query.contains(name); }
};

/// What is answered at one address.
struct PageRoute {
    std::string method;
    std::string path; ///< behind /api; if it ends in a slash, a number follows, and for '*' a name
    std::function<HttpAnswer(PageParts& parts, const PageCall& call)> answer;
    std::vector<std::string> members{}; ///< that the body may have, or the query where there is no body
};

/// Routes that only read, those of texts and proposals, and those of jobs and events.
std::vector<PageRoute> reading_routes();
std::vector<PageRoute> point_routes();
std::vector<PageRoute> study_routes();
std::vector<PageRoute> job_routes();

/// All addresses of the interface, as docs/page-interface.md describes them.
class PageRoutes {
public:
    PageRoutes();

    /// Refuses a request for what does not exist. @return none: there is such an address
    std::optional<HttpAnswer> refuse(const HttpRequest& request) const;
    /// Answers a request that is not refused. Does not throw.
    HttpAnswer answer(PageParts& parts, const HttpRequest& request) const;

private:
    const PageRoute* find(const HttpRequest& request, bool any_method) const;
    std::vector<PageRoute> routes_;
};

} // namespace graze
