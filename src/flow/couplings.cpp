#include "flow/couplings.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/require.hpp"
#include "tape/tape_analysis.hpp"

#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace graze {

namespace {

/// Returns the states on which each register depends, sorted.
std::vector<std::vector<std::size_t>> dependences_of(const Tape& tape) {
    std::vector<std::vector<std::size_t>> all(tape.registers);
    for (std::size_t i = 0; i < tape.states; ++i)
        all[i] = {i};
    std::vector<std::size_t> merged;
    // Some registers are read by instructions that precede their own.
    for (bool grows = true; grows;) {
        grows = false;
        for (const Instruction& instruction : tape.code) {
            std::vector<std::size_t>& own = all[instruction.result];
            visit_operands(tape, instruction, [&](std::uint32_t operand) {
                if (all[operand].empty() || operand == instruction.result)
                    return;
                merged.clear();
                std::set_union(own.begin(), own.end(), all[operand].begin(), all[operand].end(),
                               std::back_inserter(merged));
                grows = grows || merged.size() > own.size();
                own.swap(merged);
            });
        }
    }
    return all;
}

/// Returns the degree of each register as a polynomial in the states; infinite if it is not one.
std::vector<double> degrees_in_states(const Tape& tape) {
    std::vector<double> degrees(tape.registers, infinity);
    std::fill_n(degrees.begin(), tape.states, 1.0);
    for (const Instruction& instruction : tape.code) {
        double degree = infinity;
        if (instruction.operation == SeriesOperation::linear_combination) {
            degree = 0;
            for (std::uint32_t t = instruction.left; t != instruction.right; ++t)
                degree = std::max(degree, degrees[tape.terms[t].series]);
        } else if (instruction.operation == SeriesOperation::multiply) {
            degree = degrees[instruction.left] + degrees[instruction.right];
        } else if (instruction.operation == SeriesOperation::square) {
            degree = 2 * degrees[instruction.left];
        }
        degrees[instruction.result] = degree;
    }
    return degrees;
}

/// Strongly connected components (Tarjan 1972), with an explicit stack, since chains of states may be long.
class Components {
public:
    template <class Successors>
    Components(std::size_t count, const Successors& successors)
        : numbers_(count, unseen), lowest_(count, 0), component_(count, unseen) {
        for (std::size_t root = 0; root < count; ++root)
            if (numbers_[root] == unseen)
                visit(root, successors);
    }
    std::size_t of(std::size_t node) const { return component_[node]; }

private:
    static constexpr std::size_t unseen = std::numeric_limits<std::size_t>::max();

    template <class Successors>
    void visit(std::size_t root, const Successors& successors) {
        struct Frame {
            std::size_t node, next;
        };
        std::vector<Frame> frames{{root, 0}};
        enter(root);
        while (!frames.empty()) {
            Frame& frame = frames.back();
            const std::size_t node = frame.node, other = successors(node, frame.next);
            if (other == unseen) {
                frames.pop_back();
                leave(node);
                if (!frames.empty())
                    lowest_[frames.back().node] = std::min(lowest_[frames.back().node], lowest_[node]);
            } else {
                ++frame.next;
                if (numbers_[other] == unseen) {
                    enter(other);
                    frames.push_back({other, 0});
                } else if (component_[other] == unseen) {
                    lowest_[node] = std::min(lowest_[node], numbers_[other]);
                }
            }
        }
    }
    void enter(std::size_t node) {
        numbers_[node] = lowest_[node] = seen_++;
        open_.push_back(node);
    }
    void leave(std::size_t node) {
        if (lowest_[node] != numbers_[node])
            return;
        std::size_t member = unseen;
        while (member != node) {
            member = open_.back();
            open_.pop_back();
            component_[member] = node;
        }
    }

    std::vector<std::size_t> numbers_, lowest_, component_, open_;
    std::size_t seen_ = 0;
};

/// Raises the sizes of one state according to another. @return whether any grew substantially
template <std::size_t lanes>
bool raise(double* to, const double* from, double gain) {
    constexpr double much = 1.5;
    int grown = 0;
    for (std::size_t l = 0; l < lanes; ++l) {
        const double before = to[l], moved = gain * from[l];
        to[l] = moved > before ? moved : before;
        grown |= moved > much * before ? 1 : 0;
    }
    return grown != 0;
}

} // namespace

Couplings::Couplings(const System& system, std::size_t mode)
    : states_(system.states()), system_(system), mode_(mode), units_(states_), row_(states_) {
    find_entries(system.mode(mode).tape);
    order_sweeps();
}

Jet& Couplings::jet() {
    if (!jet_) {
        const LinearMode& linear = system_.linear(mode_);
        jet_ = make_jet(linear.tape, 1, LaneKind::single);
        jet_->set_parameters(parameters_);
        intermediates_.resize(linear.equations.intermediates);
    }
    return *jet_;
}

void Couplings::find_entries(const Tape& tape) {
    const std::vector<std::vector<std::size_t>> dependences = dependences_of(tape);
    columns_.resize(states_);
    for (std::size_t i = 0; i < states_; ++i) {
        row_starts_.push_back(entries_.size());
        if (tape.rates[i].constant)
            continue;
        for (const std::size_t k : dependences[tape.rates[i].index]) {
            columns_[k].push_back(entries_.size());
            entries_.push_back({i, k});
        }
    }
    row_starts_.push_back(entries_.size());
    vanishing_.assign(entries_.size(), false);
    find_constants(tape);
}

/// Finds the entries that are constant in state space: of states that occur in a rate only as terms of its sum.
void Couplings::find_constants(const Tape& tape) {
    constexpr double highest_degree = 4;
    const std::vector<std::vector<std::size_t>> dependences = dependences_of(tape);
    const std::vector<double> degrees = degrees_in_states(tape);
    std::vector<const Instruction*> sums(tape.registers, nullptr);
    for (const Instruction& instruction : tape.code)
        if (instruction.operation == SeriesOperation::linear_combination)
            sums[instruction.result] = &instruction;
    steady_.assign(states_, false);
    std::vector<bool> in_sum(states_), elsewhere(states_);
    for (std::size_t i = 0; i < states_; ++i) {
        const std::uint32_t rate = tape.rates[i].index;
        if (tape.rates[i].constant || !(degrees[rate] <= highest_degree))
            continue;
        std::fill(in_sum.begin(), in_sum.end(), false);
        std::fill(elsewhere.begin(), elsewhere.end(), false);
        const auto note = [&](std::uint32_t from) {
            if (from < states_)
                in_sum[from] = true;
            else
                for (const std::size_t state : dependences[from])
                    elsewhere[state] = true;
        };
        if (sums[rate])
            for (std::uint32_t t = sums[rate]->left; t != sums[rate]->right; ++t)
                note(tape.terms[t].series);
        else
            note(rate);
        for (std::size_t e = row_starts_[i]; e < row_starts_[i + 1]; ++e) {
            Entry& entry = entries_[e];
            entry.constant = in_sum[entry.column] && !elsewhere[entry.column];
            steady_[i] = steady_[i] || (entry.constant && entry.column != i);
        }
    }
}

void Couplings::set_parameters(std::span<const double> parameters) {
    require_size(parameters.size(), system_.parameters(), "independent parameters");
    parameters_.assign(parameters.begin(), parameters.end());
    if (jet_)
        jet_->set_parameters(parameters_);
}

/// Computes the entries row by row, intermediate quantities first.
void Couplings::find_strengths() {
    const TangentEquations& equations = system_.linear(mode_).equations;
    std::vector<std::size_t> columns; // columns with nonzero entries
    auto entry = equations.entries.begin();
    const auto add = [&](std::size_t column, double value) {
        row_[column] += value;
        columns.push_back(column);
    };
    for (std::size_t row = 0; row < intermediates_.size() + states_; ++row) {
        for (; entry != equations.entries.end() && entry->row == row; ++entry) {
            const double value = *jet_->deferred(entry->deferred);
            if (entry->source < states_)
                add(entry->source, value);
            else if (entry->source >= states_ + equations.parameters)
                for (const Part& part : intermediates_[entry->source - states_ - equations.parameters])
                    add(part.column, value * part.value);
        }
        if (row < intermediates_.size()) {
            intermediates_[row].clear();
            for (const std::size_t column : columns)
                if (const double value = std::exchange(row_[column], 0.0); value != 0)
                    intermediates_[row].push_back({column, value});
        } else {
            const std::size_t state = row - intermediates_.size();
            for (std::size_t e = row_starts_[state]; e < row_starts_[state + 1]; ++e)
                entries_[e].strength = std::abs(row_[entries_[e].column]);
            for (const std::size_t column : columns)
                row_[column] = 0;
        }
        columns.clear();
    }
}

void Couplings::measure(std::span<const double> states) {
    require_size(states.size(), states_, "states");
    constexpr std::uint32_t groups[] = {LinearMode::by_states};
    jet().begin(states);
    jet().begin_deferred(groups);
    find_strengths();
    const bool finite =
        std::all_of(entries_.begin(), entries_.end(), [](const Entry& e) { return std::isfinite(e.strength); });
    if (!finite) {
        response_time_ = 0;
        return;
    }
    find_cycles();
    balance();
    response_time_ = 1 / largest_row();
}

/// Finds the entries in cycles of states that act on each other; changes only where entries vanish or cease to vanish.
void Couplings::find_cycles() {
    bool changed = std::exchange(fresh_, false);
    for (std::size_t e = 0; e < entries_.size(); ++e)
        if (const bool vanishing = entries_[e].strength == 0; vanishing != vanishing_[e]) {
            vanishing_[e] = vanishing;
            changed = true;
        }
    if (!changed)
        return;
    const Components components(states_, [this](std::size_t node, std::size_t& next) {
        const std::vector<std::size_t>& out = columns_[node];
        while (next < out.size() && entries_[out[next]].strength == 0)
            ++next;
        return next < out.size() ? entries_[out[next]].row : std::numeric_limits<std::size_t>::max();
    });
    for (Entry& entry : entries_)
        entry.returns = entry.strength != 0 && components.of(entry.row) == components.of(entry.column);
    sort_cycles();
}

void Couplings::sort_cycles() {
    for (Sorted* sorted : {&in_rows_, &in_columns_})
        *sorted = {{0}, {}, {}, {}};
    for (std::size_t i = 0; i < states_; ++i) {
        for (std::size_t e = row_starts_[i]; e < row_starts_[i + 1]; ++e)
            if (entries_[e].returns && entries_[e].column != i) {
                in_rows_.entries.push_back(e);
                in_rows_.others.push_back(entries_[e].column);
            }
        for (const std::size_t e : columns_[i])
            if (entries_[e].returns && entries_[e].row != i) {
                in_columns_.entries.push_back(e);
                in_columns_.others.push_back(entries_[e].row);
            }
        in_rows_.starts.push_back(in_rows_.entries.size());
        in_columns_.starts.push_back(in_columns_.entries.size());
    }
}

void Couplings::Sorted::note_strengths(const std::vector<Entry>& all) {
    strengths.resize(entries.size());
    std::ranges::transform(entries, strengths.begin(), [&](std::size_t e) { return all[e].strength; });
}

/// Scales the states until, within each cycle, the row and column of each state are about equally large. It starts from
/// unit scales at each point, so that the result does not depend on earlier measurements.
void Couplings::balance() {
    constexpr int most_sweeps = 20;
    constexpr double close = 1.5; // closer balance hardly improves the bound
    std::fill(units_.begin(), units_.end(), 1.0);
    in_rows_.note_strengths(entries_);
    in_columns_.note_strengths(entries_);
    bool moved = true;
    for (int sweep = 0; sweep < most_sweeps && moved; ++sweep) {
        moved = false;
        for (std::size_t i = 0; i < states_; ++i) {
            double row = 0, column = 0;
            for (std::size_t n = in_rows_.starts[i]; n < in_rows_.starts[i + 1]; ++n)
                row += in_rows_.strengths[n] * units_[in_rows_.others[n]];
            for (std::size_t n = in_columns_.starts[i]; n < in_columns_.starts[i + 1]; ++n)
                column += in_columns_.strengths[n] / units_[in_columns_.others[n]];
            const double unit = std::sqrt(row / column);
            if (!(unit > 0 && std::isfinite(unit)))
                continue;
            moved = moved || unit > close * units_[i] || units_[i] > close * unit;
            units_[i] = unit;
        }
    }
}

/// Returns the largest row sum in these units.
double Couplings::largest_row() const {
    double most = 0;
    for (std::size_t i = 0; i < states_; ++i) {
        double row = 0;
        for (std::size_t e = row_starts_[i]; e < row_starts_[i + 1]; ++e)
            if (entries_[e].returns)
                row += entries_[e].strength * units_[entries_[e].column];
        row /= units_[i];
        most = std::isnan(row) ? infinity : std::max(most, row);
    }
    return most;
}

/// States are usually numbered along the chain that they form, so sweeps alternate between rising and falling order.
/// Raised sizes are used at once: one sweep traverses a chain, even with positions and speeds alternating.
void Couplings::order_sweeps() {
    for (const bool up : {true, false}) {
        std::vector<Coupling>& order = sweeps_[up ? 0 : 1];
        order.reserve(2 * entries_.size());
        const auto add = [&](std::size_t e) {
            if (entries_[e].row != entries_[e].column)
                order.push_back({entries_[e].row, entries_[e].column, e});
        };
        for (std::size_t n = 0; n < states_; ++n) {
            const std::size_t i = up ? n : states_ - 1 - n;
            for (std::size_t e = row_starts_[i]; e < row_starts_[i + 1]; ++e)
                add(e);
            for (const std::size_t e : columns_[i])
                if (up ? entries_[e].row < i : entries_[e].row > i)
                    add(e);
        }
    }
}

void Couplings::spread(double time, std::span<double> sizes, std::size_t width, Through through) const {
    require_size(sizes.size(), states_ * width, "sizes of states");
    const auto sweep = [&]<std::size_t lanes>(const std::vector<Coupling>& order) {
        bool grown = false;
        for (const Coupling& one : order) {
            const Entry& entry = entries_[one.entry];
            if (through == Through::constant && !entry.constant)
                continue;
            double* const to = &sizes[one.to * width];
            const double* const from = &sizes[one.from * width];
            for (std::size_t l = 0; l < width; l += lanes)
                grown = raise<lanes>(to + l, from + l, time * entry.strength) || grown;
        }
        return grown;
    };
    bool grown = true;
    for (std::size_t count = 0; count <= states_ && grown; ++count) {
        const std::vector<Coupling>& order = sweeps_[count % 2];
        grown = width % 8 == 0   ? sweep.operator()<8>(order)
                : width % 4 == 0 ? sweep.operator()<4>(order)
                : width % 2 == 0 ? sweep.operator()<2>(order)
                                 : sweep.operator()<1>(order);
    }
}

void ModeCouplings::set_parameters(std::span<const double> parameters) {
    parameters_.assign(parameters.begin(), parameters.end());
    for (const auto& couplings : all_)
        if (couplings)
            couplings->set_parameters(parameters_);
}

Couplings& ModeCouplings::of(std::size_t mode) {
    require_index(mode, all_.size(), "mode");
    auto& couplings = all_[mode];
    if (!couplings) {
        couplings = std::make_unique<Couplings>(system_, mode);
        couplings->set_parameters(parameters_);
    }
    return *couplings;
}

const Couplings& ModeCouplings::measured(std::size_t mode, std::span<const double> states) {
    Couplings& couplings = of(mode);
    couplings.measure(states);
    return couplings;
}

} // namespace graze
