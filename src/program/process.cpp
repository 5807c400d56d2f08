#include "program/process.hpp"

#include "graze/base/input_error.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

extern char** environ; // NOLINT(readability-redundant-declaration)

namespace graze {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail_temporary() {
    throw InputError(std::string("no temporary file can be written: ") + std::strerror(errno),
                     "make room where the system keeps temporary files");
}

/// A temporary file for a stream of the child. With pipes parent and child could wait for each other.
File temporary_file() {
    File file(std::tmpfile(), &std::fclose);
    if (!file)
        fail_temporary();
    return file;
}

class FileActions {
public:
    FileActions() { posix_spawn_file_actions_init(&actions_); }
    ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;
    void redirect(std::FILE* from, int to) { posix_spawn_file_actions_adddup2(&actions_, fileno(from), to); }
    const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_{};
};

std::string contents_of_file(std::FILE* file) {
    std::string text;
    std::rewind(file);
    char block[4096];
    while (const std::size_t count = std::fread(block, 1, sizeof block, file))
        text.append(block, count);
    return text;
}

} // namespace

std::optional<std::string> find_program(std::string_view name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::string candidate = (folder.empty() ? "." : folder) + '/' + std::string(name);
        if (access(candidate.c_str(), X_OK) == 0)
            return candidate;
    }
    return std::nullopt;
}

ProcessResult run_process(const std::vector<std::string>& arguments, std::string_view input) {
    const File in = temporary_file();
    const File out = temporary_file();
    if (std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() || std::fflush(in.get()) != 0)
        fail_temporary();
    std::rewind(in.get());
    FileActions actions;
    actions.redirect(in.get(), STDIN_FILENO);
    actions.redirect(out.get(), STDOUT_FILENO);
    actions.redirect(out.get(), STDERR_FILENO);
    std::vector<char*> pointers;
    for (const std::string& argument : arguments)
        pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    pid_t child = 0;
    const int failure =
        posix_spawn(&child, arguments.front().c_str(), actions.get(), nullptr, pointers.data(), environ);
    if (failure != 0)
        throw std::system_error(failure, std::generic_category(), "'" + arguments.front() + "' cannot be started");
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "lost sight of '" + arguments.front() + "'");
    ProcessResult result;
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.output = contents_of_file(out.get());
    return result;
}

} // namespace graze
