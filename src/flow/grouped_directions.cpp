#include "flow/grouped_directions.hpp"

#include "graze/base/require.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

namespace graze {

namespace {

using Lists = std::vector<std::vector<std::size_t>>;

/// Number of columns that are multiplied together: their sums stay in registers.
constexpr std::size_t block = 16;

/// Returns for each state those whose rates depend on it.
Lists dependents_of(const TangentEquations& equations) {
    Lists result(equations.states), sources(equations.intermediates);
    const std::size_t first_intermediate = equations.states + equations.parameters;
    const auto sorted = [](std::vector<std::size_t>& list) {
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    for (const TangentEntry& entry : equations.entries) {
        const auto add = [&](std::size_t state) {
            if (entry.row < equations.intermediates)
                sources[entry.row].push_back(state);
            else
                result[state].push_back(entry.row - equations.intermediates);
        };
        if (entry.source < equations.states)
            add(entry.source);
        else if (entry.source >= first_intermediate) {
            std::vector<std::size_t> through = sources[entry.source - first_intermediate];
            sorted(through);
            for (const std::size_t state : through)
                add(state);
        }
    }
    for (std::vector<std::size_t>& one : result)
        sorted(one);
    return result;
}

/// Returns for each state those that are at most as many couplings away; none if they are too many together.
std::optional<Lists> reaches_of(const Lists& dependents, int couplings, std::size_t most) {
    Lists result(dependents.size());
    std::vector<std::size_t> seen(dependents.size(), dependents.size());
    std::size_t all = 0;
    for (std::size_t state = 0; state < dependents.size(); ++state) {
        std::vector<std::size_t>& reach = result[state];
        reach = {state};
        seen[state] = state;
        std::size_t begin = 0;
        for (int k = 0; k < couplings && begin < reach.size(); ++k) {
            const std::size_t end = reach.size();
            for (; begin < end; ++begin)
                for (const std::size_t next : dependents[reach[begin]])
                    if (std::exchange(seen[next], state) != state)
                        reach.push_back(next);
        }
        all += reach.size();
        if (all > most)
            return std::nullopt;
    }
    return result;
}

/// Assigns each state to the first group whose reaches do not overlap its own. @return number of groups
std::size_t group(const Lists& reaches, std::vector<std::size_t>& group_of) {
    std::vector<std::vector<char>> taken;
    for (const std::vector<std::size_t>& reach : reaches) {
        const auto fits = [&](const std::vector<char>& by) {
            return std::ranges::none_of(reach, [&](std::size_t state) { return by[state] != 0; });
        };
        auto place = std::ranges::find_if(taken, fits);
        if (place == taken.end())
            place = taken.insert(taken.end(), std::vector<char>(reaches.size(), 0));
        for (const std::size_t state : reach)
            (*place)[state] = 1;
        group_of.push_back(static_cast<std::size_t>(place - taken.begin()));
    }
    return taken.size();
}

struct Factor {
    double value;
    const double* row;
};

/// Sums products of rows in some columns.
template <std::size_t count>
void sum_of_products(std::span<const Factor> factors, std::size_t first, double* result) {
    double sums[count] = {};
    for (const Factor& factor : factors)
        for (std::size_t c = 0; c < count; ++c)
            sums[c] += factor.value * factor.row[first + c];
    std::copy_n(sums, count, result + first);
}

} // namespace

std::unique_ptr<GroupedDirections> GroupedDirections::of(const System& system, std::size_t mode, double tolerance,
                                                         int order, std::span<const std::size_t> starts,
                                                         std::span<const ParameterId> free) {
    // The product of the steps takes time as well, and small models fit into the nearest cache.
    constexpr std::size_t fewest_states = 128, least_gain = 2;
    if (starts.size() < fewest_states)
        return nullptr;
    const std::size_t most = starts.size() / least_gain;
    const auto reaches = reaches_of(dependents_of(system.linear(mode).equations), order, most * system.states());
    if (!reaches)
        return nullptr;
    std::vector<std::size_t> group_of;
    const std::size_t groups = group(*reaches, group_of);
    if (groups > most)
        return nullptr;
    return std::unique_ptr<GroupedDirections>(
        new GroupedDirections(system, tolerance, *reaches, group_of, groups, starts, free));
}

GroupedDirections::GroupedDirections(const System& system, double tolerance, const Reaches& reaches,
                                     const std::vector<std::size_t>& group_of, std::size_t groups,
                                     std::span<const std::size_t> starts, std::span<const ParameterId> free)
    : states_(system.states()), groups_(groups), free_(free.size()), columns_(starts.size() + free.size()),
      words_((columns_ + 64 * block - 1) / (64 * block)), steps_(system, tolerance, groups + free.size()),
      starts_(starts.begin(), starts.end()) {
    const std::size_t together = groups + free_;
    parameter_seeds_.assign(system.parameters() * together, 0.0);
    for (std::size_t f = 0; f < free_; ++f)
        parameter_seeds_[free[f].place() * together + groups + f] = 1;
    seeds_.assign(states_ * together, 0.0);
    at_end_.resize(seeds_.size());
    std::vector<std::vector<Place>> rows(states_);
    for (std::size_t state = 0; state < states_; ++state) {
        seeds_[state * together + group_of[state]] = 1;
        for (const std::size_t reached : reaches[state])
            rows[reached].push_back({state, group_of[state]});
    }
    for (const std::vector<Place>& row : rows) {
        row_starts_.push_back(places_.size());
        places_.insert(places_.end(), row.begin(), row.end());
    }
    row_starts_.push_back(places_.size());
    filled_after_.resize(states_ * words_);
    begin();
}

void GroupedDirections::begin() {
    filled_.assign(states_ * words_, 0);
    const auto fill = [&](std::size_t state, std::size_t column) {
        filled_[state * words_ + column / (64 * block)] |= std::uint64_t{1} << (column / block % 64);
    };
    for (std::size_t d = 0; d < starts_.size(); ++d)
        fill(starts_[d], d);
    for (std::size_t state = 0; state < states_; ++state)
        for (std::size_t f = 0; f < free_; ++f)
            fill(state, starts_.size() + f);
}

void GroupedDirections::multiply(std::span<const double> before, std::span<double> after) {
    require_size(before.size(), states_ * columns_, "derivatives");
    require_size(after.size(), states_ * columns_, "derivatives");
    const std::size_t together = groups_ + free_;
    std::fill(filled_after_.begin(), filled_after_.end(), 0);
    std::vector<Factor> factors;
    for (std::size_t i = 0; i < states_; ++i) {
        factors.clear();
        std::uint64_t* const filled = &filled_after_[i * words_];
        for (std::size_t p = row_starts_[i]; p < row_starts_[i + 1]; ++p) {
            const auto [state, group] = places_[p];
            factors.push_back({at_end_[i * together + group], &before[state * columns_]});
            for (std::size_t w = 0; w < words_; ++w)
                filled[w] |= filled_[state * words_ + w];
        }
        double* const row = &after[i * columns_];
        std::fill_n(row, columns_, 0.0);
        for (std::size_t w = 0; w < words_; ++w)
            for (std::uint64_t left = filled[w]; left != 0; left &= left - 1) {
                std::size_t first = (64 * w + static_cast<std::size_t>(std::countr_zero(left))) * block;
                if (first + block <= columns_)
                    sum_of_products<block>(factors, first, row);
                else
                    for (; first < columns_; ++first)
                        sum_of_products<1>(factors, first, row);
            }
        for (std::size_t f = 0; f < free_; ++f)
            row[starts_.size() + f] += at_end_[i * together + groups_ + f];
    }
    filled_.swap(filled_after_);
}

} // namespace graze
