#include "program/slurm_jobs.hpp"

#include "base/read_whole.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "program/process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <sstream>

namespace graze {

namespace {

/// Ctrl-C in a terminal is sent to programs that are started, too. While this object exists, none gets it: a job that
/// sbatch has submitted would not be known if sbatch ended before it has printed its number.
class SignalsLater {
public:
    SignalsLater() {
        sigset_t signals;
        sigemptyset(&signals);
        sigaddset(&signals, SIGINT);
        sigaddset(&signals, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &signals, &before_);
    }
    ~SignalsLater() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsLater(const SignalsLater&) = delete;
    SignalsLater& operator=(const SignalsLater&) = delete;

private:
    sigset_t before_{};
};

std::string path_of(const char* program) {
    if (auto path = find_program(program))
        return *path;
    throw InputError({"--slurm", 0, 0}, fmt::format("there is no {} on this machine", program),
                     "use a machine from which SLURM takes jobs, or compute the parts in another way by --part");
}

/// Runs one of SLURM's commands.
ProcessResult run_slurm(std::vector<std::string> words) {
    words.front() = path_of(words.front().c_str());
    return run_process(words, "");
}

/// The task in a line as "123_4 PENDING Resources".
std::optional<std::pair<std::size_t, TaskState>> task_in(const std::string& line) {
    std::istringstream words(line);
    std::string id, reason;
    TaskState task;
    words >> id >> task.state >> std::ws;
    std::getline(words, task.reason);
    std::size_t number = 0;
    const std::size_t mark = id.find('_');
    if (mark == std::string::npos || task.state.empty() || !read_whole(std::string_view(id).substr(mark + 1), number))
        return std::nullopt;
    return std::pair(number, task);
}

/// What a command says, in one line.
std::string said(const std::string& output) {
    std::string text;
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty())
            text += (text.empty() ? "" : " / ") + line;
    constexpr std::size_t most = 300;
    return text.empty() ? "it says nothing" : shortened(text, most);
}

bool is_word(std::string_view text) {
    return std::ranges::all_of(
        text, [](unsigned char c) { return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '-'); });
}

} // namespace

std::string text_of(const SlurmJob& job) {
    return job.cluster.empty() ? job.id : job.id + ';' + job.cluster;
}

std::optional<SlurmJob> slurm_job(std::string_view line) {
    const std::size_t end = std::min(line.find(';'), line.size());
    SlurmJob job{std::string(line.substr(0, end)), std::string(line.substr(std::min(end + 1, line.size())))};
    std::size_t number = 0;
    if (!read_whole(job.id, number) || number == 0 || !is_word(job.cluster))
        return std::nullopt;
    return job;
}

bool TaskState::is_over() const {
    constexpr std::array<std::string_view, 10> ends{"COMPLETED", "CANCELLED", "FAILED",   "TIMEOUT",       "NODE_FAIL",
                                                    "PREEMPTED", "BOOT_FAIL", "DEADLINE", "OUT_OF_MEMORY", "REVOKED"};
    return std::ranges::find(ends, state) != ends.end();
}

bool TaskState::is_waiting() const {
    return state == "PENDING" || state.starts_with("REQUEUE") || state == "SPECIAL_EXIT";
}

std::optional<std::map<std::size_t, TaskState>> task_states(const SlurmJob& job) {
    // All states, whatever the user's SQUEUE_STATES is.
    std::vector<std::string> words{"squeue",       "--noheader",        "--array",
                                   "--states=all", "--format=%i %T %r", "--jobs=" + job.id};
    if (!job.cluster.empty())
        words.push_back("--clusters=" + job.cluster);
    const ProcessResult result = run_slurm(words);
    std::map<std::size_t, TaskState> tasks;
    if (result.status != 0 && result.output.find("Invalid job id") == std::string::npos)
        return std::nullopt;
    std::istringstream lines(result.output);
    for (std::string line; std::getline(lines, line);)
        if (auto task = task_in(line))
            tasks.insert(std::move(*task));
    return tasks;
}

SlurmJob submit_script(const std::string& script, const std::vector<std::string>& options) {
    std::vector<std::string> words{"sbatch", "--parsable"};
    words.insert(words.end(), options.begin(), options.end());
    words.push_back(script);
    const SignalsLater later;
    const ProcessResult result = run_slurm(words);
    std::istringstream lines(result.output);
    for (std::string line; result.status == 0 && std::getline(lines, line);)
        if (auto job = slurm_job(line))
            return *job;
    throw InputError({"--slurm", 0, 0}, "sbatch refuses the jobs: " + said(result.output),
                     fmt::format("options for it stand behind --; the script is {}", script));
}

void require_slurm() {
    path_of("sbatch");
    path_of("squeue");
}

} // namespace graze
