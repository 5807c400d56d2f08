#pragma once

#include "page/request_guard.hpp"

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// A request, as far as the page's server looks at it.
struct HttpRequest {
    std::string method, path;
    std::map<std::string, std::string> query{}; ///< what follows the path, behind '?'
    RequestOrigin origin{};
    std::string body{}; ///< empty until it has been read
    std::function<bool()>
        has_left{}; ///< whether the client has closed its connection meanwhile; empty: it is not known
};

/// Takes the parts of an answer that has no end yet.
struct AnswerSink {
    std::function<bool(std::string_view part)> write; ///< false: nobody takes it any more
    std::function<bool()> is_open;                    ///< whether the client is still there
};

struct HttpAnswer {
    int status = 200;
    std::string body{};
    std::string type = "application/json";
    std::vector<std::pair<std::string, std::string>> headers{};
    /// Of an answer that comes in parts instead of a body: called again and again while it returns true.
    std::function<bool(const AnswerSink& sink)> more{};
};

} // namespace graze
