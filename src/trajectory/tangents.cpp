#include "trajectory/tangents.hpp"

#include "graze/flow/tangent_reach.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// What derivatives are allowed of the tolerance of the states: what is cut off is far smaller than the last terms.
constexpr double allowance = 100;

} // namespace

Tangents::Tangents(const Simulation& simulation, std::span<const double> parameters, std::span<const double> seeds,
                   std::size_t directions)
    : states_(simulation.system().states()), parameter_count_(parameters.size()), directions_(directions),
      tolerance_(allowance * simulation.options().tolerance), jets_(simulation, LaneKind::tangent),
      lanes_(static_cast<std::size_t>(jets_.width()) - 1), parameters_(parameters.begin(), parameters.end()),
      parameter_seeds_(parameter_count_ * directions), matrix_(states_ * directions), next_(states_ * directions),
      seeds_(states_ * (lanes_ + 1)), sums_(std::max<std::size_t>(states_, 1) * (lanes_ + 1)), slopes_(sums_.size()),
      parameter_lanes_(parameter_count_ * (lanes_ + 1)) {
    for (std::size_t d = 0; d < directions; ++d) {
        const auto seed = seeds.subspan(d * (states_ + parameter_count_), states_ + parameter_count_);
        for (std::size_t i = 0; i < states_; ++i)
            matrix_[i * directions + d] = seed[i];
        for (std::size_t j = 0; j < parameter_count_; ++j)
            parameter_seeds_[j * directions + d] = seed[states_ + j];
    }
    if (directions_ <= lanes_) {
        fill(parameter_lanes_, parameters_, parameter_seeds_, 0);
        jets_.set_parameters(parameter_lanes_);
    }
}

void Tangents::fill(std::span<double> lanes, std::span<const double> values, std::span<const double> tangents,
                    std::size_t first) const {
    const std::size_t width = lanes_ + 1, count = std::min(lanes_, directions_ - first);
    for (std::size_t i = 0; i < values.size(); ++i) {
        lanes[i * width] = values[i];
        for (std::size_t l = 0; l < lanes_; ++l)
            lanes[i * width + 1 + l] = l < count ? tangents[i * directions_ + first + l] : 0.0;
    }
}

const Jet& Tangents::compute(std::size_t mode, std::span<const double> state, std::span<const double> matrix,
                             std::size_t first) {
    if (directions_ > lanes_) {
        fill(parameter_lanes_, parameters_, parameter_seeds_, first);
        jets_.set_parameters(mode, parameter_lanes_);
    }
    fill(seeds_, state, matrix, first);
    return jets_.computed(mode, seeds_);
}

double Tangents::step(std::size_t mode, std::span<const double> state, std::span<const double> matrix, double s,
                      std::size_t series, std::span<double> row) {
    const std::size_t width = lanes_ + 1;
    after_.resize(states_ * directions_);
    moved_.resize(states_);
    double step = s;
    for (std::size_t first = 0; first < directions_;) {
        const Jet& jet = compute(mode, state, matrix, first);
        const std::size_t count = std::min(lanes_, directions_ - first);
        const double wanted = tangent_reach(jet, states_, count, tolerance_, step);
        times_.resize(width);
        const double reach =
            follow_tangents(jet, jets_.next(mode), states_, count, tolerance_, wanted, times_, sums_, slopes_);
        if (reach < step) {
            step = reach;
            if (first > 0) { // directions that are done already need the shorter step as well
                first = 0;
                continue;
            }
        }
        for (std::size_t i = 0; i < states_; ++i) {
            std::copy_n(&sums_[i * width + 1], count, &after_[i * directions_ + first]);
            moved_[i] = sums_[i * width];
        }
        if (!row.empty()) {
            jet.evaluate_output(series, times_, sums_);
            std::copy_n(&sums_[1], count, &row[first]);
        }
        first += lanes_;
    }
    return step;
}

void Tangents::evaluate(std::size_t mode, std::span<const double> state, double s, std::span<double> matrix,
                        std::size_t series, std::span<double> row) {
    constexpr int most_parts = 10000;
    std::span<const double> here = state, from = matrix_;
    // In parts, where derivatives are faster than the states.
    for (int part = 0; part < most_parts; ++part) {
        const double length = step(mode, here, from, s, series, row);
        if (!(length < s))
            break;
        s -= length;
        middle_.swap(after_);
        between_.swap(moved_);
        from = middle_;
        here = between_;
    }
    std::copy_n(after_.begin(), matrix.size(), matrix.begin());
}

void Tangents::coefficient(std::size_t mode, std::span<const double> state, std::size_t series, int k,
                           std::span<double> row) {
    const std::size_t width = lanes_ + 1;
    for (std::size_t first = 0; first < directions_; first += lanes_) {
        const Jet& jet = compute(mode, state, matrix_, first);
        for (std::size_t l = 0; l < std::min(lanes_, directions_ - first); ++l)
            row[first + l] = jet.output(series)[static_cast<std::size_t>(k) * width + l + 1];
    }
}

void Tangents::advance(std::size_t mode, std::span<const double> state, double s, std::size_t series,
                       std::span<double> row) {
    evaluate(mode, state, s, next_, series, row);
    matrix_.swap(next_);
}

void Tangents::pass_jump(std::span<const double> shift, std::span<const double> field_before,
                         const System::CompiledJump& jump, std::span<const double> jacobian,
                         std::span<const double> field_after) {
    add_product(field_before, shift);
    for (const std::size_t i : jump.changed)
        std::fill_n(&next_[i * directions_], directions_, 0.0);
    for (std::size_t k = 0; k < jump.entries.size(); ++k) {
        const double entry = jacobian[k];
        if (entry == 0)
            continue;
        const auto [i, j] = jump.entries[k];
        const double* from = j < states_ ? &matrix_[j * directions_] : &parameter_seeds_[(j - states_) * directions_];
        for (std::size_t d = 0; d < directions_; ++d)
            next_[i * directions_ + d] += entry * from[d];
    }
    for (const std::size_t i : jump.changed)
        std::copy_n(&next_[i * directions_], directions_, &matrix_[i * directions_]);
    for (std::size_t i = 0; i < states_; ++i)
        for (std::size_t d = 0; d < directions_; ++d)
            matrix_[i * directions_ + d] -= field_after[i] * shift[d];
}

void Tangents::add_product(std::span<const double> column, std::span<const double> row) {
    for (std::size_t i = 0; i < states_; ++i)
        for (std::size_t d = 0; d < directions_; ++d)
            matrix_[i * directions_ + d] += column[i] * row[d];
}

} // namespace graze
