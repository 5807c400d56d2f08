#include "page/page_route.hpp"

#include "graze/results/query_interruption.hpp"
#include "page/error_answer.hpp"
#include "page/request_json.hpp"
#include "page/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr std::string_view prefix = "/api";

/// Whether the route has this path; then `id` is set to the number that ends it, if any.
bool has_path(const PageRoute& route, std::string_view path, std::string* id = nullptr) {
    if (!path.starts_with(prefix))
        return false;
    path.remove_prefix(prefix.size());
    if (route.path.ends_with('*')) {
        const std::string_view before = std::string_view(route.path).substr(0, route.path.size() - 1);
        if (!path.starts_with(before) || path.size() == before.size() || path.find('/', before.size()) != path.npos)
            return false;
        if (id != nullptr)
            *id = path.substr(before.size());
        return true;
    }
    if (!route.path.ends_with('/'))
        return path == route.path;
    constexpr std::size_t most_digits = 9;
    if (!path.starts_with(route.path))
        return false;
    const std::string_view number = path.substr(route.path.size());
    if (id != nullptr)
        *id = number;
    return !number.empty() && number.size() <= most_digits &&
           std::ranges::all_of(number, [](char c) { return c >= '0' && c <= '9'; });
}

/// Why the work on an answer ends before it is there.
enum class CutShort { no, stopping, late, left };

/// Says when work on an answer has to end: a query of a result file would go on after the server has been told to end,
/// or its client has left, and a file may ask for motions of any duration.
class AnswerLimit {
public:
    AnswerLimit(const PageParts& parts, const HttpRequest& request)
        : parts_(&parts), request_(&request), late_(time_limit(std::chrono::duration<double>(parts.work).count())) {}

    bool is_reached() {
        cut_ = parts_->stopping                             ? CutShort::stopping
               : late_()                                    ? CutShort::late
               : request_->has_left && request_->has_left() ? CutShort::left
                                                            : cut_;
        return cut_ != CutShort::no;
    }
    /// The answer to what could not be done.
    HttpAnswer refusal(const std::exception_ptr& failure) const {
        switch (cut_) {
        case CutShort::stopping:
            return error_answer(503, "the server ends", "start it again");
        case CutShort::late:
            return error_answer(400, fmt::format("the answer takes more than {} of work", shown(parts_->work)),
                                "ask for less; if the file is a stranger's, it may be made to do so");
        case CutShort::left: // nobody reads it
        case CutShort::no:
            break;
        }
        return error_answer(failure);
    }

private:
    static std::string shown(std::chrono::milliseconds time) {
        return fmt::format("{} seconds", std::chrono::duration<double>(time).count());
    }
    const PageParts* parts_;
    const HttpRequest* request_;
    std::function<bool()> late_;
    CutShort cut_ = CutShort::no;
};

} // namespace

const std::string& PageCall::query(const char* name) const {
    const auto found = http.query.find(name);
    if (found == http.query.end())
        throw InputError(fmt::format("the address has no '{}'", name), fmt::format("add {}=...", name));
    return found->second;
}

PageRoutes::PageRoutes() {
    for (std::vector<PageRoute> some : {reading_routes(), point_routes(), study_routes(), job_routes()})
        std::ranges::move(some, std::back_inserter(routes_));
}

const PageRoute* PageRoutes::find(const HttpRequest& request, bool any_method) const {
    const auto found = std::ranges::find_if(routes_, [&](const PageRoute& route) {
        return (any_method || route.method == request.method) && has_path(route, request.path);
    });
    return found == routes_.end() ? nullptr : &*found;
}

std::optional<HttpAnswer> PageRoutes::refuse(const HttpRequest& request) const {
    if (find(request, false) != nullptr)
        return std::nullopt;
    if (find(request, true) == nullptr)
        return error_answer(404, "there is no such address", "docs/page-interface.md lists them");
    std::string methods;
    for (const PageRoute& route : routes_)
        if (has_path(route, request.path))
            methods += (methods.empty() ? "" : ", ") + route.method;
    HttpAnswer answer = error_answer(405, "the address does not take this method", "use " + methods);
    answer.headers.emplace_back("Allow", methods);
    return answer;
}

HttpAnswer PageRoutes::answer(PageParts& parts, const HttpRequest& request) const {
    AnswerLimit limit(parts, request);
    try {
        if (parts.stopping)
            throw RefusedRequest(503, "the server ends", "start it again");
        const QueryInterruption interruption([&] { return limit.is_reached(); });
        const PageRoute* route = find(request, false);
        PageCall call{request, nlohmann::json::object(), ""};
        has_path(*route, request.path, &call.id);
        if (!request.body.empty())
            call.body = request_json(request.body);
        require_known_members(call.body, route->members);
        const bool has_body = request.method == "POST" || request.method == "PUT";
        for (const auto& [name, value] : request.query)
            require_known(name, has_body ? std::vector<std::string>() : route->members, "part of the address");
        return route->answer(parts, call);
    } catch (...) {
        return limit.refusal(std::current_exception());
    }
}

} // namespace graze
