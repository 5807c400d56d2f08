#pragma once

#include "graze/page/page_server.hpp"
#include "page/raw_client.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <map>
#include <string>

namespace graze::testing {

/// What a page's server has answered.
struct Answered {
    int status = 0;
    std::string text; ///< with headers
    nlohmann::json json;

    /// The problem that an error tells.
    std::string problem() const {
        return json.contains("error")    ? json["error"].value("problem", "")
               : json.contains("errors") ? json["errors"][0].value("problem", "")
                                         : "";
    }
};

/// A page that asks its server.
class PageClient {
public:
    explicit PageClient(const PageServer& server) : port_(server.port()), token_(server.token()) {}

    int port() const { return port_; }
    std::string head(const std::string& method, const std::string& path) const {
        return method + " " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) +
               "\r\nAuthorization: Bearer " + token_ + "\r\n";
    }
    Answered ask(const std::string& method, const std::string& path) const {
        return parsed(raw_answer(port_, head(method, path) + "\r\n"));
    }
    Answered get(const std::string& path) const { return ask("GET", path); }
    Answered send(const std::string& method, const std::string& path, const std::string& body) const {
        return parsed(raw_answer(port_, head(method, path) + "Content-Type: application/json\r\nContent-Length: " +
                                            std::to_string(body.size()) + "\r\n\r\n" + body));
    }
    Answered post(const std::string& path, const nlohmann::json& body) const { return send("POST", path, body.dump()); }
    Answered put(const std::string& path, const nlohmann::json& body) const { return send("PUT", path, body.dump()); }

private:
    static Answered parsed(const std::string& text) {
        return {status_of(text), text, nlohmann::json::parse(body_of(text), nullptr, false)};
    }
    int port_;
    std::string token_;
};

/// Listens to the events of a server.
class EventClient {
public:
    explicit EventClient(const PageClient& client) : connection_(client.port()) {
        connection_.send(client.head("GET", "/api/events") + "\r\n");
        connection_.read_until(":\n\n");
    }
    /// The data of the next event of this name for which `wanted` holds; null if there is none for long.
    template <class Wanted>
    nlohmann::json wait_for(const std::string& event, const Wanted& wanted) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (std::chrono::steady_clock::now() < end) {
            const std::string text = connection_.read_until("\n\n"), begin = "event: ", middle = "\ndata: ";
            if (!text.ends_with("\n\n"))
                return nullptr;
            const auto name = text.find(begin), rest = text.find(middle);
            if (name == std::string::npos || rest == std::string::npos)
                continue;
            nlohmann::json data = nlohmann::json::parse(text.substr(rest + middle.size()), nullptr, false);
            const std::string found = text.substr(name + begin.size(), rest - name - begin.size());
            if (found == event && wanted(data))
                return data;
            passed_[found] = std::move(data);
        }
        return nullptr;
    }
    /// The data of the last event of this name that was passed over while another was waited for; null if there is
    /// none.
    nlohmann::json passed(const std::string& event) const {
        const auto found = passed_.find(event);
        return found == passed_.end() ? nlohmann::json() : found->second;
    }
    nlohmann::json wait_for_job(const std::string& state) {
        return wait_for("job", [&](const nlohmann::json& job) { return job["state"] == state; });
    }
    std::string read_to_end() { return connection_.read_all(); }

private:
    RawClient connection_;
    std::map<std::string, nlohmann::json> passed_;
};

} // namespace graze::testing
