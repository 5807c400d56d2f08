#include "graze/page/page_server.hpp"

#include "page/error_answer.hpp"
#include "page/page_html.hpp"
#include "page/page_route.hpp"
#include "page/request_guard.hpp"
#include "page/result_watch.hpp"
#include "page/study_job.hpp"

#include <fmt/format.h>

#include <thread>

namespace graze {

namespace {

/// What the page may load and run, as it says itself: its own script only. Nobody may show it within another page,
/// which only a header can say.
std::string policy_of(std::string_view page) {
    constexpr std::string_view before = "http-equiv=\"Content-Security-Policy\" content=\"";
    const auto begin = page.find(before);
    const std::string_view rest =
        begin == std::string_view::npos ? "default-src 'none'\"" : page.substr(begin + before.size());
    return std::string(rest.substr(0, rest.find('"'))) + "; frame-ancestors 'none'";
}

HttpAnswer page_answer() {
    if (!has_page())
        return error_answer(404, "this build of graze has no page", "build it where npm and esbuild are");
    HttpAnswer answer;
    answer.type = "text/html; charset=utf-8";
    answer.body = page_html();
    answer.headers.emplace_back("Content-Security-Policy", policy_of(page_html()));
    return answer;
}

void add_safe_headers(HttpAnswer& answer) {
    answer.headers.emplace_back("X-Content-Type-Options", "nosniff");
    answer.headers.emplace_back("Referrer-Policy", "no-referrer");
    answer.headers.emplace_back("Cache-Control", "no-store");
    answer.headers.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
}

std::optional<HttpAnswer> refusal_for(RequestVerdict verdict) {
    switch (verdict) {
    case RequestVerdict::accepted:
        return std::nullopt;
    case RequestVerdict::wrong_token:
        return error_answer(401, "the token is missing or wrong",
                            "open the whole address that was printed at the start");
    case RequestVerdict::wrong_host:
    case RequestVerdict::wrong_origin:
        break;
    }
    return error_answer(403, "the request comes from another place than this server's page",
                        "open the whole address that was printed at the start");
}

} // namespace

bool has_page() {
    return !page_html().empty();
}

class PageServer::Parts {
public:
    explicit Parts(const PageOptions& options)
        : session_(page_subject(options.opened, options.model), options.folder), limits_{.patience = options.patience},
          work_(options.work), server_(options.port, limits_), guard_(random_token(), server_.port()),
          address_(fmt::format("http://127.0.0.1:{}/?token={}", server_.port(), guard_.token())),
          jobs_(
              [this, threads = options.threads](const std::vector<std::string>& runs, const JobControl& control) {
                  look_at_study(session_, events_); // other programs may have changed its files while the job waited
                  return compute_runs(session_, runs, control, threads);
              },
              [this](const Job& job) { tell(job); }),
          watch_(session_, events_) {}

    void start() {
        server_.start(
            [this](const HttpRequest& request) {
                auto refusal = examine(request);
                if (refusal)
                    add_safe_headers(*refusal);
                return refusal;
            },
            [this](const HttpRequest& request) {
                HttpAnswer given = answer(request);
                add_safe_headers(given);
                return given;
            });
    }

    void stop() {
        stopping_ = true;
        jobs_.stop_all();
        events_.close();
        // Each listener is told the end before its connection is.
        for (int i = 0; i < 100 && events_.listeners() > 0; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        server_.stop();
    }

    const std::string& address() const { return address_; }
    int port() const { return server_.port(); }
    const std::string& token() const { return guard_.token(); }

private:
    static bool is_page(const HttpRequest& request) { return request.path == "/"; }

    std::optional<HttpAnswer> examine(const HttpRequest& request) const {
        if (is_page(request)) {
            if (auto refusal = refusal_for(guard_.examine_page(request.origin)))
                return refusal;
            if (request.method != "GET")
                return error_answer(405, "the page is only read", "use GET");
            return std::nullopt;
        }
        if (auto refusal = refusal_for(guard_.examine_data(request.origin)))
            return refusal;
        return routes_.refuse(request);
    }

    HttpAnswer answer(const HttpRequest& request) {
        if (is_page(request))
            return page_answer();
        PageParts parts{session_, jobs_, events_, runs_, limits_, stopping_, work_};
        return routes_.answer(parts, request);
    }

    void tell(const Job& job) {
        events_.tell("job", job_json(job));
        watch_.look_now();
    }

    StudySession session_;
    LoopbackLimits limits_;
    std::chrono::milliseconds work_;
    LoopbackServer server_;
    RequestGuard guard_;
    std::string address_;
    PageRoutes routes_;
    std::atomic<bool> stopping_ = false;
    RunsMemory runs_;
    EventStream events_;
    JobQueue jobs_;
    ResultWatch watch_;
};

PageServer::PageServer(const PageOptions& options) : parts_(std::make_unique<Parts>(options)) {}

PageServer::~PageServer() {
    stop();
}

void PageServer::start() {
    parts_->start();
}

const std::string& PageServer::address() const {
    return parts_->address();
}

int PageServer::port() const {
    return parts_->port();
}

const std::string& PageServer::token() const {
    return parts_->token();
}

void PageServer::wait(const std::function<bool()>& interrupted) {
    while (!interrupted())
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

void PageServer::stop() {
    parts_->stop();
}

} // namespace graze
