#pragma once

#include "tape/order_schedule.hpp"
#include "tape/step_finder.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// A program: kernels in the order in which they compute coefficients of all orders, in chains where each calls the
/// next.
class KernelProgram {
public:
    enum class Sequence { by_order, by_instruction };
    /// @param order the highest order; @param sequence by order where coefficients depend on each other (feedback)
    KernelProgram(const StepFinder& finder, const KernelTable& table, int order, Sequence sequence);

    /// Computes coefficients 0 and 1.
    void begin() const { run(std::span(chains_).first(beginning_)); }
    /// Computes all higher coefficients, after `begin`.
    void go_on() const { run(std::span(chains_).subspan(beginning_)); }

private:
    /// Entry of a chain of at most `longest_chain` kernels followed by one that only returns. A chain may continue from
    /// one order to the next.
    struct Chain {
        const KernelLink* link;
        const KernelOperands* operands;
        Order order;
    };
    /// The steps of one order, or of one round of several orders; `operands` is the index of operands shared with the
    /// same steps of the segment before.
    struct Segment {
        std::vector<KernelStep> steps;
        Order order;
        bool begins; ///< starts a new chain
        std::size_t operands = 0;
        std::vector<Order> orders = {}; ///< of each step, unless all are of `order`
    };
    static void run(std::span<const Chain> chains) {
        for (const Chain& chain : chains)
            chain.link->kernel(chain.operands, chain.link + 1, chain.order);
    }
    static void add_by_order(const StepFinder& finder, int order, std::vector<Segment>& segments);
    static void add_rounds(const StepFinder& finder, int order, const std::vector<KernelStep>& all,
                           const std::vector<ScheduledUnit>& units, std::vector<Segment>& segments);
    static void add_by_instruction(const StepFinder& finder, int order, std::vector<Segment>& segments);
    void find_operands(std::vector<Segment>& segments);
    void find_chains(const std::vector<Segment>& segments, const KernelTable& table);

    std::vector<KernelLink> kernels_; // chains point to elements of both, also after a move of the program
    std::vector<KernelOperands> operands_;
    std::vector<Chain> chains_;
    std::size_t beginning_ = 0; ///< number of chains of orders 0 and 1
};

/// The end of a chain: only returns.
void end_of_chain(const KernelOperands*, const KernelLink*, Order);

} // namespace graze
