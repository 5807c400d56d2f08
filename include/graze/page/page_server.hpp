#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace graze {

/// What a page shows, and where.
struct PageOptions {
    std::string opened{}; ///< results or their folder, a study, or a model, as for `graze view`; empty: this folder
    bool model = false;   ///< of a name that a study and a model bear, the model is meant
    int port = 0;         ///< 0: a free one
    /// Folder of the results of a study or model, and of a study that has no file yet; empty: studies are saved in the
    /// current folder, and results in a folder there that has the study's name, as `graze run` does. A study that goes
    /// on from results is saved beside them.
    std::string folder{};
    int threads = 1;                                               ///< that compute
    std::chrono::milliseconds patience = std::chrono::seconds(10); ///< with slow clients
    std::chrono::milliseconds work = std::chrono::seconds(30);     ///< for the queries of one answer
};

/// Serves a page in which results, a study or a model are looked at, and runs of it are computed: to programs of this
/// machine that know a token, at 127.0.0.1. docs/page-interface.md describes what it answers.
///
/// It reads a result file while another process writes to it, and writes to it only while it computes. It writes no
/// other file than the results, and the text of the study where the user saves it.
class PageServer {
public:
    /// @throws InputError when there is nothing of that kind, or the port is taken
    explicit PageServer(const PageOptions& options);
    ~PageServer(); ///< stops
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    /// Answers from now on, in threads of its own.
    void start();
    /// Where the page is, with the token: http://127.0.0.1:PORT/?token=TOKEN
    const std::string& address() const;
    int port() const;
    /// A token that all requests need.
    const std::string& token() const;
    /// Returns when it is told to. @param interrupted asked ten times a second
    static void wait(const std::function<bool()>& interrupted);
    /// Interrupts what is computed, which keeps what it has, and ends all connections. Called again it does nothing.
    void stop();

private:
    class Parts;
    std::unique_ptr<Parts> parts_;
};

/// Whether this build has the page itself. Without it a server has its interface only.
bool has_page();

} // namespace graze
