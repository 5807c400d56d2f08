#include "program/slurm.hpp"

#include "base/number_ranges.hpp"
#include "graze/base/input_error.hpp"
#include "graze/study/study_catalogue.hpp"
#include "graze/study/study_part.hpp"
#include "program/interrupt.hpp"
#include "program/merge.hpp"
#include "program/output_file.hpp"
#include "program/slurm_jobs.hpp"
#include "program/slurm_script.hpp"
#include "program/status_line.hpp"
#include "program/study_reports.hpp"
#include "program/values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace graze {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point time) {
    return std::chrono::duration<double>(Clock::now() - time).count();
}

/// One of the parts, and its task.
struct PartTask {
    bool ended = false;
    std::optional<TaskState> task{}; ///< none if SLURM does not know of one

    bool in_queue() const { return task && !task->is_over(); }
    bool waits() const { return task && task->is_waiting(); }
    bool is_left() const { return !ended && !in_queue(); }
    /// The task has ended as it should, and its file does not show it yet: machines that share a folder do not see at
    /// once what another one writes.
    bool comes_late() const { return !ended && task && task->state == "COMPLETED"; }
};

/// The parts of a study that SLURM computes, and the jobs for them, which a file in the folder of the parts keeps.
class SlurmParts {
public:
    SlurmParts(const Study& study, SlurmArray array) : study_(&study), array_(std::move(array)), tasks_(array_.count) {
        read_jobs();
        if (!look())
            throw InputError({"--slurm", 0, 0}, "squeue does not answer, so that it is not known which jobs there are",
                             "try again later");
    }

    /// Asks SLURM, and reads the files of parts that no task writes to. @return false if SLURM does not answer
    bool look() {
        std::vector<PartTask> tasks(array_.count);
        for (const SlurmJob& job : jobs_) {
            const auto states = task_states(job);
            if (!states)
                return false;
            for (const auto& [number, state] : *states)
                if (number >= 1 && number <= tasks.size() && !tasks[number - 1].in_queue())
                    tasks[number - 1].task = state;
        }
        for (std::size_t i = 0; i < tasks.size(); ++i)
            if (!tasks[i].in_queue())
                tasks[i].ended = tasks_[i].ended || has_ended(i + 1);
        tasks_ = std::move(tasks);
        return true;
    }

    template <class Is>
    std::vector<std::size_t> numbers(const Is& is) const {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < tasks_.size(); ++i)
            if (is(tasks_[i]))
                found.push_back(i + 1);
        return found;
    }
    std::vector<std::size_t> left() const {
        return numbers([](const PartTask& one) { return one.is_left(); });
    }
    std::size_t in_queue() const {
        return numbers([](const PartTask& one) { return one.in_queue(); }).size();
    }
    std::size_t ended() const {
        return numbers([](const PartTask& one) { return one.ended; }).size();
    }
    bool some_come_late() const {
        return !numbers([](const PartTask& one) { return one.comes_late(); }).empty();
    }

    std::string ids() const { // for scancel
        std::vector<std::string> texts;
        for (const SlurmJob& job : jobs_)
            texts.push_back(job.id);
        return fmt::format("{}", fmt::join(texts, " "));
    }
    const SlurmArray& array() const { return array_; }

    /// How many parts are where.
    std::string progress() const {
        const std::size_t waiting = numbers([](const PartTask& one) { return one.waits(); }).size();
        std::string text = fmt::format("{} of {} parts have ended, {} run, {} wait", ended(), array_.count,
                                       in_queue() - waiting, waiting);
        const auto first = std::ranges::find_if(tasks_, [](const PartTask& one) { return one.waits(); });
        if (waiting > 0 && waiting == in_queue())
            text += fmt::format(" ({})", first->task->reason);
        if (const std::size_t stopped = left().size(); stopped > 0)
            text += fmt::format(", {} have stopped", stopped);
        return text;
    }

    /// How SLURM has ended the tasks of parts that are left: "TIMEOUT 3-5, FAILED 8".
    std::string ends() const {
        std::map<std::string, std::vector<std::size_t>> by_state;
        for (const std::size_t number : left())
            if (const auto& task = tasks_[number - 1].task)
                by_state[task->state].push_back(number);
        std::vector<std::string> texts;
        for (const auto& [state, numbers] : by_state)
            texts.push_back(fmt::format("{} {}", state, number_ranges(numbers)));
        return fmt::format("{}", fmt::join(texts, ", "));
    }

    /// Submits all parts that are left. @param options of sbatch
    SlurmJob submit(const std::vector<std::string>& options) {
        array_.numbers = left();
        const std::string script = (fs::path(array_.folder) / "slurm.sh").string();
        for (const std::string& path : {script, jobs_file()})
            require_inside(path, array_.folder);
        write_file(script, slurm_script(array_));
        std::erase_if(jobs_, [](const SlurmJob& job) { return !is_in_queue(job); });
        jobs_.push_back(submit_script(script, options));
        std::string text;
        for (const SlurmJob& job : jobs_)
            text += text_of(job) + '\n';
        write_file(jobs_file(), text);
        for (const std::size_t number : array_.numbers)
            tasks_[number - 1] = {.task = TaskState{"PENDING", ""}};
        return jobs_.back();
    }

    /// All parts have more to do, since there are more results than when they were computed.
    void begin_again() {
        for (PartTask& one : tasks_)
            one.ended = false;
    }

    std::vector<ResultFile> files() const {
        allow_many_files();
        std::vector<ResultFile> files;
        for (std::size_t number = 1; number <= array_.count; ++number)
            if (auto file = part_file(number))
                files.push_back(std::move(*file));
        return files;
    }

private:
    static bool is_in_queue(const SlurmJob& job) {
        const auto states = task_states(job);
        return !states || std::ranges::any_of(*states, [](const auto& one) { return !one.second.is_over(); });
    }

    std::string jobs_file() const {
        return (fs::path(array_.folder) / fmt::format("slurm-jobs-of-{}", array_.count)).string();
    }

    void read_jobs() {
        std::ifstream lines(jobs_file());
        for (std::string line; std::getline(lines, line);)
            if (auto job = slurm_job(line))
                jobs_.push_back(std::move(*job));
    }

    /// The file of a part that can be read; none if it has not been begun, or was cut off in its first moments.
    std::optional<ResultFile> part_file(std::size_t number) const {
        const std::string path = (fs::path(array_.folder) / file_of_part({number, array_.count})).string();
        if (std::error_code error; !fs::exists(path, error))
            return std::nullopt;
        try {
            ResultFile file(path, ResultFile::Access::read);
            return part_in(file) ? std::optional(std::move(file)) : std::nullopt;
        } catch (const InputError&) {
            return std::nullopt;
        }
    }

    bool has_ended(std::size_t number) const {
        const auto file = part_file(number);
        if (file)
            require_same_values(*study_, *file);
        return file && graze::has_ended(*file);
    }

    const Study* study_;
    SlurmArray array_;
    std::vector<PartTask> tasks_; ///< by number of the part less one
    std::vector<SlurmJob> jobs_;
};

/// The words of a command that computes the study, which mean the same on other machines.
std::vector<std::string> command_for(const std::string& folder, const std::string& file,
                                     const RunArguments& arguments) {
    const std::vector<std::string> shipped = shipped_studies();
    const bool is_shipped = std::ranges::find(shipped, arguments.study) != shipped.end();
    std::vector<std::string> words{fs::read_symlink("/proc/self/exe").string(), "run",
                                   is_shipped ? arguments.study : fs::absolute(arguments.study).string()};
    if (fs::path(file).filename() == "results.sqlite") // otherwise these results are continued, by their own name
        words.insert(words.end(), {"--output", folder});
    for (const std::string& item : split_list(arguments.set))
        words.insert(words.end(),
                     {"--set", item.starts_with('@') ? '@' + fs::absolute(item.substr(1)).string() : item});
    for (const std::string& run : split_list(arguments.only))
        words.insert(words.end(), {"--only", run});
    if (arguments.steps)
        words.emplace_back("--steps");
    return words;
}

/// Waits until no part is in SLURM's queue. @return false when it was interrupted
bool wait_for(SlurmParts& parts, const StudyArguments& arguments, const Console& console) {
    constexpr double patience = 60; // with files that come late
    StatusLine line(console, arguments.progress || console.terminal);
    const auto begun = Clock::now();
    std::optional<Clock::time_point> all_over;
    for (bool answered = true;; answered = parts.look()) {
        if (line.is_due())
            line.show(answered ? parts.progress() : "squeue does not answer; waiting");
        if (answered && parts.in_queue() == 0) {
            all_over = all_over.value_or(Clock::now());
            if (!parts.some_come_late() || seconds_since(*all_over) > patience)
                return true;
        }
        // SLURM's controller serves all users: it is asked less and less often.
        const double pause = all_over ? 1 : std::clamp(seconds_since(begun) / 10, 0.5, 30.0);
        for (const auto from = Clock::now(); seconds_since(from) < pause;) {
            if (InterruptGuard::requested())
                return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    }
}

void submit(SlurmParts& parts, const RunArguments& arguments, const Console& console) {
    const std::size_t others = parts.in_queue();
    const std::vector<std::size_t> left = parts.left();
    const std::string count = fmt::format("{}", parts.array().count);
    if (!left.empty()) {
        const std::string which = left.size() == 1 ? fmt::format("part {} of {}", number_ranges(left), count)
                                  : left.size() == parts.array().count
                                      ? "all " + count + " parts"
                                      : fmt::format("parts {} of {}", number_ranges(left), count);
        const SlurmJob job = parts.submit(arguments.sbatch);
        console.err << fmt::format("graze: job {} of SLURM computes {}{}\n", job.id, which,
                                   parts.ended() > 0 ? fmt::format("; {} ended before", parts.ended()) : "");
    }
    if (others > 0)
        console.err << fmt::format("graze: {} of {} parts are in SLURM's queue already\n", others, count);
}

int told_jobs_go_on(const SlurmParts& parts, const std::string& folder, const Console& console) {
    console.err << fmt::format(
        "graze: interrupted; the jobs go on. The same command waits for them again, graze merge {} puts "
        "together what there is, scancel {} ends the jobs\n",
        shell_word(folder), parts.ids());
    return InterruptGuard::exit_code();
}

int told_what_is_next(const std::string& folder, const std::vector<std::string>& waiting, const Console& console) {
    console.err << fmt::format("graze: when the jobs have ended, type: graze merge {}\n", shell_word(folder));
    if (!waiting.empty())
        console.err << fmt::format("graze: or the same command, which goes on with runs that wait for all parts: {}\n",
                                   fmt::join(waiting, ", "));
    return exit_success;
}

/// Merges what there is. @param before what was missing when all parts had ended before
/// @return the exit code; none if the parts have more to do
std::optional<int> merged(SlurmParts& parts, std::optional<std::vector<std::string>>& before, const Study& study,
                          const std::string& folder, const std::string& path, const RunArguments& arguments,
                          const Console& console) {
    ResultFile file(path, ResultFile::Access::write);
    Study explored = study; // atlases add runs to it
    const MergedParts all = merge_files(explored, parts.files(), split_list(arguments.only), file, arguments, console);
    const std::vector<std::size_t> left = parts.left();
    if (!all.complete() && !is_interrupted(all.reports) && left.empty() && before != all.missing) {
        before = all.missing;
        return std::nullopt;
    }
    const int code = finish_merge(explored, all, file, folder, arguments, console);
    if (!all.complete() && !left.empty())
        console.err << fmt::format("graze: SLURM has ended {}: {}; what they say is in {}; the same command goes on\n",
                                   left.size() == 1 ? "a task" : "tasks", parts.ends(),
                                   messages_of_part(parts.array(), std::to_string(left.front())));
    return code;
}

} // namespace

int run_by_slurm(const Study& study, const std::string& folder, const std::string& file, const RunArguments& arguments,
                 const Console& console) {
    for (const std::string& option : arguments.sbatch)
        if (option.starts_with("--array") || option.starts_with("-a"))
            throw InputError({option, 0, 0}, "the array has one task for each part",
                             "leave it out, and choose the number of parts by --slurm N");
    require_slurm();
    const std::string own = fs::absolute(folder).lexically_normal().string();
    const std::string folder_of_tasks = (fs::path(own) / folder_of_parts).string();
    make_folder(folder_of_tasks, "--output");
    std::vector<std::string> waiting;
    {
        const std::optional<ResultFile> results = earlier_results(study, file);
        waiting = waiting_runs(study, results ? &*results : nullptr);
    } // which closes them: the merge writes to them
    SlurmParts parts(study, {study.name,
                             folder_of_tasks,
                             static_cast<std::size_t>(arguments.slurm),
                             {},
                             command_for(own, file, arguments)});
    std::optional<std::vector<std::string>> missing;
    for (;;) {
        submit(parts, arguments, console);
        if (parts.in_queue() > 0 && arguments.no_wait)
            return told_what_is_next(folder, waiting, console);
        if (!wait_for(parts, arguments, console))
            return told_jobs_go_on(parts, folder, console);
        if (const auto code = merged(parts, missing, study, folder, file, arguments, console))
            return *code;
        parts.begin_again();
    }
}

} // namespace graze
