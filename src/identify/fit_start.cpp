#include "identify/fit_start.hpp"

#include "base/concatenated.hpp"
#include "graze/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// Sets states of a starting point from readings.
class StateReader {
public:
    explicit StateReader(FitRows& rows, const System& system) : rows_(&rows), system_(system) {
        work_.resize(system.workspace());
    }

    /// Whether a state violates no barrier of the mode.
    bool is_admissible(const FitPiece& piece, const std::vector<double>& state, const std::vector<double>& parameters) {
        const System::CompiledMode& compiled = system_.mode(piece.mode);
        values_.resize(compiled.events.outputs());
        compiled.events.evaluate(concatenated(state, parameters), values_, work_);
        for (std::size_t w = 0; w < compiled.watched.size(); ++w)
            if (system_.model().events[compiled.watched[w]].kind == EventKind::barrier && !(values_[w] >= 0))
                return false;
        return true;
    }

    /// Replaces states that an output shows directly by their readings, unless that would violate a barrier.
    void take_readings(const FitPiece& piece, std::size_t time, const Eigen::VectorXd& shared,
                       std::vector<double>& state) {
        const FitTask& task = rows_->task();
        const FitRecord& record = task.records[piece.record];
        const std::vector<double> parameters = rows_->parameters(piece.record, shared);
        for (const FitRecord::Readings& readings : record.readings) {
            const MeasuredOutput& output = task.outputs[readings.output];
            if (!output.value.is_symbol())
                continue;
            const std::optional<std::size_t> index = system_.model().find_state(output.value.name());
            const bool free =
                index && (!piece.is_first || std::find(record.unknown_states.begin(), record.unknown_states.end(),
                                                       *index) != record.unknown_states.end());
            if (!free)
                continue;
            const double before = state[*index];
            const bool well = is_admissible(piece, state, parameters);
            state[*index] =
                (readings.values[time] - rows_->offset(readings.output, shared)) / rows_->gain(readings.output, shared);
            if (well && !is_admissible(piece, state, parameters))
                state[*index] = before;
        }
    }

private:
    FitRows* rows_;
    System system_;
    std::vector<double> values_, work_;
};

double length_or(double length, std::size_t readings) {
    return length > 0 ? std::sqrt(static_cast<double>(readings)) / length : 1;
}

/// Where a guess or a state is 0, chooses the scale that changes the readings by their ranges.
void scale_by_effects(FitRows& rows, FitPoint& point) {
    FitLayout& layout = rows.layout;
    Eigen::VectorXd shared = Eigen::VectorXd::Zero(layout.shared());
    Eigen::VectorXd states = Eigen::VectorXd::Zero(layout.state_scale.size());
    std::size_t readings = 0;
    const bool wanted = (layout.shared_scale.array() == 0).any() || (layout.state_scale.array() == 0).any();
    if (!wanted)
        return;
    const auto marked = [](Eigen::VectorXd& scale) {
        std::vector<bool> none;
        for (double& one : scale) {
            none.push_back(one == 0);
            one = one == 0 ? 1 : one;
        }
        return none;
    };
    const std::vector<bool> no_shared = marked(layout.shared_scale), no_state = marked(layout.state_scale);
    for (std::size_t k = 0; k < layout.pieces.size(); ++k) {
        const FitPiece& piece = layout.pieces[k];
        const PieceRows& known = rows.evaluate(piece, point.shared, point.states[k]);
        readings += piece.last - piece.first;
        if (!known.finite)
            continue;
        const Eigen::Index own = point.states[k].size();
        for (Eigen::Index j = 0; j < shared.size(); ++j)
            shared[j] += known.readings.col(own + j).squaredNorm();
        for (Eigen::Index c = 0; c < own; ++c)
            states[static_cast<Eigen::Index>(layout.state_of(rows.task(), piece, c))] +=
                known.readings.col(c).squaredNorm();
    }
    for (Eigen::Index j = 0; j < shared.size(); ++j)
        if (no_shared[static_cast<std::size_t>(j)])
            layout.shared_scale[j] = length_or(std::sqrt(shared[j]), readings);
    for (Eigen::Index i = 0; i < states.size(); ++i)
        if (no_state[static_cast<std::size_t>(i)])
            layout.state_scale[i] = length_or(std::sqrt(states[i]), readings);
    // A number whose scale was 0 is 0 itself, so it needs no conversion.
}

void set_shared(FitRows& rows, FitPoint& point) {
    FitLayout& layout = rows.layout;
    const FitTask& task = rows.task();
    point.shared.resize(layout.shared());
    Eigen::Index column = 0;
    const auto put = [&](double value, double scale) {
        layout.shared_scale[column] = scale;
        point.shared[column++] = scale > 0 ? value / scale : 0;
    };
    for (const UnknownParameter& unknown : task.parameters) {
        double scale = std::abs(unknown.guess);
        if (scale == 0 && std::isfinite(unknown.least) && std::isfinite(unknown.greatest))
            scale = unknown.greatest - unknown.least;
        put(unknown.guess, scale);
    }
    for (const std::size_t output : layout.gains)
        put(task.outputs[output].gain, std::abs(task.outputs[output].gain));
    for (const std::size_t output : layout.offsets)
        put(task.outputs[output].offset, rows.range(output));
}

} // namespace

FitPoint starting_point(FitRows& rows) {
    FitLayout& layout = rows.layout;
    const FitTask& task = rows.task();
    FitPoint point;
    set_shared(rows, point);
    StateReader reader(rows, rows.system());
    Eigen::VectorXd sizes = Eigen::VectorXd::Zero(layout.state_scale.size());
    std::vector<double> state;
    std::vector<std::vector<double>> firsts;
    for (std::size_t k = 0; k < layout.pieces.size(); ++k) {
        FitPiece& piece = layout.pieces[k];
        const FitRecord& record = task.records[piece.record];
        const Eigen::Index unknown = layout.unknown_states(task, piece);
        Eigen::VectorXd states(unknown);
        if (piece.is_first) {
            states.setZero();
            state = rows.first_state(piece, point.shared, states);
            const std::vector<double> usual = rows.model_start(piece.record, point.shared);
            for (const std::size_t i : record.unknown_states)
                state[i] = record.start.empty() ? usual[i] : record.start[i];
        }
        if (!piece.is_first || record.start.empty())
            reader.take_readings(piece, piece.is_first ? piece.first : piece.first - 1, point.shared, state);
        for (Eigen::Index c = 0; c < unknown; ++c)
            states[c] = state[layout.state_of(task, piece, c)];
        point.states.push_back(states);
        firsts.push_back(state);
        const PredictedMotion& motion = rows.motion(piece, point.shared, states);
        for (const PredictedMotion::Sample& sample : motion.samples)
            for (Eigen::Index i = 0; i < sizes.size(); ++i)
                sizes[i] = std::max(sizes[i], std::abs(sample.state[static_cast<std::size_t>(i)]));
        for (Eigen::Index i = 0; i < sizes.size(); ++i)
            sizes[i] = std::max(sizes[i], std::abs(state[static_cast<std::size_t>(i)]));
        state = motion.end_state;
        if (piece.has_next)
            layout.pieces[k + 1].mode = motion.end_mode;
    }
    layout.state_scale = sizes;
    for (std::size_t k = 0; k < layout.pieces.size(); ++k) {
        const FitPiece& piece = layout.pieces[k];
        for (Eigen::Index c = 0; c < point.states[k].size(); ++c) {
            const std::size_t i = layout.state_of(task, piece, c);
            const double size = sizes[static_cast<Eigen::Index>(i)];
            point.states[k][c] = size > 0 ? firsts[k][i] / size : 0;
        }
    }
    scale_by_effects(rows, point);
    return point;
}

void continue_from(FitRows& rows, FitPoint& point, std::size_t piece, bool read) {
    FitPiece& next = rows.layout.pieces[piece];
    const PredictedMotion& motion = rows.motion(rows.layout.pieces[piece - 1], point.shared, point.states[piece - 1]);
    std::vector<double> state = motion.end_state;
    if (motion.complete)
        next.mode = motion.end_mode;
    if (read)
        StateReader(rows, rows.system()).take_readings(next, next.first - 1, point.shared, state);
    for (Eigen::Index i = 0; i < point.states[piece].size(); ++i)
        point.states[piece][i] = state[static_cast<std::size_t>(i)] / rows.layout.state_scale[i];
}

bool ends_constrained(FitRows& rows, const FitPoint& point, std::size_t piece) {
    const PredictedMotion& motion = rows.motion(rows.layout.pieces[piece], point.shared, point.states[piece]);
    return motion.complete && motion.constrained;
}

void merge(FitRows& rows, FitPoint& point, std::size_t piece) {
    std::vector<FitPiece>& pieces = rows.layout.pieces;
    pieces[piece - 1].last = pieces[piece].last;
    pieces[piece - 1].end = pieces[piece].end;
    pieces[piece - 1].has_next = pieces[piece].has_next;
    pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(piece));
    point.states.erase(point.states.begin() + static_cast<std::ptrdiff_t>(piece));
}

bool merge_constrained(FitRows& rows, FitPoint& point) {
    bool any = false;
    for (std::size_t k = 0; k < rows.layout.pieces.size(); ++k)
        while (rows.layout.pieces[k].has_next && ends_constrained(rows, point, k)) {
            merge(rows, point, k + 1);
            any = true;
        }
    return any;
}

bool update_modes(FitRows& rows, const FitPoint& point) {
    std::vector<FitPiece>& pieces = rows.layout.pieces;
    bool changed = false;
    for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
        if (!pieces[k].has_next)
            continue;
        const PredictedMotion& motion = rows.motion(pieces[k], point.shared, point.states[k]);
        if (!motion.complete || motion.end_mode == pieces[k + 1].mode)
            continue;
        pieces[k + 1].mode = motion.end_mode;
        changed = true;
    }
    return changed;
}

} // namespace graze
