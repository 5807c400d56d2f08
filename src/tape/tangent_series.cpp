#include "tape/tangent_series.hpp"

#include "graze/base/require.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

namespace graze {

namespace {

constexpr int unbounded = std::numeric_limits<int>::max();

int limited(int degree) {
    return degree > low_degree ? unbounded : degree;
}
int sum_of(int a, int b) {
    return a == unbounded || b == unbounded ? unbounded : limited(a + b);
}

int degree_of(const Tape& tape, std::size_t deferred) {
    const Tape::Location& location = tape.deferred[deferred];
    if (location.constant)
        return 0;
    const std::uint32_t degree = tape.degrees[location.index];
    return degree == Tape::unbounded ? unbounded : static_cast<int>(degree);
}

/// Marks parameters that no direction changes: they have no row.
constexpr std::size_t no_row = std::numeric_limits<std::size_t>::max();

std::size_t rows_of(const TangentEquations& equations, std::span<const char> moving) {
    return equations.states + equations.intermediates +
           static_cast<std::size_t>(std::count_if(moving.begin(), moving.end(), [](char one) { return one != 0; }));
}

} // namespace

TangentSeries::TangentSeries(const Tape& tape, const TangentEquations& equations, const Jet& like,
                             std::span<const char> moving, std::size_t directions, InstructionSet set)
    : kernels_(tangent_kernels(directions, set)), states_(equations.states), parameters_(equations.parameters),
      intermediates_(equations.intermediates), width_(static_cast<std::size_t>(kernels_.width)), order_(like.order()),
      size_((static_cast<std::size_t>(order_) + 1) * width_), parameter_rows_(parameters_, no_row),
      numbers_(rows_of(equations, moving) * size_), degrees_(states_, order_), times_(width_) {
    require_size(moving.size(), parameters_, "parameters");
    require_size(static_cast<std::size_t>(like.width()), 1, "lanes of a jet");
    for (std::size_t j = 0; j < parameters_; ++j)
        if (moving[j] != 0) {
            parameter_rows_[j] = states_ + intermediates_ + moving_.size();
            moving_.push_back(j);
        }
    for (std::size_t i = 0; i < states_; ++i)
        series_.push_back({state(i), width_});
    find_rows(tape, equations, like);
}

std::size_t TangentSeries::row_of_source(std::size_t source) const {
    if (source < states_)
        return source;
    source -= states_;
    return source < parameters_ ? parameter_rows_[source] : states_ + source - parameters_;
}

/// Returns the degrees in time of the changes of all sources, by iteration: degrees only grow, up to a fixed point.
std::vector<int> TangentSeries::degrees_of_rows(const Tape& tape, const TangentEquations& equations) const {
    std::vector<int> degrees(states_ + intermediates_ + moving_.size(), 0);
    for (bool changed = true; changed;) {
        changed = false;
        for (const TangentEntry& entry : equations.entries) {
            require_index(entry.row, intermediates_ + states_, "row");
            require_index(entry.source, states_ + parameters_ + intermediates_, "source");
            require_index(entry.deferred, tape.deferred.size(), "deferred expression");
            const std::size_t from = row_of_source(entry.source);
            if (from == no_row)
                continue;
            const bool is_rate = entry.row >= intermediates_;
            const std::size_t to = is_rate ? entry.row - intermediates_ : states_ + entry.row;
            const int product = sum_of(degree_of(tape, entry.deferred), degrees[from]),
                      degree = is_rate ? sum_of(product, 1) : product;
            if (degree > degrees[to]) {
                degrees[to] = degree;
                changed = true;
            }
        }
    }
    return degrees;
}

/// Sorts the terms of a row by the kind of product.
TangentRow TangentSeries::row_of(std::size_t row, std::span<const TangentTerm> terms) {
    std::array<std::vector<TangentTerm>, 4> kinds;
    for (const TangentTerm& term : terms) {
        const bool lasts = term.degree == unbounded, source_lasts = term.source_degree == unbounded;
        kinds[term.degree == 0                   ? 0
              : lasts && term.source_degree == 0 ? 1
              : lasts && source_lasts            ? 3
                                                 : 2]
            .push_back(term);
    }
    std::array<const TangentTerm*, 5> places{terms_.data() + terms_.size()};
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        terms_.insert(terms_.end(), kinds[kind].begin(), kinds[kind].end());
        places[kind + 1] = places[kind] + kinds[kind].size();
    }
    const bool is_rate = row >= intermediates_;
    return {(is_rate ? row - intermediates_ : states_ + row) * size_,
            is_rate,
            places[0],
            places[1],
            places[2],
            places[3],
            places[4]};
}

void TangentSeries::find_rows(const Tape& tape, const TangentEquations& equations, const Jet& like) {
    const std::vector<int> degrees = degrees_of_rows(tape, equations);
    terms_.reserve(equations.entries.size()); // rows point to elements
    auto entry = equations.entries.begin();
    for (std::size_t row = 0; row < intermediates_ + states_; ++row) {
        std::vector<TangentTerm> terms;
        for (; entry != equations.entries.end() && entry->row == row; ++entry)
            if (const std::size_t from = row_of_source(entry->source); from != no_row)
                terms.push_back({like.deferred(entry->deferred) - like.state(0), from * size_,
                                 degree_of(tape, entry->deferred), degrees[from]});
        rows_.push_back(row_of(row, terms));
    }
    require_size(static_cast<std::size_t>(equations.entries.end() - entry), 0, "entries behind the last row");
    // Intermediate quantities of low degree depend only on others of low degree, and come before the rest. Rates do not
    // depend on each other: rows of the same kind are adjacent, which helps branch prediction.
    const auto lasts = [&](const TangentRow& row) { return degrees[row.result / size_] == unbounded; };
    const auto rates = rows_.begin() + static_cast<std::ptrdiff_t>(intermediates_);
    const auto lasting = std::stable_partition(rows_.begin(), rates, std::not_fn(lasts));
    const auto shape = [&](const TangentRow& row) {
        return std::tuple(lasts(row), row.end - row.many, row.many - row.few, row.few - row.still,
                          row.still - row.fixed);
    };
    std::stable_sort(rates, rows_.end(), [&](const TangentRow& a, const TangentRow& b) { return shape(a) > shape(b); });
    const auto lasting_end = std::partition_point(rates, rows_.end(), lasts);
    const TangentRow* first = rows_.data();
    operands_ = {first, first + (lasting - rows_.begin()), first + (lasting_end - rows_.begin()), first + rows_.size(),
                 numbers_.data()};
    for (std::size_t i = 0; i < states_; ++i) {
        degrees_[i] = std::clamp(degrees[i], 1, order_);
        if (degrees_[i] >= order_ - 1)
            followed_.push_back(i);
    }
}

void TangentSeries::load(std::span<const double> matrix, std::span<const double> seeds, std::size_t directions,
                         std::size_t first, std::size_t count) {
    require_index(count, width_ + 1, "number of directions");
    require_size(matrix.size(), states_ * directions, "derivatives");
    require_size(seeds.size(), parameters_ * directions, "directions of parameters");
    const std::size_t filled = std::max(count, count_); // higher lanes are zero already
    count_ = count;
    const auto load_row = [&](std::size_t to, const double* from) {
        double* numbers = numbers_.data() + to * size_;
        for (std::size_t d = 0; d < count; ++d)
            numbers[d] = from[d];
        for (std::size_t d = count; d < filled; ++d)
            numbers[d] = 0;
    };
    for (std::size_t i = 0; i < states_; ++i)
        load_row(i, matrix.data() + i * directions + first);
    for (const std::size_t j : moving_)
        load_row(parameter_rows_[j], seeds.data() + j * directions + first);
}

void TangentSeries::load(std::span<const double> states, const TangentSeries& parameters) {
    require_room(states.size(), states_ * width_, "changes of states");
    count_ = parameters.count_;
    for (std::size_t i = 0; i < states_; ++i)
        std::copy_n(&states[i * width_], width_, numbers_.data() + i * size_);
    for (const std::size_t j : moving_)
        std::copy_n(parameters.numbers_.data() + parameters.parameter_rows_[j] * size_, width_,
                    numbers_.data() + parameter_rows_[j] * size_);
}

void TangentSeries::compute(const Jet& jet) {
    kernels_.compute(operands_, jet.state(0), order_);
}

void TangentSeries::begin(const Jet& jet) {
    kernels_.compute(operands_, jet.state(0), 1);
}

const double* TangentSeries::source(std::size_t index) const {
    const std::size_t row = row_of_source(index);
    return row == no_row ? nullptr : numbers_.data() + row * size_;
}

void TangentSeries::evaluate(double time, std::span<double> values, std::span<double> slopes) {
    require_room(values.size(), states_ * width_, "changes of states");
    require_room(slopes.size(), states_ * width_, "changes of states");
    std::fill(times_.begin(), times_.end(), time);
    kernels_.sums_and_slopes(series_.data(), degrees_.data(), states_, times_.data(), values.data(), slopes.data());
}

double TangentSeries::tails(double step, std::span<const double> floors) const {
    if (!floors.empty())
        require_room(floors.size(), states_ * width_, "floors of changes");
    if (order_ < 2)
        return 0; // the order is too low for a test
    return kernels_.tails(in_use(), step, floors.empty() ? nullptr : floors.data());
}

std::size_t TangentSeries::find_misfit(const TangentSeries& end, const EndAllowance& allowance, double length,
                                       std::span<const double> values, std::span<const double> slopes,
                                       std::size_t from) const {
    require_size(end.size_, size_, "coefficients of series");
    require_size(end.states_, states_, "states");
    require_room(values.size(), states_ * width_, "changes of states");
    require_room(slopes.size(), states_ * width_, "changes of states");
    return kernels_.misfit(
        in_use(),
        {end.numbers_.data(), values.data(), slopes.data(), std::abs(length), allowance.rates, allowance.smallest},
        from);
}

} // namespace graze
