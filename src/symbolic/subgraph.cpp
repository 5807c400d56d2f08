#include "symbolic/subgraph.hpp"

#include <bit>
#include <optional>
#include <stdexcept>

namespace graze {

namespace {

/// Positions of nodes by their indices: a hash table with open addressing, since this is most of what compiling does.
class NodePositions {
public:
    NodePositions() : slots_(16) {}

    std::optional<std::uint32_t> find(NodeIndex index) const {
        const Slot& slot = slots_[slot_of(index)];
        return slot.used ? std::optional(slot.position) : std::nullopt;
    }
    /// @param index one that is not there yet
    void add(NodeIndex index, std::uint32_t position) {
        if (2 * ++used_ > slots_.size())
            grow();
        slots_[slot_of(index)] = {index, position, true};
    }

private:
    struct Slot {
        NodeIndex index = 0;
        std::uint32_t position = 0;
        bool used = false;
    };
    /// Where an index is, or where it belongs. Half of the slots are free, so that there is always one.
    std::size_t slot_of(NodeIndex index) const {
        const std::size_t mask = slots_.size() - 1;
        // Indices that follow one another, as they do, are spread by a multiple of the golden section.
        std::size_t at = (std::uint64_t{index} * 0x9e3779b97f4a7c15U) >> (64 - std::countr_zero(slots_.size()));
        while (slots_[at].used && slots_[at].index != index)
            at = (at + 1) & mask;
        return at;
    }
    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.used)
                slots_[slot_of(slot.index)] = slot;
    }

    std::vector<Slot> slots_;
    std::size_t used_ = 0;
};

} // namespace

Subgraph subgraph_of(std::span<const Expression> expressions) {
    Subgraph result;
    for (const Expression& expression : expressions) {
        if (expression.empty())
            throw std::invalid_argument("an expression is empty");
        if (result.graph && result.graph != expression.graph())
            throw std::invalid_argument("the expressions belong to different graphs");
        result.graph = expression.graph();
    }
    NodePositions positions;
    std::vector<NodeIndex> pending;
    for (const Expression& expression : expressions) {
        pending.push_back(expression.index());
        while (!pending.empty()) {
            const NodeIndex index = pending.back();
            if (positions.find(index)) {
                pending.pop_back();
                continue;
            }
            const Node& node = result.graph->node(index);
            const int operands = arity(node.operation);
            const std::optional<std::uint32_t> left = operands >= 1 ? positions.find(node.left) : 0,
                                               right = operands == 2 ? positions.find(node.right) : 0;
            // The left operand is pushed last so that it comes first.
            if (!right)
                pending.push_back(node.right);
            if (!left)
                pending.push_back(node.left);
            if (!left || !right)
                continue;
            pending.pop_back();
            positions.add(index, static_cast<std::uint32_t>(result.items.size()));
            result.items.push_back({index, *left, *right});
        }
        result.roots.push_back(*positions.find(expression.index()));
    }
    return result;
}

} // namespace graze
