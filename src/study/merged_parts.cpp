#include "graze/study/merged_parts.hpp"

#include "base/number_ranges.hpp"
#include "graze/study/elsewhere.hpp"
#include "graze/study/study_part.hpp"
#include "study/stored_progress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace graze {

namespace {

/// The points of a run in one part, one after the other.
class PartPoints {
public:
    PartPoints(const ResultFile& file, const std::string& run) : next_(file.points(run)) {}

    /// The point of this number, or none. Numbers must not decrease from call to call.
    std::optional<PointRecord> at(std::size_t number) {
        while (!ended_ && (!point_ || point_->number < number)) {
            point_ = next_();
            ended_ = !point_;
        }
        return point_ && point_->number == number ? std::exchange(point_, std::nullopt) : std::nullopt;
    }

private:
    std::function<std::optional<PointRecord>()> next_;
    std::optional<PointRecord> point_;
    bool ended_ = false;
};

/// A part that has something of a run.
struct RunOfPart {
    const ResultFile* file;
    RunRecord record;
};

/// How many points of each chain one part has, chain after chain.
class ChainCounts {
public:
    ChainCounts(const ResultFile& file, const std::string& run, std::size_t length)
        : next_(file.point_numbers(run)), number_(next_()), length_(length) {}

    /// The next chain of which it has points; none: there are no more.
    std::optional<std::size_t> chain() const { return number_ ? std::optional(*number_ / length_) : std::nullopt; }
    /// The number of points of that chain from the first one on. Goes on to the next chain.
    std::size_t count() {
        const std::size_t chain = *number_ / length_;
        std::size_t count = 0;
        for (; number_ && *number_ / length_ == chain; number_ = next_())
            count += *number_ % length_ == count ? 1 : 0; // others lack those before them
        return count;
    }

private:
    std::function<std::optional<std::size_t>()> next_;
    std::optional<std::size_t> number_;
    std::size_t length_;
};

/// Where the points of a chain are.
struct ChainSource {
    std::size_t chain = 0, part = 0, points = 0; ///< how many points the part has of it, from the first one on
};

/// Gives, chain after chain, the part that has most of its points.
class ChainSources {
public:
    ChainSources(const std::vector<RunOfPart>& parts, const PartedRun& run) {
        for (const RunOfPart& part : parts) {
            counts_.emplace_back(*part.file, part.record.name, run.chain_length());
            wait_for_chain(counts_.size() - 1);
        }
    }

    std::optional<ChainSource> next() {
        if (waiting_.empty())
            return std::nullopt;
        ChainSource source{waiting_.begin()->first, 0, 0};
        while (!waiting_.empty() && waiting_.begin()->first == source.chain) {
            const std::size_t part = waiting_.begin()->second;
            waiting_.erase(waiting_.begin());
            if (const std::size_t points = counts_[part].count(); points > source.points)
                source = {source.chain, part, points};
            wait_for_chain(part);
        }
        return source;
    }

private:
    void wait_for_chain(std::size_t part) {
        if (const auto chain = counts_[part].chain())
            waiting_.emplace(*chain, part);
    }

    std::vector<ChainCounts> counts_;
    std::set<std::pair<std::size_t, std::size_t>> waiting_; ///< the next chain of each part, and the part
};

class Merger {
public:
    explicit Merger(const std::vector<ResultFile>& parts) : parts_(&parts) {}

    Elsewhere elsewhere() {
        Elsewhere from;
        from.points = [this](const AskedPoints& asked, const PointSink& sink) { return give_points(asked, sink); };
        from.results = [this](const AskedResults& asked) { return results(asked); };
        return from;
    }

    /// Files whose runs are not those that were asked for.
    std::vector<std::string> strangers() const {
        std::vector<std::string> all;
        for (const auto& [file, runs] : strangers_)
            all.push_back(
                fmt::format("{}: of another study, model or version of graze: {}", file, fmt::join(runs, ", ")));
        return all;
    }

private:
    /// The parts that have something of a run.
    std::vector<RunOfPart> with_run(const std::string& name, const std::string& fingerprint) {
        std::vector<RunOfPart> having;
        for (const ResultFile& part : *parts_) {
            auto run = part.find_run(name);
            if (!run)
                continue;
            if (run->fingerprint == fingerprint)
                having.push_back({&part, std::move(*run)});
            else
                strangers_[part.path()].insert(name);
        }
        return having;
    }

    bool give_points(const AskedPoints& asked, const PointSink& sink) {
        const std::string& name = asked.run.run().name;
        const std::vector<RunOfPart> parts = with_run(name, asked.fingerprint);
        ChainSources sources(parts, asked.run);
        std::vector<PartPoints> points;
        for (const RunOfPart& part : parts)
            points.emplace_back(*part.file, name);
        const std::size_t length = asked.run.chain_length();
        for (auto source = sources.next(); source && source->chain < asked.run.chains(); source = sources.next()) {
            for (std::size_t index = asked.known.done(source->chain, length); index < source->points; ++index) {
                auto point = points[source->part].at(source->chain * length + index);
                if (!point)
                    break; // the file has changed meanwhile
                sink(point->number, point->result);
                if (asked.interrupted && asked.interrupted())
                    return false;
            }
        }
        for (const RunOfPart& part : parts)
            if (part.record.status == RunStatus::failed)
                throw failure_of(part.record);
        return true;
    }

    std::optional<ResultFile> results(const AskedResults& asked) {
        for (const RunOfPart& part : with_run(asked.run.name, asked.fingerprint))
            if (part.record.status != RunStatus::unfinished)
                return *part.file;
        return std::nullopt;
    }

    const std::vector<ResultFile>* parts_;
    std::map<std::string, std::set<std::string>> strangers_; ///< names of runs, by files
};

/// Which parts of each division are not there, or have not ended.
std::vector<std::string> missing_parts(const std::vector<ResultFile>& parts) {
    std::map<std::size_t, std::map<std::size_t, bool>> divisions; // whether it has ended, by number
    for (const ResultFile& file : parts)
        if (const auto part = part_in(file)) {
            bool& ended = divisions[part->count][part->number];
            ended = ended || has_ended(file);
        }
    std::vector<std::string> sentences;
    for (const auto& [count, found] : divisions) {
        std::vector<std::size_t> absent, unfinished;
        for (std::size_t number = 1; number <= count; ++number)
            if (const auto one = found.find(number); one == found.end())
                absent.push_back(number);
            else if (!one->second)
                unfinished.push_back(number);
        if (!absent.empty())
            sentences.push_back(fmt::format("not there: part {} of {}", number_ranges(absent), count));
        if (!unfinished.empty())
            sentences.push_back(fmt::format("not ended: part {} of {}", number_ranges(unfinished), count));
    }
    return sentences;
}

} // namespace

MergedParts merge_parts(const Study& study, const std::vector<ResultFile>& parts, ResultFile& file,
                        const RunnerOptions& options) {
    Merger merger(parts);
    MergedParts merged;
    merged.reports = run_study(study, file, options, merger.elsewhere());
    if (std::ranges::none_of(merged.reports,
                             [](const RunReport& report) { return report.outcome == RunOutcome::partial; }))
        return merged;
    const std::vector<std::string> later = waiting_runs(study, nullptr), waiting = waiting_runs(study, &file);
    const auto is_in = [](const std::vector<std::string>& runs, const std::string& name) {
        return std::ranges::find(runs, name) != runs.end();
    };
    const auto is_begun = [&](const std::string& run) {
        return std::ranges::any_of(parts, [&](const ResultFile& part) { return part.find_run(run).has_value(); });
    };
    bool lacks_points = false;
    for (const RunReport& report : merged.reports) {
        if (report.outcome != RunOutcome::partial)
            continue;
        const std::string& name = report.name;
        const std::size_t points = points_of(*study.find_run(name));
        if (is_in(waiting, name))
            merged.missing.push_back(fmt::format("run '{}' can begin when the runs that it needs are complete", name));
        else if (is_in(later, name) && !is_begun(name))
            merged.missing.push_back(
                fmt::format("run '{}' can begin now that the runs that it needs are complete: compute the parts again, "
                            "then merge them again",
                            name));
        else {
            lacks_points = true;
            merged.missing.push_back(fmt::format("run '{}': {} of {} points are missing", name,
                                                 points - std::min(points, file.point_count(name)), points));
        }
    }
    for (const auto& sentences : {lacks_points ? missing_parts(parts) : std::vector<std::string>(), merger.strangers()})
        merged.missing.insert(merged.missing.end(), sentences.begin(), sentences.end());
    return merged;
}

} // namespace graze
