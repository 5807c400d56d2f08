#include "orbit/shooting.hpp"

#include "orbit/eigen_index.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// Growth of derivatives over one piece above which a segment is split.
constexpr double most_growth = 1e3;
constexpr std::size_t most_splits = 64;

} // namespace

Shooting::Shooting(const Simulation& simulation, const Orbit& orbit, std::vector<std::size_t> free,
                   std::vector<double> ranges)
    : simulation_(simulation), signature_(orbit.signature), symmetry_(orbit.symmetry), free_(std::move(free)),
      n_(simulation.system().states()), flow_(flow_of(simulation, free_)), system_(n_, free_.size()),
      parameters_(orbit.parameters), periods_(n_), reference_(orbit.starts.front()), state_scales_(n_),
      ranges_(std::move(ranges)) {
    ranges_.resize(free_.size(), 0.0);
    validate_orbit(simulation.model(), orbit);
    inputs_.resize(n_ + parameters_.size());
    choose_ends();
    period_rates_ = Eigen::MatrixXd::Zero(index(n_), index(free_.size()));
    coupling_ = Eigen::MatrixXd::Zero(index(n_), index(n_));
    split(orbit);
    system_.resize(pieces_.size());
    largest_parameters_.resize(free_.size());
    effects_.assign(free_.size(), 0.0);
    const Eigen::VectorXd unknowns = unknowns_of(orbit);
    set_scales(unknowns);
    if (!free_.empty() && evaluate(unknowns)) // only now is known what the parameters do
        set_scales(unknowns);
}

void Shooting::choose_ends() {
    const System& system = simulation_.system();
    for (std::size_t k = 0; k < signature_.size(); ++k) {
        const Segment& segment = signature_[k];
        EndFunction end;
        if (segment.end == SegmentEnd::event) {
            end.value = &system.event(model().transitions[segment.index].event);
        } else {
            const Section& section = model().sections[segment.index];
            end.cyclic = section.state.has_value();
            end.state = section.state.value_or(0);
            // A half orbit ends where its image passes the section.
            const bool at_image = symmetry_ && k + 1 == signature_.size();
            end.value = &system.section(segment.index, at_image ? symmetry_ : std::nullopt);
        }
        ends_.push_back(end);
    }
    work_.resize(system.workspace());
    values_.resize(std::max(n_, std::size_t{1}) * (1 + n_ + parameters_.size()));
}

Eigen::VectorXd Shooting::gradient_of(std::span<const double> values) const {
    Eigen::VectorXd gradient(index(n_ + free_.size()));
    for (std::size_t i = 0; i < n_; ++i)
        gradient[index(i)] = values[1 + i];
    for (std::size_t f = 0; f < free_.size(); ++f)
        gradient[index(n_ + f)] = values[1 + n_ + free_[f]];
    return gradient;
}

/// Derivatives of the state after a time, and on the way how strongly states act on one another.
bool Shooting::follow(std::size_t mode, std::span<double> state, double duration, Eigen::MatrixXd& derivatives) {
    constexpr int parts = 4; // whose derivatives do not vanish together, as they may after whole periods
    derivatives = Eigen::MatrixXd::Identity(index(n_), index(n_));
    Eigen::MatrixXd part;
    for (int i = 0; i < parts; ++i) {
        if (run(flow_, mode, state, duration / parts, part) != ModeFlow::Ending::done)
            return false;
        coupling_ = coupling_.cwiseMax(part.leftCols(index(n_)).cwiseAbs());
        derivatives = part.leftCols(index(n_)) * derivatives;
    }
    return true;
}

/// Chooses into how many pieces each segment is split, by how much derivatives grow along it.
void Shooting::split(const Orbit& orbit) {
    flow_.set_parameters(parameters_);
    for (std::size_t s = 0; s < signature_.size(); ++s) {
        std::vector<double> state = orbit.starts[s];
        Eigen::MatrixXd derivatives;
        std::size_t count = 1;
        if (orbit.durations[s] > 0 && follow(signature_[s].mode, state, orbit.durations[s], derivatives)) {
            Eigen::VectorXd sizes = Eigen::VectorXd::Ones(index(n_));
            for (std::size_t i = 0; i < n_; ++i)
                sizes[index(i)] = std::max({std::abs(orbit.starts[s][i]), std::abs(state[i]), 1e-300});
            const Eigen::MatrixXd scaled = sizes.cwiseInverse().asDiagonal() * derivatives * sizes.asDiagonal();
            const double growth = std::log(std::max(derivatives.norm(), 1.0));
            const double scaled_growth = std::log(std::max(scaled.norm(), 1.0));
            count = 1 + static_cast<std::size_t>(std::min(growth, scaled_growth) / std::log(most_growth));
        }
        count = std::min(count, most_splits);
        for (std::size_t j = 0; j < count; ++j) {
            Piece piece;
            piece.segment = s;
            piece.last = j + 1 == count;
            piece.fixed_duration = orbit.durations[s] / static_cast<double>(count);
            pieces_.push_back(std::move(piece));
        }
        last_pieces_.push_back(pieces_.size() - 1);
    }
}

Eigen::VectorXd Shooting::unknowns_of(const Orbit& orbit) {
    Eigen::VectorXd unknowns(index(pieces_.size() * (n_ + 1) + free_.size()));
    flow_.set_parameters(orbit.parameters);
    for (std::size_t s = 0; s < signature_.size(); ++s) {
        std::vector<double> state = orbit.starts[s];
        double remaining = orbit.durations[s];
        for (std::size_t k = first_piece(s); k <= last_piece(s); ++k) {
            const double duration = pieces_[k].last ? remaining : pieces_[k].fixed_duration;
            std::copy(state.begin(), state.end(), unknowns.data() + start_of(k));
            unknowns[index(duration_of(k))] = duration;
            if (!pieces_[k].last)
                flow_.run(signature_[s].mode, state, duration);
            remaining -= duration;
        }
    }
    for (std::size_t f = 0; f < free_.size(); ++f)
        unknowns[index(place_of_parameter(f))] = orbit.parameters[free_[f]];
    clear_remnants(unknowns);
    return unknowns;
}

/// States that are next to nothing against the others everywhere are on their way to zero, where a symmetry holds them.
/// Left alone they would shrink until they underflow.
void Shooting::clear_remnants(Eigen::VectorXd& unknowns) const {
    constexpr double remnant = 1e-25;
    std::vector<double> sizes(n_, 0.0);
    double largest = 0;
    for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t k = 0; k < pieces_.size(); ++k)
            sizes[i] = std::max(sizes[i], std::abs(unknowns[index(start_of(k) + i)]));
        if (periods_[i] == 0 && !model().states[i].drifting)
            largest = std::max(largest, sizes[i]);
    }
    for (std::size_t i = 0; i < n_; ++i)
        if (periods_[i] == 0 && sizes[i] < remnant * largest)
            for (std::size_t k = 0; k < pieces_.size(); ++k)
                unknowns[index(start_of(k) + i)] = 0;
}

Orbit Shooting::orbit_of(const Eigen::VectorXd& unknowns) const {
    Orbit orbit{signature_, parameters_, {}, {}, symmetry_};
    for (std::size_t f = 0; f < free_.size(); ++f)
        orbit.parameters[free_[f]] = unknowns[index(place_of_parameter(f))];
    for (std::size_t s = 0; s < signature_.size(); ++s) {
        const double* start = unknowns.data() + start_of(first_piece(s));
        orbit.starts.emplace_back(start, start + n_);
        double duration = 0;
        for (std::size_t k = first_piece(s); k <= last_piece(s); ++k)
            duration += unknowns[index(duration_of(k))];
        orbit.durations.push_back(duration);
    }
    return orbit;
}

void Shooting::set_scales(const Eigen::VectorXd& unknowns) {
    evaluated_.resize(0); // the equations are measured anew
    set_parameters(unknowns);
    const std::size_t count = pieces_.size() * (n_ + 1) + free_.size();
    scales_ = Eigen::VectorXd::Ones(index(count));
    state_scales_.begin();
    double time = 0;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        const double* start = unknowns.data() + start_of(k);
        std::vector<double> state(start, start + n_);
        time += std::abs(unknowns[index(duration_of(k))]);
        state_scales_.note(state);
        // Extents along the motion: those of an orbit with a single piece are not seen from its start.
        constexpr int parts = 8;
        for (int part = 0; part < parts; ++part) {
            if (flow_.run(signature_[pieces_[k].segment].mode, state, unknowns[index(duration_of(k))] / parts) !=
                ModeFlow::Ending::done)
                break;
            state_scales_.note(state);
        }
    }
    const std::vector<double> chosen = state_scales_.choose(periods_, coupling_);
    for (std::size_t k = 0; k < pieces_.size(); ++k)
        std::copy(chosen.begin(), chosen.end(), scales_.data() + start_of(k));
    for (std::size_t k = 0; k < pieces_.size(); ++k)
        scales_[index(duration_of(k))] = time > 0 ? time : 1;
    for (std::size_t f = 0; f < free_.size(); ++f)
        scales_[index(place_of_parameter(f))] = parameter_scale(f, unknowns[index(place_of_parameter(f))]);
}

/// Near zero a parameter says nothing of its own size. What is said instead by the range in which it is looked at must
/// agree with what it does to the orbit: the one may be given without thought, the other may be nothing.
double Shooting::parameter_scale(std::size_t f, double value) {
    constexpr double smallest = 1e-2, nothing = 1e-12;
    const double usual = std::abs(model().parameter_values()[free_[f]]);
    double& largest = largest_parameters_[f];
    largest = std::max({largest, std::abs(value), smallest * usual});
    double scale = largest;
    if (effects_[f] > nothing && ranges_[f] == 0 && usual == 0)
        scale = std::max(scale, smallest / effects_[f]);
    if (effects_[f] > 0 && ranges_[f] > 0)
        scale = std::max(scale, smallest * std::min(ranges_[f], 1 / effects_[f]));
    return scale > 0 && std::isfinite(scale) ? scale : 1;
}

void Shooting::set_parameters(const Eigen::VectorXd& unknowns) {
    for (std::size_t f = 0; f < free_.size(); ++f)
        parameters_[free_[f]] = unknowns[index(place_of_parameter(f))];
    std::copy(parameters_.begin(), parameters_.end(), inputs_.begin() + static_cast<std::ptrdiff_t>(n_));
    flow_.set_parameters(parameters_);
    simulation_.system().periods().evaluate(parameters_, periods_, work_);
    const std::size_t count = parameters_.size();
    simulation_.system().period_gradients().evaluate(parameters_, std::span(values_).first(n_ * count), work_);
    for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t f = 0; f < free_.size(); ++f)
            period_rates_(index(i), index(f)) = values_[i * count + free_[f]];
}

bool Shooting::evaluate(const Eigen::VectorXd& unknowns) {
    // What follows Newton's method asks again for the point at which it has just arrived.
    if (evaluated_.size() == unknowns.size() && evaluated_ == unknowns)
        return true;
    evaluated_.resize(0);
    problem_.clear();
    took_too_long_ = false;
    if (!unknowns.allFinite()) {
        problem_ = "an unknown is not finite";
        return false;
    }
    set_parameters(unknowns);
    for (std::size_t k = 0; k < pieces_.size(); ++k)
        if (!evaluate_piece(k, unknowns) || !pass_end(k))
            return false;
    assemble(unknowns);
    pin(unknowns);
    residual_ = 0;
    for (std::size_t k = 0; k < pieces_.size(); ++k)
        residual_ = std::max(residual_, system_.block(k).right.cwiseAbs().maxCoeff());
    if (!std::isfinite(residual_) || !system_.factor()) {
        problem_ = "an equation is not finite";
        return false;
    }
    evaluated_ = unknowns;
    return true;
}

bool Shooting::evaluate_piece(std::size_t k, const Eigen::VectorXd& unknowns) {
    Piece& piece = pieces_[k];
    const std::size_t mode = signature_[piece.segment].mode;
    const double* start = unknowns.data() + start_of(k);
    piece.end.assign(start, start + n_);
    const double duration = unknowns[index(duration_of(k))];
    switch (run(flow_, mode, piece.end, duration, piece.flow)) {
    case ModeFlow::Ending::done:
        break;
    case ModeFlow::Ending::singular:
        problem_ = fmt::format("the solution ceases to exist within segment {}", piece.segment + 1);
        return false;
    case ModeFlow::Ending::undefined:
        problem_ = fmt::format("segment {} leaves the domain of its vector field", piece.segment + 1);
        return false;
    case ModeFlow::Ending::too_long:
        problem_ = fmt::format("segment {} takes too many steps", piece.segment + 1);
        took_too_long_ = true;
        return false;
    }
    std::copy(piece.end.begin(), piece.end.end(), inputs_.begin());
    piece.field.resize(index(n_));
    simulation_.system().mode(mode).rates.evaluate(inputs_, {piece.field.data(), n_}, work_);
    return true;
}

/// The end condition of a piece and its jump, with derivatives.
bool Shooting::pass_end(std::size_t k) {
    Piece& piece = pieces_[k];
    const auto columns = index(n_ + free_.size());
    piece.jump = Eigen::MatrixXd::Zero(index(n_), columns);
    piece.after = piece.end;
    if (!piece.last) {
        piece.jump.leftCols(index(n_)).setIdentity();
        return true;
    }
    const Segment& segment = signature_[piece.segment];
    const EndFunction& end = ends_[piece.segment];
    const std::span<double> values = std::span(values_).first(end.value->outputs());
    end.value->evaluate(inputs_, values, work_);
    piece.condition_value = values[0];
    piece.condition = gradient_of(values);
    if (end.cyclic) {
        const double turns = std::round(piece.condition_value / periods_[end.state]);
        piece.condition_value -= turns * periods_[end.state];
        piece.condition.tail(index(free_.size())) -= turns * period_rates_.row(index(end.state)).transpose();
    }
    const auto apply = [&](const Function& map, const Function& jacobian) {
        const std::size_t width = n_ + parameters_.size();
        std::copy(piece.after.begin(), piece.after.end(), inputs_.begin());
        const std::span<double> entries = std::span(values_).first(n_ * width);
        jacobian.evaluate(inputs_, entries, work_);
        Eigen::MatrixXd here = Eigen::MatrixXd::Zero(index(n_), columns);
        for (std::size_t i = 0; i < n_; ++i) {
            for (std::size_t j = 0; j < n_; ++j)
                here(index(i), index(j)) = entries[i * width + j];
            for (std::size_t f = 0; f < free_.size(); ++f)
                here(index(i), index(n_ + f)) = entries[i * width + n_ + free_[f]];
        }
        map.evaluate(inputs_, piece.after, work_);
        // Chain rule; parameters are handed through.
        Eigen::MatrixXd product = here.leftCols(index(n_)) * piece.jump;
        product.rightCols(index(free_.size())) += here.rightCols(index(free_.size()));
        piece.jump = std::move(product);
    };
    piece.jump.leftCols(index(n_)).setIdentity();
    if (segment.end == SegmentEnd::event) {
        const auto& jump = simulation_.system().jump(model().transitions[segment.index].jump);
        if (!jump.identity)
            apply(jump.map, jump.jacobian);
    }
    if (symmetry_ && k + 1 == pieces_.size()) {
        const auto& image = simulation_.system().symmetry(*symmetry_);
        apply(image.map, image.jacobian);
    }
    for (const double value : piece.after)
        if (!std::isfinite(value)) {
            problem_ = fmt::format("the jump after segment {} is not defined", piece.segment + 1);
            return false;
        }
    return true;
}

/// Fills the linear system, in units of the scales.
void Shooting::assemble(const Eigen::VectorXd& unknowns) {
    const auto n = index(n_), q = index(free_.size());
    const Eigen::VectorXd state_scales = scales_.head(n), parameter_scales = scales_.tail(q);
    neutral_.assign(n_, true);
    effects_.assign(free_.size(), 0.0);
    const auto note_effects = [&](const Eigen::MatrixXd& changes) {
        for (std::size_t f = 0; f < free_.size(); ++f)
            effects_[f] = std::max(effects_[f], changes.col(index(f)).cwiseAbs().maxCoeff());
    };
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        const Piece& piece = pieces_[k];
        CyclicSystem::Block& block = system_.block(k);
        const double time_scale = scales_[index(duration_of(k))];
        // (x, T, p) -> end -> after
        const Eigen::MatrixXd jump = piece.jump.leftCols(n);
        const Eigen::MatrixXd by_start = jump * piece.flow.leftCols(n);
        const Eigen::VectorXd by_time = jump * piece.field;
        Eigen::MatrixXd by_parameters = jump * piece.flow.rightCols(q) + piece.jump.rightCols(q);
        block.own.setZero();
        block.next.setZero();
        block.next.bottomRows(n).setIdentity();
        if (piece.last) {
            const Eigen::RowVectorXd gradient = piece.condition.head(n).transpose();
            Eigen::RowVectorXd row(n + 1 + q);
            row.head(n) = gradient * piece.flow.leftCols(n) * state_scales.asDiagonal();
            row[n] = gradient.dot(piece.field) * time_scale;
            const Eigen::RowVectorXd by_parameter =
                gradient * piece.flow.rightCols(q) + piece.condition.tail(q).transpose();
            row.tail(q) = by_parameter * parameter_scales.asDiagonal();
            // Event functions have units of their own: measured by how much they change along the scales.
            const double size = gradient.cwiseAbs() * state_scales;
            const double unit = size > 0 ? size : 1;
            note_effects(Eigen::MatrixXd(by_parameter / unit));
            block.own.row(0) = row.head(n + 1) / unit;
            block.parameters.row(0) = row.tail(q) / unit;
            block.right[0] = -piece.condition_value / unit;
        } else {
            block.own(0, n) = 1;
            block.parameters.row(0).setZero();
            block.right[0] = (piece.fixed_duration - unknowns[index(duration_of(k))]) / time_scale;
        }
        const std::size_t following = k + 1 < pieces_.size() ? k + 1 : 0;
        Eigen::VectorXd defect(n);
        for (std::size_t i = 0; i < n_; ++i) {
            double difference = unknowns[index(start_of(following) + i)] - piece.after[i];
            if (periods_[i] > 0) {
                const double turns = std::round(difference / periods_[i]);
                difference -= turns * periods_[i];
                by_parameters.row(index(i)) += turns * period_rates_.row(index(i));
            }
            defect[index(i)] = difference / state_scales[index(i)];
        }
        for (std::size_t i = 0; i < n_; ++i) {
            bool unchanged = by_time[index(i)] == 0 && defect[index(i)] == 0 && by_parameters.row(index(i)).isZero(0);
            for (std::size_t j = 0; j < n_ && unchanged; ++j)
                unchanged = by_start(index(i), index(j)) == (i == j ? 1 : 0);
            neutral_[i] = neutral_[i] && unchanged;
        }
        const Eigen::VectorXd units = state_scales.cwiseInverse();
        note_effects(Eigen::MatrixXd(units.asDiagonal() * by_parameters));
        block.own.block(1, 0, n, n) = -(units.asDiagonal() * by_start * state_scales.asDiagonal());
        block.own.block(1, n, n, 1) = -units.cwiseProduct(by_time) * time_scale;
        block.parameters.bottomRows(n) = -(units.asDiagonal() * by_parameters * parameter_scales.asDiagonal());
        block.right.tail(n) = -defect;
    }
}

/// Instead of being closed, pinned states are held at their first value.
void Shooting::pin(const Eigen::VectorXd& unknowns) {
    CyclicSystem::Block& block = system_.block(pieces_.size() - 1);
    active_.clear();
    for (std::size_t i = 0; i < n_; ++i) {
        if (!neutral_[i] && !model().states[i].drifting) {
            active_.push_back(i);
            continue;
        }
        const auto row = index(i) + 1;
        block.own.row(row).setZero();
        block.parameters.row(row).setZero();
        block.next.row(row).setZero();
        block.next(row, index(i)) = 1;
        block.right[row] = (reference_[i] - unknowns[index(i)]) / scales_[index(i)];
    }
}

bool Shooting::solve(const Eigen::MatrixXd& borders, const Eigen::VectorXd& right, bool homogeneous,
                     Eigen::VectorXd& step, double* determinant) const {
    const Eigen::MatrixXd scaled = borders * scales_.asDiagonal();
    if (!system_.solve(scaled, right, homogeneous, step, determinant))
        return false;
    step = step.cwiseProduct(scales_);
    return true;
}

bool Shooting::null_vector(const Eigen::RowVectorXd& row, Eigen::VectorXd& vector) const {
    const Eigen::MatrixXd borders = row * scales_.asDiagonal();
    if (!system_.null_vector(borders / borders.norm(), vector))
        return false;
    const double size = vector.norm();
    if (!(size > 0))
        return false;
    vector = vector.cwiseProduct(scales_) / size;
    return true;
}

Eigen::RowVectorXd Shooting::row_at_end(std::size_t k, const Eigen::VectorXd& gradient) const {
    const auto n = index(n_), q = index(free_.size());
    const Piece& piece = pieces_[k];
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(index(pieces_.size() * (n_ + 1) + free_.size()));
    const Eigen::RowVectorXd by_state = gradient.head(n).transpose();
    row.segment(index(start_of(k)), n) = by_state * piece.flow.leftCols(n);
    row[index(duration_of(k))] = by_state.dot(piece.field);
    row.tail(q) = by_state * piece.flow.rightCols(q) + gradient.tail(q).transpose();
    return row;
}

double Shooting::rate_at_end(std::size_t segment) const {
    const Piece& piece = pieces_[last_piece(segment)];
    return piece.condition.head(index(n_)).dot(piece.field);
}

double Shooting::usual_rate(std::size_t segment) const {
    const std::size_t k = last_piece(segment);
    double change = 0;
    for (const std::size_t i : active_)
        change += std::abs(pieces_[k].condition[index(i)]) * scales_[index(i)];
    return change / scales_[index(duration_of(k))];
}

} // namespace graze
