#include "identify/fit_findings.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace graze {

namespace {

constexpr double far_from_zero =
    3; // standard errors from 0: a changed sign then moves a number by at least twice as much

/// Initial states of the records, and shared unknowns; unscaled.
struct InitialConditions {
    std::vector<double> shared;
    std::vector<std::vector<double>> starts; ///< for each record
    std::vector<std::size_t> modes;
};

/// A change of initial conditions that is its own inverse.
using Change = std::function<void(InitialConditions&)>;

class AlternativeSearch {
public:
    AlternativeSearch(FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known, const Fit& fit)
        : rows_(&rows), point_(&point), known_(&known), fit_(&fit) {
        const FitLayout& layout = rows.layout;
        for (Eigen::Index j = 0; j < layout.shared(); ++j)
            here_.shared.push_back(point.shared[j] * layout.shared_scale[j]);
        for (const FittedRecord& record : fit.records)
            here_.starts.push_back(record.start);
        here_.modes.resize(fit.records.size());
        for (const FitPiece& piece : layout.pieces)
            if (piece.is_first)
                here_.modes[piece.record] = piece.mode;
        for (const MeasuredOutput& output : rows.task().outputs)
            outputs_.push_back(rows.system().with_gradient(output.value));
        first_readings_ = first_readings(here_, point.shared);
        find_changes();
        find_symmetries();
    }

    std::vector<FoundSolution> run() {
        std::vector<FoundSolution> solutions;
        const std::size_t count = changes_.size();
        const auto attempt = [&](const std::vector<const Change*>& all) {
            constexpr std::size_t enough = 3;
            InitialConditions there = here_;
            for (const Change* change : all)
                (*change)(there);
            FoundSolution solution;
            if (solutions.size() < enough && meets(there, solution))
                add(there, std::move(solution), solutions);
        };
        for (const auto& one : symmetries_) {
            attempt({&one});
            if (!gains_.empty()) {
                const Change flip = [this](InitialConditions& to) {
                    for (const std::size_t gain : gains_)
                        to.shared[gain] = -to.shared[gain];
                };
                attempt({&one, &flip});
            }
        }
        for (std::size_t i = 0; i < count; ++i)
            attempt({&changes_[i]});
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = i + 1; j < count; ++j)
                attempt({&changes_[i], &changes_[j]});
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = i + 1; j < count; ++j)
                for (std::size_t k = j + 1; k < count; ++k)
                    attempt({&changes_[i], &changes_[j], &changes_[k]});
        return solutions;
    }

private:
    static bool is_sure(const FittedNumber& number) {
        return number.estimate.freedom > 0 && std::abs(number.estimate.value) > far_from_zero * number.estimate.error;
    }

    void find_changes() {
        const FitLayout& layout = rows_->layout;
        for (std::size_t j = 0; j < here_.shared.size(); ++j)
            if (is_sure(fit_->numbers[j]) && fit_->numbers[j].kind != FittedNumber::Kind::offset)
                changes_.emplace_back([j](InitialConditions& to) { to.shared[j] = -to.shared[j]; });
        for (std::size_t k = 0; k < layout.gains.size(); ++k)
            gains_.push_back(layout.parameters + k);
        std::vector<std::size_t> mirrored;
        for (std::size_t i = 0; i < layout.states; ++i) {
            if (!is_unknown(i))
                continue;
            if (const double period = known_->front().periods[i]; period > 0) {
                changes_.emplace_back([i, period](InitialConditions& to) {
                    for (std::vector<double>& start : to.starts)
                        start[i] += start[i] < period / 2 ? period / 2 : -period / 2;
                });
                continue;
            }
            mirrored.push_back(i);
            if (std::any_of(fit_->numbers.begin(), fit_->numbers.end(), [&](const FittedNumber& number) {
                    return number.kind == FittedNumber::Kind::state && number.index == i && is_sure(number);
                }))
                changes_.push_back(mirror({i}));
        }
        if (mirrored.size() > 1)
            changes_.push_back(mirror(mirrored));
    }
    static Change mirror(const std::vector<std::size_t>& states) {
        return [states](InitialConditions& to) {
            for (std::vector<double>& start : to.starts)
                for (const std::size_t i : states)
                    start[i] = -start[i];
        };
    }
    /// Whether a state is unknown at the first time of every record.
    bool is_unknown(std::size_t state) const {
        return std::all_of(rows_->task().records.begin(), rows_->task().records.end(), [&](const FitRecord& record) {
            return std::find(record.unknown_states.begin(), record.unknown_states.end(), state) !=
                   record.unknown_states.end();
        });
    }

    void find_symmetries() {
        Model model = rows_->system().model();
        for (const Symmetry& symmetry : model.symmetries) {
            const Function map = model.function_of(model.expand(symmetry.map));
            const std::vector<std::size_t>& modes = symmetry.modes;
            symmetries_.emplace_back([this, map, modes](InitialConditions& to) {
                for (std::size_t r = 0; r < to.starts.size(); ++r) {
                    to.starts[r] = map(rows_->inputs(r, to.starts[r], point_->shared));
                    to.modes[r] = modes[to.modes[r]];
                }
            });
        }
    }

    bool is_allowed(const InitialConditions& there) const {
        for (std::size_t j = 0; j < rows_->task().parameters.size(); ++j) {
            const UnknownParameter& unknown = rows_->task().parameters[j];
            if (there.shared[j] < unknown.least || there.shared[j] > unknown.greatest)
                return false;
        }
        return true;
    }

    /// Values and rates of all outputs at the first time of each record: values in units of the range of readings,
    /// rates as a share of the sum of the sizes of their terms. Alternative solutions have the same; this rejects most
    /// candidates before any motion is computed.
    std::vector<double> first_readings(const InitialConditions& at, const Eigen::VectorXd& shared) const {
        const System& system = rows_->system();
        const std::size_t states = rows_->layout.states;
        std::vector<double> signs, gradient(1 + states + system.parameters()), rates(states), work(system.workspace());
        for (const Function& output : outputs_)
            work.resize(std::max(work.size(), output.workspace()));
        for (std::size_t r = 0; r < at.starts.size(); ++r) {
            const std::vector<double> inputs = rows_->inputs(r, at.starts[r], shared);
            system.mode(at.modes[r]).rates.evaluate(inputs, rates, work);
            for (const FitRecord::Readings& readings : rows_->task().records[r].readings) {
                const std::size_t o = readings.output;
                outputs_[o].evaluate(inputs, gradient, work);
                const double gain = rows_->gain(o, shared);
                double rate = 0, size = 0;
                for (std::size_t i = 0; i < states; ++i) {
                    rate += gain * gradient[1 + i] * rates[i];
                    size += std::abs(gain * gradient[1 + i] * rates[i]);
                }
                signs.push_back((gain * gradient[0] + rows_->offset(o, shared)) / rows_->range(o));
                signs.push_back(size > 0 ? rate / size : 0);
            }
        }
        return signs;
    }
    bool starts_alike(const InitialConditions& there, const Eigen::VectorXd& shared) const {
        constexpr double alike = 1e-6;
        const std::vector<double> signs = first_readings(there, shared);
        for (std::size_t i = 0; i < signs.size(); ++i)
            if (!(std::abs(signs[i] - first_readings_[i]) <= alike))
                return false;
        return true;
    }

    /// Whether the motions from other initial conditions fit the readings equally well, piece by piece. If so,
    /// `solution` becomes that point.
    bool meets(const InitialConditions& there, FoundSolution& solution) const {
        constexpr double as_well = 1.001, round_off = 1e-6; // of the ranges of the readings
        if (!is_allowed(there))
            return false;
        const FitLayout& layout = rows_->layout;
        Eigen::VectorXd shared = point_->shared, states;
        for (Eigen::Index j = 0; j < shared.size(); ++j)
            shared[j] = there.shared[static_cast<std::size_t>(j)] / layout.shared_scale[j];
        if (!starts_alike(there, shared))
            return false;
        std::size_t mode = 0;
        for (std::size_t k = 0; k < layout.pieces.size(); ++k) {
            FitPiece piece = layout.pieces[k];
            if (piece.is_first && !set_first_states(piece, there, states))
                return false;
            piece.mode = piece.is_first ? there.modes[piece.record] : mode;
            solution.modes.push_back(piece.mode);
            solution.point.states.push_back(states);
            try {
                const PieceRows& rows = rows_->evaluate(piece, shared, states);
                if (!rows.finite || !rows.complete)
                    return false;
                const Eigen::Index last = rows.readings.cols() - 1, before = (*known_)[k].readings.cols() - 1;
                const double rest = (*known_)[k].readings.col(before).norm();
                const auto readings = static_cast<double>(rows.residuals.size());
                if (rows.readings.col(last).norm() > as_well * rest + round_off * std::sqrt(readings))
                    return false;
                states = rows.ends.col(rows.ends.cols() - 1);
                mode = rows.end_mode;
            } catch (const InputError&) { // no motion can start there
                return false;
            }
        }
        solution.point.shared = shared;
        solution.changed_signs = changed_signs_of(rows_->task(), there.shared);
        return true;
    }
    /// Sets the initial states of a record's first piece. @return false if that would change a known state
    bool set_first_states(const FitPiece& piece, const InitialConditions& there, Eigen::VectorXd& states) const {
        const std::vector<std::size_t>& unknown = rows_->task().records[piece.record].unknown_states;
        const std::vector<double>&to = there.starts[piece.record], &from = here_.starts[piece.record];
        for (std::size_t i = 0; i < to.size(); ++i)
            if (std::find(unknown.begin(), unknown.end(), i) == unknown.end() && to[i] != from[i])
                return false;
        states.resize(static_cast<Eigen::Index>(unknown.size()));
        for (std::size_t c = 0; c < unknown.size(); ++c)
            states[static_cast<Eigen::Index>(c)] =
                to[unknown[c]] / rows_->layout.state_scale[static_cast<Eigen::Index>(unknown[c])];
        return true;
    }

    void add(const InitialConditions& there, FoundSolution found, std::vector<FoundSolution>& solutions) const {
        AlternativeSolution& solution = found.solution;
        bool sure = false;
        for (std::size_t i = 0; i < fit_->numbers.size(); ++i) {
            const FittedNumber& number = fit_->numbers[i];
            const double value =
                number.kind == FittedNumber::Kind::state ? there.starts[number.record][number.index] : there.shared[i];
            if (value == number.estimate.value)
                continue;
            solution.numbers.emplace_back(i, value);
            solution.text += fmt::format("{}{} = {:.6g}", solution.text.empty() ? "" : ", ", number.name, value);
            sure = sure || std::abs(value - number.estimate.value) > 2 * far_from_zero * number.estimate.error;
        }
        if (sure && std::none_of(solutions.begin(), solutions.end(),
                                 [&](const FoundSolution& other) { return other.solution.text == solution.text; }))
            solutions.push_back(std::move(found));
    }

    FitRows* rows_;
    const FitPoint* point_;
    const std::vector<PieceRows>* known_;
    const Fit* fit_;
    InitialConditions here_;
    std::vector<Function> outputs_; ///< with gradients
    std::vector<double> first_readings_;
    std::vector<Change> changes_, symmetries_;
    std::vector<std::size_t> gains_; ///< indices of gains among the shared unknowns
};

} // namespace

std::size_t changed_signs_of(const FitTask& task, const std::vector<double>& shared) {
    std::size_t count = 0, j = 0;
    for (const UnknownParameter& unknown : task.parameters)
        count += unknown.guess * shared[j++] < 0 ? 1 : 0;
    for (const MeasuredOutput& output : task.outputs)
        if (output.gain_unknown)
            count += output.gain * shared[j++] < 0 ? 1 : 0;
    return count;
}

std::vector<FoundSolution> alternative_solutions(FitRows& rows, const FitPoint& point,
                                                 const std::vector<PieceRows>& known, const Fit& fit) {
    return AlternativeSearch(rows, point, known, fit).run();
}

} // namespace graze
