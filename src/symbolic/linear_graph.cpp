#include "symbolic/linear_graph.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <queue>

namespace graze {

namespace {

/// Returns the cost of forming a product of two coefficients, which is done once for all directions.
std::size_t cost_of_product(bool one_varies, bool other_varies) {
    if (one_varies && other_varies)
        return Linearisation::varying_cost;
    return one_varies || other_varies ? Linearisation::constant_cost : 0;
}

/// Returns whether the derivatives with respect to the left and right operand vary, given which operands vary.
std::pair<bool, bool> derivatives_vary(Operation operation, bool left_varies, bool right_varies) {
    switch (operation) {
    case Operation::add:
    case Operation::subtract:
    case Operation::negate:
        return {false, false};
    case Operation::multiply:
        return {right_varies, left_varies};
    case Operation::divide:
        return {right_varies, true};
    default:
        return {true, true};
    }
}

} // namespace

LinearGraph::LinearGraph(const Subgraph& part, const std::vector<bool>& has_state, std::size_t directions)
    : cost_of_intermediate_(directions * Linearisation::intermediate_cost),
      cost_of_constant_(directions * Linearisation::constant_cost),
      cost_of_varying_(directions * Linearisation::varying_cost), nodes_(part.items.size()), part_(part) {
    const std::size_t vertices = nodes_ + part.roots.size();
    operands_.resize(vertices);
    users_.resize(vertices);
    operands_left_.resize(vertices);
    users_left_.resize(vertices);
    versions_.resize(vertices);
    reached_.resize(vertices);
    eliminated_.resize(vertices);
    fixed_.resize(vertices, true);
    varies_.reserve(2 * vertices);
    for (Vertex vertex = 0; vertex < nodes_; ++vertex)
        if (has_state[vertex] && arity(part.node(part.items[vertex]).operation) > 0) {
            fixed_[vertex] = false;
            connect_operands(vertex, has_state);
        }
    for (std::size_t root = 0; root < part.roots.size(); ++root)
        if (has_state[part.roots[root]])
            connect(part.roots[root], static_cast<Vertex>(nodes_ + root), false);
}

void LinearGraph::connect_operands(Vertex vertex, const std::vector<bool>& has_state) {
    const Subgraph::Item& item = part_.items[vertex];
    const Operation operation = part_.node(item).operation;
    const bool right_varies = arity(operation) == 2 && has_state[item.right];
    const auto [left, right] = derivatives_vary(operation, has_state[item.left], right_varies);
    if (has_state[item.left])
        connect(item.left, vertex, left);
    if (right_varies)
        connect(item.right, vertex, right);
}

void LinearGraph::connect(Vertex from, Vertex to, bool varies) {
    const auto [found, is_new] = varies_.try_emplace(key(from, to), varies);
    if (!is_new) {
        found->second = found->second || varies;
        return;
    }
    users_[from].push_back(to);
    operands_[to].push_back(from);
    ++users_left_[from];
    ++operands_left_[to];
}

std::vector<LinearGraph::Neighbour> LinearGraph::operands_of(Vertex vertex) {
    std::erase_if(operands_[vertex], [&](Vertex other) { return eliminated_[other]; });
    std::vector<Neighbour> found;
    for (const Vertex other : operands_[vertex])
        found.push_back({other, varies_.at(key(other, vertex))});
    return found;
}

std::vector<LinearGraph::Neighbour> LinearGraph::users_of(Vertex vertex) {
    std::erase_if(users_[vertex], [&](Vertex other) { return eliminated_[other]; });
    std::vector<Neighbour> found;
    for (const Vertex other : users_[vertex])
        found.push_back({other, varies_.at(key(vertex, other))});
    return found;
}

bool LinearGraph::pays(const std::vector<Neighbour>& operands, const std::vector<Neighbour>& users) const {
    std::size_t saved = cost_of_intermediate_;
    for (const auto* neighbours : {&operands, &users})
        for (const Neighbour& neighbour : *neighbours)
            saved += cost_of(neighbour.varies);
    std::size_t spent = 0;
    for (const Neighbour& operand : operands)
        for (const Neighbour& user : users) {
            const bool varies = operand.varies || user.varies;
            spent += cost_of_product(operand.varies, user.varies);
            const auto found = varies_.find(key(operand.vertex, user.vertex));
            if (found == varies_.end())
                spent += cost_of(varies);
            else if (varies && !found->second)
                spent += cost_of_varying_ - cost_of_constant_;
            if (spent > saved)
                return false;
        }
    return true;
}

bool LinearGraph::eliminate_if_it_pays(Vertex vertex) {
    const std::vector<Neighbour> operands = operands_of(vertex), users = users_of(vertex);
    if (!pays(operands, users))
        return false;
    eliminated_[vertex] = true;
    for (const Neighbour& operand : operands)
        --users_left_[operand.vertex];
    for (const Neighbour& user : users)
        --operands_left_[user.vertex];
    for (const Neighbour& operand : operands)
        for (const Neighbour& user : users)
            connect(operand.vertex, user.vertex, operand.varies || user.varies);
    return true;
}

bool LinearGraph::reduce_once() {
    std::priority_queue<Candidate> candidates;
    const auto add = [&](Vertex vertex) {
        if (is_intermediate(vertex))
            candidates.push({products(vertex), vertex, ++versions_[vertex]});
    };
    for (Vertex vertex = 0; vertex < nodes_; ++vertex)
        add(vertex);
    bool any = false;
    while (!candidates.empty()) {
        const Candidate candidate = candidates.top();
        candidates.pop();
        if (candidate.version != versions_[candidate.vertex] || !eliminate_if_it_pays(candidate.vertex))
            continue;
        any = true;
        for (const auto* neighbours : {&operands_[candidate.vertex], &users_[candidate.vertex]})
            for (const Vertex neighbour : *neighbours)
                add(neighbour);
    }
    return any;
}

void LinearGraph::reduce() {
    // Eliminations may make others profitable: a second round is often useful, a third seldom.
    constexpr int most_rounds = 4;
    for (int round = 0; round < most_rounds && reduce_once(); ++round) {
    }
}

std::vector<LinearGraph::Group> LinearGraph::groups(std::vector<std::uint32_t>& group_of) {
    std::vector<Vertex> parents(operands_.size());
    std::iota(parents.begin(), parents.end(), Vertex{0});
    const auto root_of = [&](Vertex vertex) {
        while (parents[vertex] != vertex)
            vertex = parents[vertex] = parents[parents[vertex]];
        return vertex;
    };
    for (Vertex vertex = 0; vertex < nodes_; ++vertex)
        if (is_intermediate(vertex))
            for (const Neighbour& user : users_of(vertex))
                parents[root_of(user.vertex)] = root_of(vertex);
    std::vector<Group> found;
    std::vector<std::optional<std::uint32_t>> numbers(parents.size());
    for (Vertex vertex = 0; vertex < parents.size(); ++vertex) {
        if (vertex < nodes_ && !is_intermediate(vertex))
            continue;
        auto& number = numbers[root_of(vertex)];
        if (!number) {
            number = static_cast<std::uint32_t>(found.size());
            found.emplace_back();
        }
        group_of[vertex] = *number;
        Group& group = found[*number];
        for (const Neighbour& operand : operands_of(vertex))
            group.cost += cost_of(operand.varies);
        if (vertex < nodes_)
            group.cost += cost_of_intermediate_;
        else
            group.functions.push_back(vertex);
    }
    return found;
}

std::size_t LinearGraph::plain_cost(Vertex function, std::size_t& work) {
    std::priority_queue<Vertex> pending; // largest first: users before their operands
    std::vector<Vertex> states;
    std::size_t cost = 0;
    pending.push(function);
    reached_[function] = Reached::constantly;
    while (!pending.empty()) {
        const Vertex vertex = pending.top();
        pending.pop();
        for (const Neighbour& operand : operands_of(vertex)) {
            ++work;
            Reached& reached = reached_[operand.vertex];
            if (reached == Reached::no && is_intermediate(operand.vertex))
                pending.push(operand.vertex);
            else if (reached == Reached::no)
                states.push_back(operand.vertex);
            const bool so_far = reached_[vertex] == Reached::varying;
            cost += cost_of_product(so_far, operand.varies);
            reached = std::max(reached, so_far || operand.varies ? Reached::varying : Reached::constantly);
        }
        reached_[vertex] = Reached::no;
    }
    for (const Vertex state : states)
        cost += cost_of(std::exchange(reached_[state], Reached::no) == Reached::varying);
    return cost;
}

bool LinearGraph::drop_useless() {
    // A group whose elimination costs more than `doubt` times its own cost, or takes more work to evaluate, is kept.
    constexpr std::size_t doubt = 4, patience = 64;
    std::vector<std::uint32_t> group_of(operands_.size());
    const std::vector<Group> all = groups(group_of);
    std::vector<bool> useless(all.size());
    bool doubtful = false;
    for (std::size_t g = 0; g < all.size(); ++g) {
        const std::size_t own = all[g].cost;
        std::size_t cost = 0, work = 0;
        for (const Vertex function : all[g].functions) {
            cost += plain_cost(function, work);
            if (cost > doubt * own || work > patience * own)
                break;
        }
        const bool told = work <= patience * own;
        useless[g] = told && cost <= own;
        doubtful = doubtful || (told && cost > own && cost <= doubt * own);
    }
    for (Vertex vertex = 0; vertex < nodes_; ++vertex)
        if (is_intermediate(vertex) && useless[group_of[vertex]])
            eliminated_[vertex] = true;
    return doubtful;
}

std::vector<std::uint32_t> LinearGraph::remaining() const {
    std::vector<std::uint32_t> found;
    for (Vertex vertex = 0; vertex < nodes_; ++vertex)
        if (is_intermediate(vertex))
            found.push_back(vertex);
    return found;
}

} // namespace graze
