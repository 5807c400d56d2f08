#include "symbolic/subgraph.hpp"
#include "graze/base/input_error.hpp"

namespace graze {

namespace {

/// Maps node indices to positions: a hash table with open addressing, since lookups dominate the time of compiling.
class NodePositions {
public:
    static constexpr std::uint32_t none = 0xffffffff;

    NodePositions() : slots_(16) {}

    std::uint32_t find(NodeIndex index) const { return slots_[slot_of(index)].position; }
    /// @param index not yet in the table
    void add(NodeIndex index, std::uint32_t position) {
        if (2 * ++used_ > slots_.size())
            grow();
        slots_[slot_of(index)] = {index, position};
    }

private:
    struct Slot {
        NodeIndex index = 0;
        std::uint32_t position = none;
    };
    /// Returns the slot of an index, or the free slot for it. At most half of the slots are used, so one is always
    /// free.
    std::size_t slot_of(NodeIndex index) const {
        const std::size_t mask = slots_.size() - 1;
        // Indices are mostly consecutive: multiplication by the golden ratio spreads them (Fibonacci hashing).
        std::size_t at = (std::uint64_t{index} * 0x9e3779b97f4a7c15U) >> shift_;
        while (slots_[at].position != none && slots_[at].index != index)
            at = (at + 1) & mask;
        return at;
    }
    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        --shift_;
        for (const Slot& slot : old)
            if (slot.position != none)
                slots_[slot_of(slot.index)] = slot;
    }

    std::vector<Slot> slots_;
    std::size_t used_ = 0;
    int shift_ = 60; ///< 64 minus the number of bits of a slot's index
};

} // namespace

Subgraph subgraph_of(std::span<const Expression> expressions) {
    Subgraph result;
    for (const Expression& expression : expressions) {
        if (expression.empty())
            throw InputError("an expression is empty", "");
        if (result.graph && result.graph != expression.graph())
            throw InputError("the expressions belong to different graphs", "");
        result.graph = expression.graph();
    }
    NodePositions positions;
    std::vector<NodeIndex> pending;
    for (const Expression& expression : expressions) {
        pending.push_back(expression.index());
        while (!pending.empty()) {
            const NodeIndex index = pending.back();
            if (positions.find(index) != NodePositions::none) {
                pending.pop_back();
                continue;
            }
            const Node& node = result.graph->node(index);
            const int operands = arity(node.operation);
            const std::uint32_t left = operands >= 1 ? positions.find(node.left) : 0,
                                right = operands == 2 ? positions.find(node.right) : 0;
            // The left operand is pushed last so that it comes first.
            if (right == NodePositions::none)
                pending.push_back(node.right);
            if (left == NodePositions::none)
                pending.push_back(node.left);
            if (left == NodePositions::none || right == NodePositions::none)
                continue;
            pending.pop_back();
            positions.add(index, static_cast<std::uint32_t>(result.items.size()));
            result.items.push_back({index, left, right});
        }
        result.roots.push_back(positions.find(expression.index()));
    }
    return result;
}

} // namespace graze
