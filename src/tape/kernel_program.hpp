#pragma once

#include "tape/step_finder.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Kernels in the sequence in which they compute coefficients of all orders, as links of chains: each calls the next.
class KernelProgram {
public:
    enum class Sequence { by_order, by_instruction };
    /// @param order the highest; @param sequence by order where instructions go back into what they are made of
    KernelProgram(const StepFinder& finder, const KernelTable& table, int order, Sequence sequence);

    /// Coefficients 0 and 1 ...
    void begin() const { run(std::span(chains_).first(beginning_)); }
    /// ... and all others, after those.
    void go_on() const { run(std::span(chains_).subspan(beginning_)); }

private:
    /// The first of a chain of at most `longest_chain` kernels, behind which is one that only returns. It may go on
    /// from one order to the next.
    struct Chain {
        const KernelLink* link;
        const KernelOperands* operands;
        Order order;
    };
    /// Steps at one order, and where the operands are that they share with those of the order before.
    struct Segment {
        std::vector<KernelStep> steps;
        Order order;
        bool begins; ///< a chain of its own
        std::size_t operands = 0;
    };
    static void run(std::span<const Chain> chains) {
        for (const Chain& chain : chains)
            chain.link->kernel(chain.operands, chain.link + 1, chain.order);
    }
    static void add_by_order(const StepFinder& finder, int order, std::vector<Segment>& segments);
    static void add_by_instruction(const StepFinder& finder, int order, std::vector<Segment>& segments);
    void find_operands(std::vector<Segment>& segments);
    void find_chains(const std::vector<Segment>& segments, const KernelTable& table);

    std::vector<KernelLink> kernels_; // chains point to both, wherever the program itself is moved
    std::vector<KernelOperands> operands_;
    std::vector<Chain> chains_;
    std::size_t beginning_ = 0; ///< chains of orders 0 and 1
};

/// The end of a chain: only returns.
void end_of_chain(const KernelOperands*, const KernelLink*, Order);

} // namespace graze
