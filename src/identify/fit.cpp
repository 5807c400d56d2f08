#include "graze/identify/fit.hpp"

#include "graze/symbolic/input_error.hpp"
#include "identify/fit_findings.hpp"
#include "identify/fit_solver.hpp"
#include "identify/fit_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace graze {

namespace {

/// Gaps are then some millionth of what readings are off; the larger it is, the shorter steps have to be along the
/// curved set of motions that join.
constexpr double last_joint = 3e3;

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

class Fitter {
public:
    Fitter(const System& system, const FitTask& task, const FitSettings& settings)
        : settings_(&settings), rows_(system, task, settings) {
        rows_.layout.pieces = cut_records(system, task, settings);
        point_ = starting_point(rows_);
    }

    Fit run() {
        require_noise();
        Fit fit;
        StageReport report = pass(fit);
        // What is left is no noise: contacts may be missing, which the parameters that were found let appear.
        constexpr int most_passes = 4;
        constexpr double better = 0.95;
        for (int round = 1; round < most_passes && !report.interrupted && leaves_more_than_noise(); ++round) {
            const FitLayout layout = rows_.layout;
            const std::vector<double> noise = rows_.noise;
            const FitPoint point = point_;
            const double before = squares_at(rows_, point_);
            cut_anew(round);
            report = pass(fit);
            if (const double after = squares_at(rows_, point_); after < better * before)
                continue;
            else if (!(after <= before) && !report.interrupted)
                restore(layout, noise, point);
            break;
        }
        if (const std::string broken = unreadable(rows_, point_); !broken.empty()) {
            fit.ending = report.interrupted ? FitEnding::interrupted : FitEnding::broken;
            fit.detail = broken;
            return fit;
        }
        describe(rows_, point_, last_joint, fit);
        judge(report, check_point(rows_, point_, last_joint), fit);
        return fit;
    }

private:
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

    /// From the first pieces to all of them, and until they join.
    StageReport pass(Fit& fit) {
        const std::vector<FitStage> stages = stages_of(rows_, *settings_);
        const int count = static_cast<int>(stages.size());
        StageReport report = begin(fit);
        for (int s = 0; s + 1 < count && !report.interrupted; ++s) {
            FitStage stage = stages[static_cast<std::size_t>(s)];
            stage.prior = s == 0 ? prior() : 0;
            report = make(stage, s + 1, count + 1, fit);
            merge_bound(rows_, point_);
            update_modes(rows_, point_);
            if (!report.interrupted)
                rows_.noise = noise_at(rows_, point_);
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
            const std::vector<double> noise = noise_at(rows_, point_);
            if (!switched && is_settled(noise, before, rows_))
                break;
            rows_.noise = noise;
        }
        return report;
    }

    /// Shorter pieces, whose ends are elsewhere: a contact near one may have been missed.
    void cut_anew(int round) {
        constexpr double shorter = 0.7;
        FitSettings settings = *settings_;
        std::vector<double> lengths;
        std::vector<Eigen::VectorXd> openings;
        for (std::size_t k = 0; k < pieces().size(); ++k) {
            lengths.push_back(pieces()[k].end - pieces()[k].begin);
            if (pieces()[k].opening)
                openings.push_back(point_.states[k]);
        }
        const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
        std::nth_element(lengths.begin(), middle, lengths.end());
        settings.piece = (round == 1 ? 1 : shorter) * shorter * *middle;
        pieces() = cut_records(rows_.system(), rows_.task(), settings);
        point_.states.clear();
        for (const FitPiece& piece : pieces())
            point_.states.push_back(piece.opening
                                        ? openings[piece.record]
                                        : Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows_.layout.states)));
    }

    bool leaves_more_than_noise() {
        if (!unreadable(rows_, point_).empty())
            return false;
        Fit trial;
        describe(rows_, point_, last_joint, trial);
        for (std::size_t o = 0; o < trial.outputs.size(); ++o)
            if (is_no_noise(trial.outputs[o], o))
                return true;
        return false;
    }
    bool is_no_noise(const FittedOutput& output, std::size_t number) const {
        constexpr double round_off = 1e-9;
        return !output.independent && output.deviation > round_off * rows_.range(number);
    }

    void restore(const FitLayout& layout, const std::vector<double>& noise, const FitPoint& point) {
        rows_.layout = layout;
        rows_.noise = noise;
        point_ = point;
    }

    /// The first pieces of records alone, then twice as many, and so on: each begins where what is known by then leads
    /// to, so that a wrong frequency, say, does not add up to a wrong phase.
    StageReport begin(Fit& fit) {
        StageReport report;
        usual_costs_.clear();
        std::size_t done = 0;
        for (std::size_t count = 1; done < most_pieces() && !report.interrupted; count *= 2) {
            for (std::size_t k = 0; k < pieces().size(); ++k) {
                if (ordinal(k) < done || ordinal(k) >= count)
                    continue;
                if (!pieces()[k].opening && ends_bound(rows_, point_, k - 1)) {
                    merge(rows_, point_, k--);
                    continue;
                }
                if (!pieces()[k].opening)
                    continue_from(rows_, point_, k);
                report = begin_piece(k, fit);
            }
            FitStage together = soft_stage();
            for (std::size_t k = 0; k < pieces().size(); ++k)
                together.active.push_back(ordinal(k) < count);
            together.prior = prior();
            report = make(together, 0, 5, fit);
            update_modes(rows_, point_);
            done = count;
        }
        return report;
    }

    FitStage alone(std::size_t piece) {
        FitStage stage = soft_stage();
        stage.active.assign(pieces().size(), false);
        stage.active[piece] = true;
        stage.states_only = true;
        stage.prior = 0.03;
        return stage;
    }

    /// Finds the first state of a piece. Where it meets its readings far worse than others do a contact is amiss, as
    /// noise can make it near the piece's beginning: then it begins otherwise, or becomes part of the one before.
    StageReport begin_piece(std::size_t& piece, Fit& fit) {
        constexpr double amiss = 3;
        StageReport report = best_opening(alone(piece), piece, fit);
        const auto readings = [&](std::size_t k) { return static_cast<double>(pieces()[k].last - pieces()[k].first); };
        if (pieces()[piece].opening || usual_costs_.empty() || report.interrupted ||
            report.cost < amiss * readings(piece) * usual_cost()) {
            usual_costs_.push_back(report.cost / readings(piece));
            return report;
        }
        const Eigen::VectorXd first = point_.states[piece];
        continue_from(rows_, point_, piece, false);
        if (const StageReport other = make(alone(piece), 0, 5, fit); other.cost < report.cost)
            report = other;
        else
            point_.states[piece] = first;
        if (report.cost < amiss * readings(piece) * usual_cost())
            return report;
        const FitPoint apart = point_;
        const FitLayout layout = rows_.layout;
        merge(rows_, point_, piece);
        const StageReport merged = make(alone(piece - 1), 0, 5, fit);
        if (merged.cost < report.cost) {
            --piece;
            return merged;
        }
        point_ = apart;
        rows_.layout = layout;
        return report;
    }
    /// By reading, of half of the pieces.
    double usual_cost() {
        const auto middle = usual_costs_.begin() + static_cast<std::ptrdiff_t>(usual_costs_.size() / 2);
        std::nth_element(usual_costs_.begin(), middle, usual_costs_.end());
        return *middle;
    }

    /// From each of the states in which a piece might begin: the one that meets its readings best.
    StageReport best_opening(const FitStage& stage, std::size_t piece, Fit& fit) {
        StageReport best = make(stage, 0, 5, fit);
        const std::vector<Eigen::VectorXd> others =
            pieces()[piece].opening ? other_openings(rows_, point_, piece) : std::vector<Eigen::VectorXd>{};
        Eigen::VectorXd found = point_.states[piece];
        for (const Eigen::VectorXd& other : others) {
            point_.states[piece] = other;
            const StageReport report = make(stage, 0, 5, fit);
            if (report.interrupted)
                return report;
            if (!report.failed && (report.cost < best.cost || best.failed)) {
                best = report;
                found = point_.states[piece];
            }
        }
        point_.states[piece] = found;
        return best;
    }

    /// While little is known, a change by a tenth counts as much as one reading's noise: what noise alone would move
    /// far stays near.
    double prior() const {
        constexpr double usual_change = 0.1;
        return rows_.unit() / usual_change;
    }

    static FitStage soft_stage() {
        FitStage stage;
        stage.joint = 1;
        stage.tolerance = 1e-3;
        stage.most_iterations = 15;
        return stage;
    }
    std::vector<FitPiece>& pieces() { return rows_.layout.pieces; }
    /// Which piece of its record.
    std::size_t ordinal(std::size_t piece) {
        std::size_t count = 0;
        while (!pieces()[piece - count].opening)
            ++count;
        return count;
    }
    std::size_t most_pieces() {
        std::size_t most = 0;
        for (std::size_t k = 0; k < pieces().size(); ++k)
            most = std::max(most, ordinal(k) + 1);
        return most;
    }

    StageReport make(const FitStage& stage, int number, int count, Fit& fit) {
        const int before = fit.iterations;
        const StageReport report = minimise(rows_, point_, stage, [&](int iteration, double cost, const FitPoint&) {
            if (!settings_->progress)
                return true;
            FitProgress progress;
            progress.stage = number;
            progress.stages = count;
            progress.iteration = before + iteration;
            progress.misfit = std::sqrt(2 * cost / static_cast<double>(std::max<std::size_t>(1, readings())));
            return settings_->progress(progress);
        });
        fit.iterations += report.iterations;
        return report;
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
            return end(FitEnding::interrupted, "the fit was ended before it had converged");
        if (!checks.broken.empty())
            return end(FitEnding::broken, checks.broken + ": begin from other guesses, or bound parameters");
        if (!std::all_of(fit.numbers.begin(), fit.numbers.end(), [](const FittedNumber& number) {
                return std::isfinite(number.estimate.value) && std::isfinite(number.estimate.error);
            }))
            return end(FitEnding::broken, "numbers or their errors are beyond all bounds: choose other units");
        if (!checks.modes_agree || !(checks.gap <= checks.allowed_gap))
            return end(FitEnding::apart,
                       fmt::format("pieces of the motion do not join, by {:.3g} of its size: begin from other guesses, "
                                   "or with shorter pieces",
                                   checks.gap));
        if (!checks.stationary)
            return end(FitEnding::unfinished,
                       fmt::format("it has not converged after {} iterations: allow more, or begin from other guesses",
                                   fit.iterations));
        if (!fit.free.empty())
            return end(FitEnding::undetermined,
                       fmt::format("readings do not tell all numbers, for nothing changes with {}: give some of these, "
                                   "or record what tells them",
                                   fit.free.front().text));
        for (std::size_t o = 0; o < fit.outputs.size(); ++o)
            if (is_no_noise(fit.outputs[o], o))
                return end(
                    FitEnding::misfit,
                    fmt::format("what is left of '{}' is no noise (neighbours have a correlation of {:.2g}): the "
                                "model misses something, or a contact is missed, and errors are larger than told",
                                fit.outputs[o].name, fit.outputs[o].correlation));
        end(FitEnding::converged, {});
    }

    const FitSettings* settings_;
    FitRows rows_;
    FitPoint point_;
    std::vector<double> usual_costs_; ///< by reading, of pieces that have begun
};

} // namespace

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

Fit fit_model(const System& system, const FitTask& task, const FitSettings& settings) {
    require_task(system, task, settings);
    try {
        return Fitter(system, task, settings).run();
    } catch (const FitInterruption&) {
        Fit fit;
        fit.ending = FitEnding::interrupted;
        fit.detail = "the fit was ended before it had converged";
        return fit;
    }
}

} // namespace graze
