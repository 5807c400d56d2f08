#include "identify/fit_start.hpp"

#include "base/concatenated.hpp"
#include "base/linear_systems.hpp"
#include "graze/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// Adds initial states with other phases of cyclic states that no output shows.
void add_phases(FitRows& rows, const FitPoint& point, std::size_t piece, std::vector<Eigen::VectorXd>& candidates) {
    constexpr int phases = 8;
    constexpr double seen = 0.2;
    const FitTask& task = rows.task();
    const FitRecord& record = task.records[rows.layout.pieces[piece].record];
    const Model& model = rows.system().model();
    const std::vector<double> parameters = rows.parameters(rows.layout.pieces[piece].record, point.shared);
    const std::vector<double> periods = rows.system().periods()(parameters);
    for (std::size_t c = 0; c < record.unknown_states.size(); ++c) {
        const std::size_t state = record.unknown_states[c];
        const bool read =
            !record.start.empty() ||
            std::any_of(record.readings.begin(), record.readings.end(), [&](const FitRecord::Readings& readings) {
                const Expression& value = task.outputs[readings.output].value;
                return value.is_symbol() && value.name() == model.states[state].name;
            });
        if (read || !(periods[state] > 0))
            continue;
        const auto place = static_cast<Eigen::Index>(c);
        const double part = periods[state] / phases / rows.layout.state_scale[static_cast<Eigen::Index>(state)];
        const PieceRows& known = rows.evaluate(rows.layout.pieces[piece], point.shared, point.states[piece]);
        if (!known.finite ||
            !(part * known.readings.col(place).norm() > seen * known.readings.col(known.readings.cols() - 1).norm()))
            continue;
        for (int k = 1; k < phases; ++k) {
            candidates.push_back(point.states[piece]);
            candidates.back()[place] += k * part;
        }
    }
}

/// Finds initial states on the other side of contacts near the first reading.
class OtherSides {
public:
    OtherSides(FitRows& rows, const FitPoint& point, std::size_t piece)
        : rows_(&rows), piece_(rows.layout.pieces[piece]), system_(rows.system()),
          record_(rows.task().records[piece_.record]), parameters_(rows.parameters(piece_.record, point.shared)),
          here_(rows.first_state(piece_, point.shared, point.states[piece])), work_(system_.workspace()) {}

    std::vector<Eigen::VectorXd> run() {
        const System::CompiledMode& mode = system_.mode(piece_.mode);
        if (record_.unknown_states.empty() || piece_.last - piece_.first < 2)
            return {};
        for (std::size_t w = 0; w < mode.watched.size(); ++w) {
            event_ = mode.watched[w];
            const System::CompiledJump& jump = system_.jump(system_.transition(mode.transitions[w]).jump);
            if (system_.model().events[event_].kind != EventKind::barrier || jump.identity)
                continue;
            if (approach(here_).rate < 0)
                go_behind(jump);
            else
                go_before(jump);
        }
        return std::move(candidates_);
    }

private:
    struct Approach {
        double distance = 0, rate = 0;
    };

    std::vector<double> inputs_of(const std::vector<double>& state) const { return concatenated(state, parameters_); }
    std::vector<double> rates_of(const std::vector<double>& state) {
        std::vector<double> rates(state.size());
        system_.mode(piece_.mode).rates.evaluate(inputs_of(state), rates, work_);
        return rates;
    }
    Approach approach(const std::vector<double>& state) {
        std::vector<double> gradient(1 + state.size() + parameters_.size());
        system_.event(event_).evaluate(inputs_of(state), gradient, work_);
        const std::vector<double> rates = rates_of(state);
        Approach result;
        result.distance = gradient[0];
        for (std::size_t i = 0; i < state.size(); ++i)
            result.rate += gradient[1 + i] * rates[i];
        return result;
    }
    /// Contacts within the first half of the piece only: others are found piece by piece.
    double most_late() const { return 0.5 * (piece_.end - piece_.begin); }

    /// Assumes that a contact that is about to happen was already before the first reading.
    void go_behind(const System::CompiledJump& jump) {
        const Approach now = approach(here_);
        const double late = -now.distance / now.rate;
        if (!(std::abs(late) <= most_late()))
            return;
        std::vector<double> behind(here_.size());
        jump.map.evaluate(inputs_of(moved(here_, late)), behind, work_);
        if (approach(behind).rate > 0)
            add(moved(behind, -late));
    }

    /// Assumes that a contact that seems to have happened is still to come.
    void go_before(const System::CompiledJump& jump) {
        const std::optional<std::vector<double>> before = state_before(jump);
        if (!before)
            return;
        const Approach then = approach(*before);
        if (!(then.rate < 0))
            return;
        const std::vector<double>& times = record_.times;
        const double spacing = times[piece_.first + 1] - times[piece_.first];
        for (const double late : {then.distance / -then.rate, 0.5 * spacing, 2 * spacing, 8 * spacing})
            if (late > 0 && late <= most_late())
                add(moved(*before, -late));
    }

    /// The state that the jump maps to the present one, by Newton's method in the unknown states.
    std::optional<std::vector<double>> state_before(const System::CompiledJump& jump) {
        constexpr int most = 20;
        constexpr double negligible = 1e-9;
        const std::vector<std::size_t>& unknown = record_.unknown_states;
        const auto rows = static_cast<Eigen::Index>(jump.changed.size());
        const auto columns = static_cast<Eigen::Index>(unknown.size());
        std::vector<double> state = here_, image(state.size()), entries(jump.entries.size());
        for (int i = 0; i < most; ++i) {
            jump.map.evaluate(inputs_of(state), image, work_);
            jump.jacobian.evaluate(inputs_of(state), entries, work_);
            Eigen::VectorXd off(rows);
            Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(rows, columns);
            for (Eigen::Index r = 0; r < rows; ++r) {
                const std::size_t changed = jump.changed[static_cast<std::size_t>(r)];
                off[r] = (image[changed] - here_[changed]) / scale_of(changed);
                for (std::size_t k = 0; k < jump.entries.size(); ++k)
                    for (Eigen::Index c = 0; c < columns; ++c)
                        if (jump.entries[k].row == changed &&
                            jump.entries[k].column == unknown[static_cast<std::size_t>(c)])
                            slopes(r, c) =
                                entries[k] * scale_of(unknown[static_cast<std::size_t>(c)]) / scale_of(changed);
            }
            if (!off.allFinite() || !slopes.allFinite())
                return std::nullopt;
            if (off.lpNorm<Eigen::Infinity>() <= negligible)
                return state;
            const Eigen::VectorXd step = shortest_solution(slopes, off);
            for (Eigen::Index c = 0; c < columns; ++c)
                state[unknown[static_cast<std::size_t>(c)]] -= step[c] * scale_of(unknown[static_cast<std::size_t>(c)]);
        }
        return std::nullopt;
    }

    double scale_of(std::size_t state) const { return rows_->layout.state_scale[static_cast<Eigen::Index>(state)]; }
    /// The state a short time later or earlier, to first order.
    std::vector<double> moved(std::vector<double> state, double time) {
        const std::vector<double> rates = rates_of(state);
        for (std::size_t i = 0; i < state.size(); ++i)
            state[i] += rates[i] * time;
        return state;
    }
    void add(const std::vector<double>& state) {
        const std::vector<std::size_t>& unknown = record_.unknown_states;
        Eigen::VectorXd candidate(static_cast<Eigen::Index>(unknown.size()));
        for (std::size_t c = 0; c < unknown.size(); ++c)
            candidate[static_cast<Eigen::Index>(c)] = state[unknown[c]] / scale_of(unknown[c]);
        if (candidate.allFinite())
            candidates_.push_back(std::move(candidate));
    }

    FitRows* rows_;
    FitPiece piece_;
    System system_;
    const FitRecord& record_;
    std::vector<double> parameters_, here_, work_;
    std::size_t event_ = 0;
    std::vector<Eigen::VectorXd> candidates_;
};

} // namespace

std::vector<Eigen::VectorXd> other_initial_states(FitRows& rows, const FitPoint& point, std::size_t piece) {
    std::vector<Eigen::VectorXd> candidates = OtherSides(rows, point, piece).run();
    add_phases(rows, point, piece, candidates);
    return candidates;
}

} // namespace graze
