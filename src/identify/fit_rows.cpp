#include "identify/fit_rows.hpp"

#include "base/linear_systems.hpp"
#include "base/median.hpp"
#include "graze/base/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// Distance of the two sides of a contact, in standard deviations, above which a reading is assigned to the nearer
/// side.
constexpr double distinct_distance = 6;

std::vector<double> ranges_of(const FitTask& task) {
    std::vector<double> least(task.outputs.size(), std::numeric_limits<double>::infinity()), greatest(least.size());
    std::fill(greatest.begin(), greatest.end(), -std::numeric_limits<double>::infinity());
    for (const FitRecord& record : task.records)
        for (const FitRecord::Readings& readings : record.readings)
            for (const double value : readings.values) {
                least[readings.output] = std::min(least[readings.output], value);
                greatest[readings.output] = std::max(greatest[readings.output], value);
            }
    std::vector<double> ranges(least.size(), 1.0);
    for (std::size_t o = 0; o < ranges.size(); ++o)
        if (greatest[o] >= least[o]) {
            const double largest = std::max(std::abs(least[o]), std::abs(greatest[o]));
            ranges[o] = greatest[o] > least[o] ? greatest[o] - least[o] : largest > 0 ? largest : 1;
        }
    return ranges;
}

/// Upper estimate of an output's noise by third differences: they are small for smooth motion, and contacts are rare.
double rough_noise(const FitTask& task, std::size_t output, double range) {
    constexpr double of_normal = 1.4826, least = 1e-3, greatest = 0.05;
    const double spread = std::sqrt(20.0); // norm of the weights 1, -3, 3, -1
    std::vector<double> sizes;
    for (const FitRecord& record : task.records)
        for (const FitRecord::Readings& readings : record.readings)
            for (std::size_t i = 3; readings.output == output && i < readings.values.size(); ++i) {
                const double* at = &readings.values[i - 3];
                sizes.push_back(std::abs(at[3] - 3 * at[2] + 3 * at[1] - at[0]));
            }
    if (sizes.empty())
        return greatest * range;
    return std::clamp(of_normal * median(std::move(sizes)) / spread, least * range, greatest * range);
}

double usual_distance(const FitTask& task) {
    std::vector<double> distances;
    for (const FitRecord& record : task.records)
        for (std::size_t i = 1; i < record.times.size(); ++i)
            distances.push_back(record.times[i] - record.times[i - 1]);
    if (distances.empty())
        return 0;
    return median(std::move(distances));
}

std::vector<std::size_t> places_of(const FitTask& task) {
    std::vector<std::size_t> places;
    for (const UnknownParameter& unknown : task.parameters)
        places.push_back(unknown.parameter.place());
    return places;
}

/// Replaces a residual (in standard deviations) by the root of its cost, so that a robust loss is a sum of squares
/// again.
struct Costed {
    double value, slope;
};
Costed root_cost_of(double residual, FitLoss loss) {
    constexpr double huber = 1.345, cauchy = 2.385; // 95 % efficiency relative to least squares for normal noise
    const double size = std::abs(residual);
    if (loss == FitLoss::huber && size > huber) {
        const double root = std::sqrt(2 * huber * size - huber * huber);
        return {std::copysign(root, residual), huber / root};
    }
    if (loss == FitLoss::cauchy && size > 1e-4 * cauchy) {
        const double part = size / cauchy, root = cauchy * std::sqrt(std::log1p(part * part));
        return {std::copysign(root, residual), size / ((1 + part * part) * root)};
    }
    return {residual, 1};
}

} // namespace

double cost_of(double residual, FitLoss loss) {
    const double root = root_cost_of(residual, loss).value;
    return root * root;
}

FitRows::FitRows(const System& system, const FitTask& task, const FitSettings& settings)
    : system_(system), task_(&task), loss_(settings.loss),
      reach_(settings.reach >= 0 ? settings.reach : 3 * usual_distance(task)), ranges_(ranges_of(task)),
      values_(task.values.empty() ? system.model().parameter_values() : task.values), periods_(system.states()),
      motion_(Simulation(system, {}, {}, settings.simulation), places_of(task)) {
    motion_.end_when(settings.interrupted);
    layout.parameters = task.parameters.size();
    layout.states = system.states();
    for (std::size_t o = 0; o < task.outputs.size(); ++o) {
        if (task.outputs[o].gain_unknown)
            layout.gains.push_back(o);
        if (task.outputs[o].offset_unknown)
            layout.offsets.push_back(o);
        outputs_.push_back(system.with_gradient(task.outputs[o].value));
        noise.push_back(task.outputs[o].noise > 0 ? task.outputs[o].noise : rough_noise(task, o, ranges_[o]));
    }
    std::size_t largest = system.workspace();
    for (const State& state : system.model().states)
        initials_.push_back(system.with_gradient(state.initial));
    for (const auto* functions : {&outputs_, &initials_})
        for (const Function& function : *functions)
            largest = std::max(largest, function.workspace());
    inputs_.resize(system.states() + system.parameters());
    work_.resize(largest);
    gradient_.resize(1 + inputs_.size());
    layout.shared_scale = Eigen::VectorXd::Ones(layout.shared());
    layout.state_scale = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(layout.states));
}

double FitRows::unit() const {
    double least = std::numeric_limits<double>::infinity();
    for (const FitRecord& record : task_->records)
        for (const FitRecord::Readings& readings : record.readings)
            least = std::min(least, noise[readings.output] / ranges_[readings.output]);
    return least;
}

std::vector<double> FitRows::parameters(std::size_t record, const Eigen::VectorXd& shared) const {
    std::vector<double> values = values_;
    for (std::size_t j = 0; j < layout.parameters; ++j) {
        const auto column = static_cast<Eigen::Index>(j);
        values[task_->parameters[j].parameter.place()] = shared[column] * layout.shared_scale[column];
    }
    for (const auto& [parameter, value] : task_->records[record].known)
        values[parameter.place()] = value;
    return values;
}

/// The value of an output's gain or offset: fitted if it is among `unknown`, whose first column this is.
double FitRows::fitted_or(double given, std::size_t output, const std::vector<std::size_t>& unknown, std::size_t first,
                          const Eigen::VectorXd& shared) const {
    const auto found = std::find(unknown.begin(), unknown.end(), output);
    const auto column = static_cast<Eigen::Index>(first) + (found - unknown.begin());
    return found == unknown.end() ? given : shared[column] * layout.shared_scale[column];
}

double FitRows::gain(std::size_t output, const Eigen::VectorXd& shared) const {
    return fitted_or(task_->outputs[output].gain, output, layout.gains, layout.parameters, shared);
}

double FitRows::offset(std::size_t output, const Eigen::VectorXd& shared) const {
    return fitted_or(task_->outputs[output].offset, output, layout.offsets, layout.parameters + layout.gains.size(),
                     shared);
}

std::vector<double> FitRows::first_state(const FitPiece& piece, const Eigen::VectorXd& shared,
                                         const Eigen::VectorXd& states) {
    std::vector<double> state = piece.is_first ? model_start(piece.record, shared) : std::vector<double>(layout.states);
    for (Eigen::Index c = 0; c < states.size(); ++c) {
        const std::size_t i = layout.state_of(*task_, piece, c);
        state[i] = states[c] * layout.state_scale[static_cast<Eigen::Index>(i)];
    }
    return state;
}

std::vector<double> FitRows::model_start(std::size_t record, const Eigen::VectorXd& shared) {
    const std::vector<double> values = parameters(record, shared);
    std::vector<double> state(layout.states);
    std::fill(inputs_.begin(), inputs_.end(), 0.0);
    std::copy(values.begin(), values.end(), inputs_.begin() + static_cast<std::ptrdiff_t>(layout.states));
    for (std::size_t i = 0; i < state.size(); ++i) {
        initials_[i].evaluate(inputs_, gradient_, work_);
        state[i] = gradient_[0];
    }
    return state;
}

const PredictedMotion& FitRows::motion(const FitPiece& piece, const Eigen::VectorXd& shared,
                                       const Eigen::VectorXd& states) {
    std::vector<double> state = first_state(piece, shared, states), values = parameters(piece.record, shared);
    const std::size_t count = layout.states + layout.parameters;
    std::vector<double> seeds(layout.states * count, 0.0);
    for (std::size_t i = 0; i < layout.states; ++i)
        seeds[i * count + i] = 1;
    if (piece.is_first) {
        const std::vector<std::size_t>& unknown = task_->records[piece.record].unknown_states;
        for (std::size_t i = 0; i < layout.states; ++i) {
            if (std::find(unknown.begin(), unknown.end(), i) != unknown.end())
                continue;
            initials_[i].evaluate(inputs_, gradient_, work_); // the inputs are still those of model_start
            for (std::size_t j = 0; j < layout.parameters; ++j)
                seeds[i * count + layout.states + j] =
                    gradient_[1 + layout.states + task_->parameters[j].parameter.place()];
        }
    }
    motion_.set_parameters(values);
    system_.periods().evaluate(values, periods_, work_);
    find_period_slopes(values);
    for (std::size_t i = 0; i < layout.states; ++i)
        if (periods_[i] > 0 && !(state[i] >= 0 && state[i] < periods_[i])) {
            const double turns = std::floor(state[i] / periods_[i]);
            state[i] -= turns * periods_[i];
            for (std::size_t j = 0; j < layout.parameters; ++j)
                seeds[i * count + layout.states + j] -= turns * period_slopes_[i * layout.parameters + j];
        }
    std::copy(values.begin(), values.end(), inputs_.begin() + static_cast<std::ptrdiff_t>(layout.states));
    const std::span<const double> times = task_->records[piece.record].times;
    if (motion_.is_interrupted())
        throw FitInterruption();
    const PredictedMotion& followed = motion_.follow({state, seeds, piece.mode, piece.begin, piece.end,
                                                      times.subspan(piece.first, piece.last - piece.first), reach_});
    if (motion_.is_interrupted())
        throw FitInterruption();
    return followed;
}

void FitRows::find_period_slopes(std::span<const double> parameters) {
    period_slopes_.assign(layout.states * layout.parameters, 0.0);
    if (std::all_of(periods_.begin(), periods_.end(), [](double period) { return period == 0; }))
        return;
    const std::vector<double> gradients = system_.period_gradients()(parameters);
    for (std::size_t i = 0; i < layout.states; ++i)
        for (std::size_t j = 0; j < layout.parameters; ++j)
            period_slopes_[i * layout.parameters + j] =
                gradients[i * parameters.size() + task_->parameters[j].parameter.place()];
}

/// Evaluates all outputs in a state, and their derivatives in all directions.
void FitRows::read(std::span<const double> state, std::span<const double> derivatives, Side& side) {
    const std::size_t count = layout.states + layout.parameters;
    side.values.resize(outputs_.size());
    side.slopes.assign(outputs_.size() * count, 0.0);
    std::copy(state.begin(), state.end(), inputs_.begin());
    for (std::size_t o = 0; o < outputs_.size(); ++o) {
        outputs_[o].evaluate(inputs_, gradient_, work_);
        side.values[o] = gradient_[0];
        double* slope = &side.slopes[o * count];
        for (std::size_t i = 0; i < layout.states; ++i)
            for (std::size_t d = 0; d < count && gradient_[1 + i] != 0; ++d)
                slope[d] += gradient_[1 + i] * derivatives[i * count + d];
        for (std::size_t j = 0; j < layout.parameters; ++j)
            slope[layout.states + j] += gradient_[1 + layout.states + task_->parameters[j].parameter.place()];
    }
}

/// Whether the readings are closer to the motion on the other side of a contact, and the sides differ by clearly more
/// than noise.
bool FitRows::is_beyond(const FitRecord& record, std::size_t sample, const Eigen::VectorXd& shared) const {
    double here = 0, there = 0, apart = 0;
    for (const FitRecord::Readings& readings : record.readings) {
        const std::size_t o = readings.output;
        const double factor = gain(o, shared), shift = offset(o, shared);
        const double one = (factor * side_.values[o] + shift - readings.values[sample]) / noise[o];
        const double other = (factor * beyond_.values[o] + shift - readings.values[sample]) / noise[o];
        here += one * one;
        there += other * other;
        apart = std::max(apart, std::abs(one - other));
    }
    return there < here && apart > distinct_distance;
}

double FitRows::scale_of(const FitPiece& piece, Eigen::Index column) const {
    const Eigen::Index states = layout.unknown_states(*task_, piece);
    if (column >= states)
        return layout.shared_scale[column - states];
    return layout.state_scale[static_cast<Eigen::Index>(layout.state_of(*task_, piece, column))];
}

/// Fills the part of a row with derivatives by initial states and parameters. @param slope the derivatives by all of
/// them, unscaled. @param made the entry of a derivative and the scale of its unknown
template <class Row, class Made>
void FitRows::fill(Row row, const FitPiece& piece, const double* slope, const Made& made) const {
    const auto& known = task_->records[piece.record].known;
    const Eigen::Index states = layout.unknown_states(*task_, piece);
    for (Eigen::Index c = 0; c < states; ++c)
        row[c] = made(slope[layout.state_of(*task_, piece, c)], scale_of(piece, c));
    for (std::size_t j = 0; j < layout.parameters; ++j) {
        const Eigen::Index c = states + static_cast<Eigen::Index>(j);
        const bool own = std::any_of(known.begin(), known.end(),
                                     [&](const auto& one) { return one.first == task_->parameters[j].parameter; });
        row[c] = own ? 0 : made(slope[layout.states + j], scale_of(piece, c));
    }
}

void FitRows::add_time(const FitPiece& piece, std::size_t sample, const Eigen::VectorXd& shared, Eigen::Index row) {
    const FitRecord& record = task_->records[piece.record];
    const std::size_t count = layout.states + layout.parameters;
    const Eigen::Index states = layout.unknown_states(*task_, piece), last = raw_.cols() - 1;
    const double size = unit();
    for (const FitRecord::Readings& readings : record.readings) {
        const std::size_t o = readings.output;
        const double factor = gain(o, shared),
                     residual = factor * side_.values[o] + offset(o, shared) - readings.values[sample];
        rows_.residuals.push_back(residual);
        const Costed costed = root_cost_of(residual / noise[o], loss());
        const double weight = size * costed.slope / noise[o];
        fill(raw_.row(row), piece, &side_.slopes[o * count],
             [&](double slope, double scale) { return weight * factor * slope * scale; });
        Eigen::Index c = states + static_cast<Eigen::Index>(layout.parameters);
        for (const std::size_t output : layout.gains) {
            raw_(row, c) = output == o ? weight * side_.values[o] * scale_of(piece, c) : 0;
            ++c;
        }
        for (const std::size_t output : layout.offsets) {
            raw_(row, c) = output == o ? weight * scale_of(piece, c) : 0;
            ++c;
        }
        raw_(row, last) = size * costed.value;
        ++row;
    }
}

void FitRows::add_ends(const FitPiece& piece, const PredictedMotion& predicted) {
    const std::size_t count = layout.states + layout.parameters;
    rows_.ends.setZero(static_cast<Eigen::Index>(layout.states), raw_.cols());
    for (Eigen::Index i = 0; i < rows_.ends.rows(); ++i) {
        const auto state = static_cast<std::size_t>(i);
        fill(rows_.ends.row(i), piece, &predicted.end_derivatives[state * count],
             [&](double slope, double scale) { return slope * scale / layout.state_scale[i]; });
        rows_.ends(i, rows_.ends.cols() - 1) = predicted.end_state[state] / layout.state_scale[i];
    }
}

const PieceRows& FitRows::evaluate(const FitPiece& piece, const Eigen::VectorXd& shared,
                                   const Eigen::VectorXd& states) {
    const FitRecord& record = task_->records[piece.record];
    const PredictedMotion& predicted = motion(piece, shared, states);
    const Eigen::Index columns = layout.unknown_states(*task_, piece) + layout.shared() + 1;
    const auto readings = static_cast<Eigen::Index>(record.readings.size());
    const auto times = static_cast<Eigen::Index>(piece.last - piece.first);
    raw_.setZero(std::max(times * readings, columns), columns);
    rows_.residuals.clear();
    rows_.misplaced = 0;
    for (std::size_t k = 0; k < predicted.samples.size(); ++k) {
        const PredictedMotion::Sample& sample = predicted.samples[k];
        read(sample.state, sample.derivatives, side_);
        if (sample.other) {
            read(sample.other_state, sample.other_derivatives, beyond_);
            if (is_beyond(record, piece.first + k, shared)) {
                std::swap(side_, beyond_);
                ++rows_.misplaced;
            }
        }
        add_time(piece, piece.first + k, shared, static_cast<Eigen::Index>(k) * readings);
    }
    add_ends(piece, predicted);
    constexpr double most = 1e150; // so that squares are finite, too
    rows_.finite = (raw_.array().abs() < most).all() && (rows_.ends.array().abs() < most).all();
    rows_.complete = predicted.complete;
    rows_.contacts = predicted.contacts;
    rows_.end_mode = predicted.end_mode;
    rows_.detail = predicted.detail;
    rows_.periods = periods_;
    rows_.period_slopes = period_slopes_;
    if (rows_.finite) {
        make_triangular(raw_);
        rows_.readings = raw_.topRows(columns).triangularView<Eigen::Upper>();
    }
    return rows_;
}

std::vector<PieceRows> FitRows::evaluate(const FitPoint& point) {
    std::vector<PieceRows> all;
    for (std::size_t k = 0; k < layout.pieces.size(); ++k)
        try {
            all.push_back(evaluate(layout.pieces[k], point.shared, point.states[k]));
        } catch (const InputError& error) {
            all.emplace_back().detail = error.problem();
        }
    return all;
}

Eigen::VectorXd FitRows::gap(const PieceRows& piece, const Eigen::VectorXd& next) const {
    Eigen::VectorXd result = piece.ends.col(piece.ends.cols() - 1) - next;
    for (Eigen::Index i = 0; i < result.size(); ++i)
        if (const double period = piece.periods[static_cast<std::size_t>(i)] / layout.state_scale[i]; period > 0)
            result[i] = std::remainder(result[i], period);
    return result;
}

void FitRows::add_period_slopes(const PieceRows& piece, const Eigen::VectorXd& next,
                                Eigen::Ref<Eigen::MatrixXd> shared) const {
    for (Eigen::Index i = 0; i < next.size(); ++i) {
        const auto state = static_cast<std::size_t>(i);
        if (!(piece.periods[state] > 0))
            continue;
        const double period = piece.periods[state] / layout.state_scale[i];
        const double turns = std::round((piece.ends(i, piece.ends.cols() - 1) - next[i]) / period);
        for (std::size_t j = 0; j < layout.parameters && turns != 0; ++j) {
            const auto column = static_cast<Eigen::Index>(j);
            shared(i, column) -= turns * piece.period_slopes[state * layout.parameters + j] *
                                 layout.shared_scale[column] / layout.state_scale[i];
        }
    }
}

} // namespace graze
