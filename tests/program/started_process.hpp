#pragma once

#include "base/temporary_folder.hpp"
#include "places.hpp"

#include <csignal>
#include <fcntl.h>
#include <optional>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace graze::testing {

/// The program in another process, which is killed at the end of the test.
class StartedProcess {
public:
    /// @param words without the program's name; @param log file for its output and messages
    /// @param most largest size in bytes of files that it writes; 0: no limit
    StartedProcess(std::vector<std::string> words, std::string log, rlim_t most = 0) : log_(std::move(log)) {
        words.insert(words.begin(), program_file);
        std::vector<char*> arguments;
        for (std::string& word : words)
            arguments.push_back(word.data());
        arguments.push_back(nullptr);
        process_ = fork();
        if (process_ != 0)
            return;
        const int file = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        if (most > 0) {
            const rlimit limit{most, most};
            setrlimit(RLIMIT_FSIZE, &limit);
            std::signal(SIGXFSZ, SIG_IGN); // so that writing fails as on a full disk
        }
        execv(arguments[0], arguments.data());
        _exit(127);
    }
    ~StartedProcess() {
        signal(SIGKILL);
        wait();
    }
    StartedProcess(const StartedProcess&) = delete;
    StartedProcess& operator=(const StartedProcess&) = delete;

    void signal(int number) const {
        if (process_ > 0)
            kill(process_, number);
    }
    /// Waits for its end. @return the exit status, or the negative number of the signal that ended it; 1000 where there
    /// is no process to wait for
    int wait() { return ended_by(0).value_or(1000); }
    /// The same if it has ended; none while it runs.
    std::optional<int> ended() { return ended_by(WNOHANG); }
    std::string printed() const { return contents(log_); }

private:
    std::optional<int> ended_by(int options) {
        int status = 0;
        if (process_ <= 0 || waitpid(process_, &status, options) != process_)
            return std::nullopt;
        process_ = -1;
        return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
    }

    std::string log_;
    pid_t process_ = -1;
};

} // namespace graze::testing
