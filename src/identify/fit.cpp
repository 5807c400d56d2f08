#include "graze/identify/fit.hpp"

#include "base/median.hpp"
#include "graze/base/input_error.hpp"
#include "identify/fit_beginning.hpp"
#include "identify/fit_callbacks.hpp"
#include "identify/fit_findings.hpp"
#include "identify/fit_mismatch.hpp"
#include "identify/fit_solver.hpp"
#include "identify/fit_start.hpp"
#include "identify/fit_twins.hpp"
#include "identify/joined_descent.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// Gaps are then some millionth of what readings are off; the larger it is, the shorter steps have to be along the
/// curved set of motions that join.
constexpr double last_joint = 3e3;

/// A further step that would change numbers by so little of their errors makes no difference.
constexpr double smooth = 0.01;

/// Pieces join more and more.
std::vector<FitStage> stages_of(const FitRows& rows, const FitSettings& settings) {
    constexpr int few = 30;
    const bool joined = std::any_of(rows.layout.pieces.begin(), rows.layout.pieces.end(),
                                    [](const FitPiece& piece) { return piece.leads; });
    FitStage last;
    last.joint = last_joint;
    last.most_iterations = settings.most_iterations;
    if (!joined)
        return {last};
    std::vector<FitStage> stages;
    for (const double joint : {1.0, 30.0, 100.0, 300.0, 1e3}) {
        FitStage stage;
        stage.joint = joint;
        stage.tolerance = 1e-8;
        stage.most_iterations = std::min(few, settings.most_iterations);
        stages.push_back(stage);
    }
    stages.push_back(last);
    return stages;
}

bool is_settled(const std::vector<double>& noise, const std::vector<double>& before, const FitRows& rows) {
    constexpr double enough = 0.01, nothing = 1e-9;
    for (std::size_t o = 0; o < noise.size(); ++o)
        if (std::abs(noise[o] - before[o]) > enough * before[o] && noise[o] + before[o] > nothing * rows.range(o))
            return false;
    return true;
}

/// In which a wrong unit of the times shows, where nothing could be compared.
std::string extent_of(const FitTask& task) {
    double length = 0;
    for (const FitRecord& record : task.records)
        if (!record.times.empty())
            length = std::max(length, record.times.back() - record.times.front());
    return fmt::format("a record lasts {:.4g} of the model's time; look at the unit of its times", length);
}

class Fitter {
public:
    Fitter(const System& system, const FitTask& task, const FitSettings& settings)
        : settings_(&settings), rows_(system, task, settings) {
        rows_.layout.pieces = cut_records(system, task, settings);
        point_ = starting_point(rows_);
    }

    /// An ending that is no result tells what does not match, as far as that was computed.
    Fit run() {
        Fit fit;
        try {
            fit = run_to_the_end();
        } catch (const FitInterruption&) {
            fit.ending = FitEnding::interrupted;
            fit.detail = ended_early;
        }
        if (fit.ending != FitEnding::converged && !mismatch_.empty())
            fit.detail += "; " + mismatch_;
        else if (fit.ending == FitEnding::interrupted)
            fit.detail += compared_
                              ? "; what was compared by then matches"
                              : "; no motion was known by then that could be compared: " + extent_of(rows_.task());
        return fit;
    }

private:
    static constexpr const char* ended_early = "the fit was ended before it had converged";

    Fit run_to_the_end() {
        require_noise();
        Fit fit;
        const Way best = best_way(fit);
        rows_.layout = best.layout;
        rows_.noise = best.noise;
        if (const std::string broken = unreadable(rows_, best.known); !broken.empty()) {
            fit.ending = best.report.interrupted ? FitEnding::interrupted : FitEnding::broken;
            fit.detail = best.report.interrupted ? ended_early : broken;
            return fit;
        }
        describe(rows_, best.point, best.known, last_joint, fit);
        judge(best.report, check_point(rows_, best.point, best.known, last_joint), fit);
        if (fit.ending != FitEnding::converged && fit.ending != FitEnding::misfit)
            return fit;
        return chosen(best, std::move(fit));
    }

    /// Where a fit has come to.
    struct Way {
        FitLayout layout;
        std::vector<double> noise;
        FitPoint point;
        StageReport report;
        std::vector<PieceRows> known;
        double unlikelihood = std::numeric_limits<double>::infinity(); ///< if it is a motion at all
        std::size_t contacts = 0;
        bool exact = false, noise_alone = false; ///< what is left: nothing; nothing but noise
        bool settled = false;                    ///< nothing beside it is better
    };

    /// Of solutions that meet the readings as well, one whose signs are those of the guesses.
    Fit chosen(const Way& way, Fit fit) {
        const std::vector<FoundTwin> twins = twins_of(rows_, way.point, way.known, fit);
        std::vector<double> shared;
        for (const FittedNumber& number : fit.numbers)
            shared.push_back(number.estimate.value);
        const std::size_t strays = strays_of(rows_.task(), shared);
        for (const FoundTwin& twin : twins)
            if (twin.strays < strays)
                return moved_to(twin, std::move(fit));
        for (const FoundTwin& twin : twins)
            if (twin.strays == strays)
                fit.twins.push_back(twin.twin);
        return fit;
    }
    Fit moved_to(const FoundTwin& twin, Fit before) {
        point_ = twin.point;
        for (std::size_t k = 0; k < pieces().size(); ++k)
            pieces()[k].mode = twin.modes[k];
        FitStage stage;
        stage.joint = last_joint;
        stage.most_iterations = settings_->most_iterations;
        Fit fit;
        fit.iterations = before.iterations;
        const StageReport report = make(stage, 0, 1, fit);
        const Way way = way_here(report);
        if (!unreadable(rows_, way.known).empty())
            return before;
        describe(rows_, way.point, way.known, last_joint, fit);
        judge(report, check_point(rows_, way.point, way.known, last_joint), fit);
        return fit.ending == before.ending ? chosen(way, std::move(fit)) : before;
    }

    void require_noise() const {
        constexpr double most = 1e12; // beyond, squares of what is left lose their digits
        for (std::size_t o = 0; o < rows_.task().outputs.size(); ++o)
            if (const MeasuredOutput& output = rows_.task().outputs[o];
                output.noise > 0 && !(output.noise <= most * rows_.range(o) && output.noise >= rows_.range(o) / most))
                throw InputError(
                    fmt::format("the noise {} of '{}' is out of proportion: its readings have a range of {:.6g}",
                                output.noise, output.name, rows_.range(o)),
                    "give the standard deviation of its readings");
    }

    Way way_here(const StageReport& report) {
        Way way{rows_.layout, rows_.noise, point_, report, rows_.evaluate(point_)};
        note_mismatch(way.known);
        for (const PieceRows& piece : way.known)
            way.contacts += piece.contacts;
        if (report.interrupted || !unreadable(rows_, way.known).empty())
            return way;
        const FitChecks checks = check_point(rows_, point_, way.known, last_joint);
        if (!checks.joined())
            return way;
        way.settled = report.least || checks.off <= smooth;
        way.unlikelihood = unlikelihood_of(rows_, way.known);
        way.exact = is_exact(rows_, way.known);
        Fit trial;
        describe(rows_, point_, way.known, last_joint, trial);
        way.noise_alone = true;
        for (std::size_t o = 0; o < trial.outputs.size(); ++o)
            way.noise_alone = way.noise_alone && !is_no_noise(trial.outputs[o], o);
        return way;
    }

    /// A slow contact that is missed, or was made out of noise, is a way from which small steps do not lead back. So
    /// one begins again with what was found, elsewhere and otherwise, until the best is found a second time.
    Way best_way(Fit& fit) {
        constexpr int most_passes = 8;
        constexpr double same = 0.01, one_error = 0.5; // of logarithms of likelihoods
        Way best = way_here(pass(false, fit));
        const double usual = usual_length();
        // Of what not even free pieces come near no beginning makes a fit.
        constexpr double hopeless = 0.2; // of the range
        const bool is_hopeless = greatest_mismatch_ > hopeless;
        bool again = !is_hopeless && (best.contacts > 0 || !best.noise_alone);
        for (int round = 1; again && round < most_passes && !best.exact && !best.report.interrupted; ++round) {
            restore(best);
            if (round > 1)
                cut_anew(usual * (round < 4 ? 0.7 : round < 6 ? 0.5 : 1.4));
            Way other = way_here(pass(round % 2 == 1, fit));
            if (other.report.interrupted)
                return other;
            const double better = best.unlikelihood - other.unlikelihood;
            again = !(std::abs(better) <= same) || (best.contacts > 0 && !best.noise_alone);
            const double enough = best.settled == other.settled ? 0 : best.settled ? one_error : -one_error;
            if (better > enough)
                best = std::move(other);
        }
        restore(best);
        if (best.report.interrupted || best.exact || !descend(true, best.report, fit))
            return best;
        return way_here(best.report);
    }

    /// Where steps of pieces that hardly give way have come to no end: those of motions that join. @return whether
    /// there was need
    bool descend(bool look, StageReport& report, Fit& fit) {
        const std::vector<PieceRows> known = rows_.evaluate(point_);
        if (!unreadable(rows_, known).empty())
            return false;
        const FitChecks checks = check_point(rows_, point_, known, last_joint);
        if (!checks.joined() || checks.off <= smooth)
            return false;
        const int before = fit.iterations;
        const DescentReport descent = descend_joined(
            rows_, point_, last_joint, look, [&](double cost) { return tell(0, 1, ++fit.iterations - before, cost); });
        report.least = descent.least;
        report.interrupted = report.interrupted || descent.interrupted;
        merge_bound(rows_, point_);
        return true;
    }

    /// From the first pieces to all of them, and until they join.
    StageReport pass(bool by_prediction, Fit& fit) {
        const std::vector<FitStage> stages = stages_of(rows_, *settings_);
        const int count = static_cast<int>(stages.size());
        FitBeginning beginning(rows_, point_, [&](const FitStage& stage) { return make(stage, 0, count + 1, fit); });
        StageReport report = by_prediction ? beginning.by_prediction() : beginning.by_readings();
        for (int s = by_prediction ? 2 : 0; s + 1 < count && !report.interrupted; ++s) {
            FitStage stage = stages[static_cast<std::size_t>(s)];
            stage.prior = s == 0 ? prior_weight(rows_) : 0;
            report = make(stage, s + 1, count + 1, fit);
            merge_bound(rows_, point_);
            update_modes(rows_, point_);
            if (!report.interrupted)
                rows_.noise = noise_here();
        }
        // Once more where weights or modes have changed by what was found.
        constexpr int most_rounds = 8;
        for (int round = 0; round < most_rounds && !report.interrupted; ++round) {
            report = make(stages.back(), count, count + 1, fit);
            const std::vector<double> before = rows_.noise;
            if (report.interrupted || report.failed)
                break;
            // Steps that end at a bound hide what the other numbers should do.
            FitStage bounded = stages.back();
            bounded.held = bounded_at(rows_, point_);
            if (!bounded.held.empty())
                report = make(bounded, count, count + 1, fit);
            const bool merged = merge_bound(rows_, point_), switched = update_modes(rows_, point_) || merged;
            const std::vector<double> noise = noise_here();
            if (!switched && is_settled(noise, before, rows_))
                break;
            rows_.noise = noise;
        }
        if (!report.interrupted && !report.failed)
            descend(false, report, fit);
        return report;
    }
    std::vector<double> noise_here() {
        const std::vector<PieceRows> known = rows_.evaluate(point_);
        note_mismatch(known);
        return unreadable(rows_, known).empty() ? noise_at(rows_, known) : rows_.noise;
    }
    void note_mismatch(const std::vector<PieceRows>& known) {
        const std::vector<FitMismatch> found = mismatches_of(rows_, known);
        compared_ = unreadable(rows_, known).empty();
        mismatch_ = text_of(found, rows_.task());
        greatest_mismatch_ = found.empty() ? 0 : found.front().size;
    }

    double usual_length() {
        std::vector<double> lengths;
        for (const FitPiece& piece : pieces())
            lengths.push_back(piece.end - piece.begin);
        return median(std::move(lengths));
    }

    /// Pieces whose ends are elsewhere: a contact near one may have been missed.
    void cut_anew(double length) {
        FitSettings settings = *settings_;
        std::vector<Eigen::VectorXd> openings;
        for (std::size_t k = 0; k < pieces().size(); ++k)
            if (pieces()[k].opening)
                openings.push_back(point_.states[k]);
        settings.piece = length;
        pieces() = cut_records(rows_.system(), rows_.task(), settings);
        point_.states.clear();
        for (const FitPiece& piece : pieces())
            point_.states.push_back(piece.opening
                                        ? openings[piece.record]
                                        : Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows_.layout.states)));
    }

    bool is_no_noise(const FittedOutput& output, std::size_t number) const {
        constexpr double round_off = 1e-9;
        return !output.independent && output.deviation > round_off * rows_.range(number);
    }

    void restore(const Way& way) {
        rows_.layout = way.layout;
        rows_.noise = way.noise;
        point_ = way.point;
    }
    std::vector<FitPiece>& pieces() { return rows_.layout.pieces; }

    StageReport make(const FitStage& stage, int number, int count, Fit& fit) {
        const int before = fit.iterations;
        const StageReport report = minimise(rows_, point_, stage, [&](int iteration, double cost, const FitPoint&) {
            return tell(number, count, before + iteration, cost);
        });
        fit.iterations += report.iterations;
        return report;
    }

    bool tell(int stage, int stages, int iteration, double cost) const {
        if (!settings_->progress)
            return true;
        FitProgress progress;
        progress.stage = stage;
        progress.stages = stages;
        progress.iteration = iteration;
        progress.misfit = std::sqrt(2 * cost / static_cast<double>(std::max<std::size_t>(1, readings())));
        return settings_->progress(progress);
    }

    std::size_t readings() const {
        std::size_t count = 0;
        for (const FitRecord& record : rows_.task().records)
            count += record.times.size() * record.readings.size();
        return count;
    }

    void judge(const StageReport& report, const FitChecks& checks, Fit& fit) const {
        fit.gap = checks.gap;
        const auto end = [&](FitEnding ending, std::string detail) {
            fit.ending = ending;
            fit.detail = std::move(detail);
        };
        if (report.interrupted)
            return end(FitEnding::interrupted, ended_early);
        if (!checks.broken.empty())
            return end(FitEnding::broken, checks.broken);
        if (!std::all_of(fit.numbers.begin(), fit.numbers.end(), [](const FittedNumber& number) {
                return std::isfinite(number.estimate.value) && std::isfinite(number.estimate.error);
            }))
            return end(FitEnding::broken, "numbers or their errors are beyond all bounds: choose other units");
        if (!checks.modes_agree || !(checks.gap <= checks.allowed_gap))
            return end(FitEnding::apart,
                       fmt::format("pieces of the motion do not join, by {:.3g} of its size: begin from other guesses, "
                                   "or with shorter pieces",
                                   checks.gap));
        if (!fit.free.empty())
            return end(FitEnding::undetermined,
                       fmt::format("readings do not tell all numbers, for nothing changes with {}: give some of these, "
                                   "or record what tells them",
                                   fit.free.front().text));
        if (!is_least(report, checks, fit))
            return end(FitEnding::unfinished,
                       fmt::format("it has not converged after {} iterations: begin from other guesses, bound "
                                   "parameters, or cut other pieces",
                                   fit.iterations));
        for (std::size_t o = 0; o < fit.outputs.size(); ++o)
            if (is_no_noise(fit.outputs[o], o))
                return end(
                    FitEnding::misfit,
                    fmt::format("what is left of '{}' is no noise (neighbours have a correlation of {:.2g}): the "
                                "model misses something, or a contact is missed, and errors are larger than told",
                                fit.outputs[o].name, fit.outputs[o].correlation));
        end(FitEnding::converged, {});
    }

    /// Where a reading is passed by a contact that is too slow to be told from noise the sum of squares has a step, and
    /// can be least at its edge. The way that is left is part of the errors.
    static bool is_least(const StageReport& report, const FitChecks& checks, const Fit& fit) {
        constexpr double at_edge = 0.3; // of errors
        const bool contacts = std::any_of(fit.records.begin(), fit.records.end(),
                                          [](const FittedRecord& record) { return record.contacts > 0; });
        const bool stopped = report.converged || report.gained * fit.freedom <= smooth * report.cost;
        return checks.held_well &&
               (checks.off <= smooth || (contacts && (report.least || (stopped && checks.off <= at_edge))));
    }

    const FitSettings* settings_;
    FitRows rows_;
    FitPoint point_;
    bool compared_ = false;        ///< all of them could be
    std::string mismatch_;         ///< what did not match when all pieces were last looked at
    double greatest_mismatch_ = 0; ///< relative to the range of the readings
};

} // namespace

const std::vector<std::string>& names_of_losses() {
    static const std::vector<std::string> names{"squares", "huber", "cauchy"};
    return names;
}

std::string_view name_of(FitEnding ending) {
    switch (ending) {
    case FitEnding::converged:
        return "converged";
    case FitEnding::unfinished:
        return "unfinished";
    case FitEnding::interrupted:
        return "interrupted";
    case FitEnding::apart:
        return "apart";
    case FitEnding::broken:
        return "broken";
    case FitEnding::undetermined:
        return "undetermined";
    case FitEnding::misfit:
        return "misfit";
    }
    return "";
}

namespace {

Fit fit_unless_interrupted(const System& system, const FitTask& task, const FitSettings& settings) {
    try {
        return Fitter(system, task, settings).run();
    } catch (const FitInterruption&) { // before there was a point
        Fit fit;
        fit.ending = FitEnding::interrupted;
        fit.detail = "the fit was ended before the first motions were known: " + extent_of(task);
        return fit;
    }
}

} // namespace

Fit fit_model(const System& system, const FitTask& task, const FitSettings& settings) {
    require_task(system, task, settings);
    FitCallbacks callbacks(settings);
    Fit fit = fit_unless_interrupted(system, task, callbacks.settings());
    callbacks.rethrow();
    return fit;
}

} // namespace graze
