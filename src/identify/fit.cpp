#include "graze/identify/fit.hpp"

#include "base/enumerator_name.hpp"
#include "base/median.hpp"
#include "graze/base/input_error.hpp"
#include "identify/fit_callbacks.hpp"
#include "identify/fit_findings.hpp"
#include "identify/fit_initialisation.hpp"
#include "identify/fit_solver.hpp"
#include "identify/fit_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Final weight of gaps between pieces. Gaps are then about 1e-6 of the readings' noise; with a larger weight, steps
/// along the curved set of joined motions would have to be shorter.
constexpr double last_joint = 3e3;

/// A remaining step below this part of the standard errors is negligible.
constexpr double negligible_step = 0.01;

/// Returns the stages of a fit, with increasing weight of the gaps between pieces.
std::vector<FitStage> stages_of(const FitRows& rows, const FitSettings& settings) {
    constexpr int few = 30;
    const bool joined = std::any_of(rows.layout.pieces.begin(), rows.layout.pieces.end(),
                                    [](const FitPiece& piece) { return piece.has_next; });
    std::vector<FitStage> stages;
    for (const double joint : {1.0, 30.0, 100.0, 300.0, 1e3})
        if (joined)
            stages.push_back(
                {.joint = joint, .most_iterations = std::min(few, settings.most_iterations), .tolerance = 1e-8});
    stages.push_back({.joint = last_joint, .most_iterations = settings.most_iterations});
    return stages;
}

bool is_settled(const std::vector<double>& noise, const std::vector<double>& before, const FitRows& rows) {
    constexpr double enough = 0.01, negligible = 1e-9;
    for (std::size_t o = 0; o < noise.size(); ++o)
        if (std::abs(noise[o] - before[o]) > enough * before[o] && noise[o] + before[o] > negligible * rows.range(o))
            return false;
    return true;
}

/// Describes the length of the records, which reveals a wrong unit of time.
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

    /// Runs the fit. If it does not converge, `detail` also names the channels that do not match, as far as known.
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
            fit.detail +=
                compared_ ? "; what was compared by then matches"
                          : "; no motion had been computed by then that could be compared: " + extent_of(rows_.task());
        return fit;
    }

private:
    static constexpr const char* ended_early = "the fit was ended before it had converged";

    Fit run_to_the_end() {
        require_noise();
        Fit fit;
        const Solution best = best_solution(fit);
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

    /// A solution that a pass of the fit has reached.
    struct Solution {
        FitLayout layout;
        std::vector<double> noise;
        FitPoint point;
        StageReport report;
        std::vector<PieceRows> known;
        /// Negative log-likelihood; infinite if its pieces do not join.
        double negative_log_likelihood = std::numeric_limits<double>::infinity();
        std::size_t contacts = 0;
        bool exact = false, noise_alone = false; ///< residuals are round-off; residuals are random noise
        bool settled = false;                    ///< it is a local minimum
    };

    /// Among solutions that fit equally well, chooses one whose signs are those of the guesses; the others are
    /// reported.
    Fit chosen(const Solution& solution, Fit fit) {
        const std::vector<FoundSolution> solutions = alternative_solutions(rows_, solution.point, solution.known, fit);
        std::vector<double> shared;
        for (const FittedNumber& number : fit.numbers)
            shared.push_back(number.estimate.value);
        const std::size_t changed_signs = changed_signs_of(rows_.task(), shared);
        for (const FoundSolution& other : solutions)
            if (other.changed_signs < changed_signs)
                return moved_to(other, std::move(fit));
        for (const FoundSolution& other : solutions)
            if (other.changed_signs == changed_signs)
                fit.alternatives.push_back(other.solution);
        return fit;
    }
    Fit moved_to(const FoundSolution& other, Fit before) {
        point_ = other.point;
        for (std::size_t k = 0; k < pieces().size(); ++k)
            pieces()[k].mode = other.modes[k];
        Fit fit;
        fit.iterations = before.iterations;
        const StageReport report =
            make({.joint = last_joint, .most_iterations = settings_->most_iterations}, 0, 1, fit);
        const Solution solution = solution_here(report);
        if (!unreadable(rows_, solution.known).empty())
            return before;
        describe(rows_, solution.point, solution.known, last_joint, fit);
        judge(report, check_point(rows_, solution.point, solution.known, last_joint), fit);
        return fit.ending == before.ending ? chosen(solution, std::move(fit)) : before;
    }

    void require_noise() const {
        constexpr double most = 1e12; // beyond this, squared residuals lose their digits
        for (std::size_t o = 0; o < rows_.task().outputs.size(); ++o)
            if (const MeasuredOutput& output = rows_.task().outputs[o];
                output.noise > 0 && !(output.noise <= most * rows_.range(o) && output.noise >= rows_.range(o) / most))
                throw InputError(
                    fmt::format("the noise {} of '{}' is out of proportion: its readings have a range of {:.6g}",
                                output.noise, output.name, rows_.range(o)),
                    "give the standard deviation of its readings");
    }

    Solution solution_here(const StageReport& report) {
        Solution solution{rows_.layout, rows_.noise, point_, report, rows_.evaluate(point_)};
        note_mismatch(solution.known);
        for (const PieceRows& piece : solution.known)
            solution.contacts += piece.contacts;
        if (report.interrupted || !unreadable(rows_, solution.known).empty())
            return solution;
        const FitChecks checks = check_point(rows_, point_, solution.known, last_joint);
        if (!checks.joined())
            return solution;
        solution.settled = report.least || checks.remaining_step <= negligible_step;
        solution.negative_log_likelihood = negative_log_likelihood(rows_, solution.known);
        solution.exact = is_exact(rows_, solution.known);
        Fit trial;
        describe(rows_, point_, solution.known, last_joint, trial);
        solution.noise_alone = true;
        for (std::size_t o = 0; o < trial.outputs.size(); ++o)
            solution.noise_alone = solution.noise_alone && !is_structured(trial.outputs[o], o);
        return solution;
    }

    /// Repeats the fit from its result, alternately by prediction and by readings and with other piece lengths, until
    /// the best solution is found again. A slow contact that was missed, or created by noise, is a local minimum from
    /// which small steps do not escape.
    Solution best_solution(Fit& fit) {
        constexpr int most_passes = 8;
        constexpr double same = 0.01, one_error = 0.5; // of log-likelihoods
        Solution best = solution_here(pass(false, fit));
        const double usual = usual_length();
        // If not even unjoined pieces reproduce the readings, no initialisation can help.
        constexpr double hopeless = 0.2; // of the range of the readings
        const bool is_hopeless = greatest_mismatch_ > hopeless;
        bool again = !is_hopeless && (best.contacts > 0 || !best.noise_alone);
        for (int round = 1; again && round < most_passes && !best.exact && !best.report.interrupted; ++round) {
            restore(best);
            if (round > 1)
                cut_anew(usual * (round < 4 ? 0.7 : round < 6 ? 0.5 : 1.4));
            Solution other = solution_here(pass(round % 2 == 1, fit));
            if (other.report.interrupted)
                return other;
            const double better = best.negative_log_likelihood - other.negative_log_likelihood;
            again = !(std::abs(better) <= same) || (best.contacts > 0 && !best.noise_alone);
            const double enough = best.settled == other.settled ? 0 : best.settled ? one_error : -one_error;
            if (better > enough)
                best = std::move(other);
        }
        restore(best);
        if (best.report.interrupted || best.exact || !descend(true, best.report, fit))
            return best;
        return solution_here(best.report);
    }

    /// Continues with exactly joined motions if the nearly joined pieces have not converged, because their gaps allow
    /// only short steps. @return whether that was necessary
    bool descend(bool probe, StageReport& report, Fit& fit) {
        const std::vector<PieceRows> known = rows_.evaluate(point_);
        if (!unreadable(rows_, known).empty())
            return false;
        const FitChecks checks = check_point(rows_, point_, known, last_joint);
        if (!checks.joined() || checks.remaining_step <= negligible_step)
            return false;
        const int before = fit.iterations;
        const DescentReport descent = descend_joined(
            rows_, point_, last_joint, probe, [&](double cost) { return tell(0, 1, ++fit.iterations - before, cost); });
        report.least = descent.least;
        report.interrupted = report.interrupted || descent.interrupted;
        merge_constrained(rows_, point_);
        return true;
    }

    /// One pass of the fit: initialisation, then stages with increasing weight of the gaps.
    StageReport pass(bool by_prediction, Fit& fit) {
        const std::vector<FitStage> stages = stages_of(rows_, *settings_);
        const int count = static_cast<int>(stages.size());
        const FitMinimiser minimiser = [&](const FitStage& stage) { return make(stage, 0, count + 1, fit); };
        StageReport report = by_prediction ? initialise_by_prediction(rows_, point_, minimiser)
                                           : initialise_by_readings(rows_, point_, minimiser);
        for (int s = by_prediction ? 2 : 0; s + 1 < count && !report.interrupted; ++s) {
            FitStage stage = stages[static_cast<std::size_t>(s)];
            stage.prior = s == 0 ? prior_weight(rows_) : 0;
            report = make(stage, s + 1, count + 1, fit);
            merge_constrained(rows_, point_);
            update_modes(rows_, point_);
            if (!report.interrupted)
                rows_.noise = noise_here();
        }
        // Repeat as long as the fit changes the weights of outputs or the modes of pieces.
        constexpr int most_rounds = 8;
        for (int round = 0; round < most_rounds && !report.interrupted; ++round) {
            report = make(stages.back(), count, count + 1, fit);
            const std::vector<double> before = rows_.noise;
            if (report.interrupted || report.failed)
                break;
            // At a bound steps are cut short: hold these parameters and let the other numbers converge.
            FitStage bounded = stages.back();
            bounded.held = parameters_at_bounds(rows_, point_);
            if (!bounded.held.empty())
                report = make(bounded, count, count + 1, fit);
            const bool merged = merge_constrained(rows_, point_), switched = update_modes(rows_, point_) || merged;
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

    /// Cuts the records at other times, since a contact near the end of a piece may have been missed.
    void cut_anew(double length) {
        FitSettings settings = *settings_;
        std::vector<Eigen::VectorXd> first_states;
        for (std::size_t k = 0; k < pieces().size(); ++k)
            if (pieces()[k].is_first)
                first_states.push_back(point_.states[k]);
        settings.piece = length;
        pieces() = cut_records(rows_.system(), rows_.task(), settings);
        point_.states.clear();
        for (const FitPiece& piece : pieces())
            point_.states.push_back(piece.is_first
                                        ? first_states[piece.record]
                                        : Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows_.layout.states)));
    }

    bool is_structured(const FittedOutput& output, std::size_t number) const {
        constexpr double round_off = 1e-9;
        return !output.independent && output.deviation > round_off * rows_.range(number);
    }

    void restore(const Solution& solution) {
        rows_.layout = solution.layout;
        rows_.noise = solution.noise;
        point_ = solution.point;
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
        const auto readings = static_cast<double>(std::max<std::size_t>(1, readings_of(rows_.task())));
        return !settings_->progress || settings_->progress({stage, stages, iteration, std::sqrt(2 * cost / readings)});
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
            return end(
                FitEnding::undetermined,
                fmt::format("the readings do not determine all numbers: they do not depend on {}; give some of these, "
                            "or record what depends on them",
                            fit.free.front().text));
        if (!is_least(report, checks, fit))
            return end(FitEnding::unfinished,
                       fmt::format("it has not converged after {} iterations: begin from other guesses, bound "
                                   "parameters, or cut other pieces",
                                   fit.iterations));
        for (std::size_t o = 0; o < fit.outputs.size(); ++o)
            if (is_structured(fit.outputs[o], o))
                return end(
                    FitEnding::misfit,
                    fmt::format(
                        "the residuals of '{}' are not random noise (neighbours have a correlation of {:.2g}): the "
                        "model lacks something, or a contact is missed, and true errors are larger than stated",
                        fit.outputs[o].name, fit.outputs[o].correlation));
        end(FitEnding::converged, {});
    }

    /// Whether a point is accepted as the minimum. Where a contact too slow to be told from noise passes a reading, the
    /// sum of squares has a step and its minimum can lie at the edge of the step, with a nonzero gradient. The
    /// remaining step there is included in the errors.
    static bool is_least(const StageReport& report, const FitChecks& checks, const Fit& fit) {
        constexpr double at_edge = 0.3; // of standard errors
        const bool contacts = std::any_of(fit.records.begin(), fit.records.end(),
                                          [](const FittedRecord& record) { return record.contacts > 0; });
        const bool stopped = report.converged || report.gained * fit.freedom <= negligible_step * report.cost;
        return checks.bounds_hold && (checks.remaining_step <= negligible_step ||
                                      (contacts && (report.least || (stopped && checks.remaining_step <= at_edge))));
    }

    const FitSettings* settings_;
    FitRows rows_;
    FitPoint point_;
    bool compared_ = false;        ///< the model gives finite values for all readings
    std::string mismatch_;         ///< mismatch found at the last evaluation of all pieces
    double greatest_mismatch_ = 0; ///< its size, relative to the range of the readings
};

Fit fit_unless_interrupted(const System& system, const FitTask& task, const FitSettings& settings) {
    try {
        return Fitter(system, task, settings).run();
    } catch (const FitInterruption&) { // interrupted before the starting point was complete
        return {.ending = FitEnding::interrupted,
                .detail = "the fit was ended before the first motions were known: " + extent_of(task)};
    }
}

} // namespace

const std::vector<std::string>& names_of_losses() {
    static const std::vector<std::string> names{"squares", "huber", "cauchy"};
    return names;
}

std::string_view name_of(FitEnding ending) {
    static constexpr std::string_view names[]{"converged", "unfinished",   "interrupted", "apart",
                                              "broken",    "undetermined", "misfit"};
    return enumerator_name(names, ending, "");
}

Fit fit_model(const System& system, const FitTask& task, const FitSettings& settings) {
    require_task(system, task, settings);
    FitCallbacks callbacks(settings);
    Fit fit = fit_unless_interrupted(system, task, callbacks.settings());
    callbacks.rethrow();
    return fit;
}

} // namespace graze
