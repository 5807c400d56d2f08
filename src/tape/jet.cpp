#include "graze/tape/jet.hpp"

#include "tape/step_finder.hpp"
#include "tape/tape_analysis.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace graze {

namespace {

const KernelTable& table_of(LaneKind kind, [[maybe_unused]] InstructionSet set) {
#if defined(__x86_64__)
    if (set == InstructionSet::avx2)
        return avx2::kernels(kind);
    if (set == InstructionSet::avx512)
        return avx512::kernels(kind);
#endif
    return baseline::kernels(kind);
}

/// Where kernels do not jump but call each other, as without optimisation, this bounds the depth of the stack.
constexpr std::size_t longest_chain = 64;

void end_of_chain(const KernelOperands*, const KernelLink*, int) {}

/// Numbers aligned to cache lines, all 0 at first.
class AlignedNumbers {
public:
    explicit AlignedNumbers(std::size_t count)
        : numbers_(static_cast<double*>(::operator new(count * sizeof(double), alignment))) {
        std::fill_n(numbers_, count, 0.0);
    }
    AlignedNumbers(const AlignedNumbers&) = delete;
    AlignedNumbers& operator=(const AlignedNumbers&) = delete;
    ~AlignedNumbers() { ::operator delete(numbers_, alignment); }

    double* data() const { return numbers_; }

private:
    static constexpr std::align_val_t alignment{64};
    double* numbers_;
};

bool same_operands(const KernelStep& one, const KernelStep& other) {
    const KernelOperands& a = one.operands;
    const KernelOperands& b = other.operands;
    return a.result == b.result && a.left == b.left && a.right == b.right && a.third == b.third && a.terms == b.terms;
}

class TapeJet final : public Jet {
public:
    TapeJet(const Tape& tape, int order, const KernelTable& table);

    int order() const override { return order_; }
    int width() const override { return static_cast<int>(layout_.number); }
    void set_parameters(std::span<const double> parameters) override;
    void compute(std::span<const double> states) override;
    void compute_values(std::span<const double> states) override;
    const double* state(std::size_t index) const override {
        return memory_.data() + layout_.registers + index * layout_.series;
    }
    const double* output(std::size_t index) const override { return outputs_[index]; }
    std::span<const Series> series() const override { return series_; }
    void find_steps(double log_tolerance, std::span<const double> references, std::span<double> steps) const override {
        table_.steps(series_.data(), series_.size(), order_, log_tolerance, references.data(), steps.data());
    }
    bool compute_from(const Jet& values, std::span<const double> states) override;
    void find_disagreement(const EndCheck& check, std::span<const double> lengths,
                           std::span<double> worst) const override {
        table_.disagreement(check, lengths.data(), worst.data());
    }
    void guard_steps(std::span<double> steps) const override {
        if (!arguments_.empty() || !quotients_.empty())
            table_.guard({arguments_.data(), kinds_.data(), arguments_.size(), quotients_.data(), quotients_.size()},
                         order_, steps.data());
    }
    void evaluate_states(std::span<const double> times, std::span<double> values,
                         std::span<double> slopes) const override {
        for (std::size_t i = 0; i < states_; ++i)
            table_.sum_and_slope(state(i), order_, times.data(), values.data() + i * layout_.number,
                                 slopes.data() + i * layout_.number);
    }
    void evaluate_states(std::span<const double> times, std::span<double> values) const override {
        for (std::size_t i = 0; i < states_; ++i)
            table_.sum(state(i), order_, times.data(), values.data() + i * layout_.number);
    }
    void evaluate_output(std::size_t index, std::span<const double> times, std::span<double> values) const override {
        table_.sum(output(index), order_, times.data(), values.data());
    }
    void bound_output(std::size_t index, std::span<const double> lengths, std::span<double> least,
                      std::span<double> sizes, std::span<double> ends) const override {
        table_.bound(output(index), order_, lengths.data(), least.data(), sizes.data(), ends.data());
    }

private:
    /// Steps at one order; operands are shared by orders that take the same steps. The kernels are in chains of at
    /// most `longest_chain`, each with a last one that only returns.
    struct Segment {
        std::size_t kernels, operands, count;
    };
    struct Copy {
        const double* from;
        double* to;
    };

    void add_segment(const std::vector<KernelStep>& steps);
    void find_constants(const Tape& tape, const KernelTable& table);
    void compute_constants();
    void set_states(std::span<const double> states);
    void run(const Segment& segment, int order) const {
        const KernelLink* link = kernels_.data() + segment.kernels;
        const KernelOperands* operands = operands_.data() + segment.operands;
        for (std::size_t done = 0; done < segment.count; done += longest_chain) {
            link->kernel(operands, link + 1, order);
            link += longest_chain + 1;
            operands += longest_chain;
        }
    }

    const KernelTable& table_;
    int order_;
    std::size_t states_, registers_;
    std::size_t parameters_;
    bool values_known_ = false; ///< all of order 0 is that of the states and parameters
    Layout layout_;
    AlignedNumbers memory_;
    std::vector<TermOperands> terms_;
    std::vector<KernelLink> kernels_;
    std::vector<KernelOperands> operands_;
    std::vector<Segment> segments_; ///< by order, then those of values and of rates
    std::vector<KernelStep> constant_code_;
    std::vector<Copy> constant_copies_; ///< to rates and outputs that are constants
    std::vector<const double*> outputs_;
    std::vector<Series> series_;                ///< states and outputs
    std::vector<Series> arguments_, quotients_; ///< guards of the steps
    std::vector<GuardKind> kinds_;              ///< of the arguments
};

TapeJet::TapeJet(const Tape& tape, int order, const KernelTable& table)
    : table_(table), order_(order), states_(tape.states), registers_(tape.registers), parameters_(tape.parameters),
      layout_(tape, order, table.width), memory_(layout_.size) {
    const auto register_at = [&](std::uint32_t index) {
        return memory_.data() + layout_.registers + index * layout_.series;
    };
    terms_.reserve(tape.terms.size());
    for (const Term& term : tape.terms)
        terms_.push_back({register_at(term.series), memory_.data() + term.coefficient * layout_.number});

    const StepFinder finder(tape, table, layout_, memory_.data(), terms_);
    for (int k = 0; k <= order; ++k)
        add_segment(finder.steps(k));
    add_segment(finder.rate_steps());

    std::size_t constant_outputs = 0;
    for (const Tape::Location& location : tape.outputs) {
        if (!location.constant) {
            outputs_.push_back(register_at(location.index));
            continue;
        }
        double* series = memory_.data() + layout_.constant_outputs + constant_outputs++ * layout_.series;
        constant_copies_.push_back({memory_.data() + location.index * layout_.number, series});
        outputs_.push_back(series);
    }
    for (std::size_t i = 0; i < states_; ++i)
        series_.push_back({state(i), layout_.number});
    for (const double* output : outputs_)
        series_.push_back({output, layout_.number});
    const GuardingRegisters guards = guarding_registers(tape);
    for (const auto& [index, kind] : guards.arguments) {
        arguments_.push_back({register_at(index), layout_.number});
        kinds_.push_back(kind);
    }
    for (const std::uint32_t index : guards.quotients)
        quotients_.push_back({register_at(index), layout_.number});
    find_constants(tape, table);
    compute_constants();
}

void TapeJet::add_segment(const std::vector<KernelStep>& steps) {
    if (!segments_.empty()) {
        const Segment& last = segments_.back();
        bool same = last.count == steps.size();
        for (std::size_t i = 0; same && i < steps.size(); ++i)
            same = same_operands({nullptr, operands_[last.operands + i]}, steps[i]);
        segments_.push_back({kernels_.size(), same ? last.operands : operands_.size(), steps.size()});
    } else {
        segments_.push_back({0, 0, steps.size()});
    }
    const bool new_operands = segments_.back().operands == operands_.size();
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (i > 0 && i % longest_chain == 0)
            kernels_.push_back({end_of_chain});
        kernels_.push_back({steps[i].kernel});
        if (new_operands)
            operands_.push_back(steps[i].operands);
    }
    kernels_.push_back({end_of_chain});
}

void TapeJet::find_constants(const Tape& tape, const KernelTable& table) {
    const auto constant_at = [&](std::uint32_t index) { return memory_.data() + index * layout_.number; };
    for (const auto& [index, value] : tape.literals)
        table.literal(constant_at(index), value);
    for (const ConstantInstruction& instruction : tape.constant_code)
        constant_code_.push_back({table.constant[static_cast<int>(instruction.operation)],
                                  {constant_at(instruction.result),
                                   constant_at(instruction.left),
                                   constant_at(instruction.right),
                                   {},
                                   {},
                                   {}}});
    for (std::uint32_t i = 0; i < tape.states; ++i)
        if (tape.rates[i].constant)
            constant_copies_.push_back({constant_at(tape.rates[i].index),
                                        memory_.data() + layout_.registers + i * layout_.series + layout_.number});
}

void TapeJet::compute_constants() {
    const KernelLink end{end_of_chain};
    for (const KernelStep& step : constant_code_)
        step.kernel(&step.operands, &end, 0);
    for (const Copy& copy : constant_copies_)
        std::copy_n(copy.from, layout_.number, copy.to);
}

void TapeJet::set_parameters(std::span<const double> parameters) {
    if (parameters.size() != parameters_ * layout_.number)
        throw std::invalid_argument("wrong number of parameters for a jet");
    values_known_ = false;
    std::ranges::copy(parameters, memory_.data());
    compute_constants();
}

void TapeJet::set_states(std::span<const double> states) {
    if (states.size() != states_ * layout_.number)
        throw std::invalid_argument("wrong number of states for a jet");
    double* to = memory_.data() + layout_.registers;
    if (layout_.number == 1) {
        for (const double value : states) {
            *to = value;
            to += layout_.series;
        }
        return;
    }
    for (const double* from = states.data(); from != states.data() + states.size(); from += layout_.number) {
        std::copy_n(from, layout_.number, to);
        to += layout_.series;
    }
}

void TapeJet::compute(std::span<const double> states) {
    values_known_ = false;
    set_states(states);
    for (int k = 0; k <= order_; ++k)
        run(segments_[static_cast<std::size_t>(k)], k);
}

bool TapeJet::compute_from(const Jet& values, std::span<const double> states) {
    const auto* from = static_cast<const TapeJet*>(&values); // there is no other kind
    if (!from->values_known_ || from->order_ != 1)
        return false;
    const std::size_t number = layout_.number;
    const double* source = from->memory_.data() + from->layout_.registers;
    for (std::size_t i = 0; i < states_; ++i)
        if (!std::equal(source + i * from->layout_.series, source + i * from->layout_.series + number,
                        states.data() + i * number))
            return false;
    double* to = memory_.data() + layout_.registers;
    if (number == 1)
        for (std::size_t r = 0; r < registers_; ++r)
            to[r * layout_.series] = source[2 * r];
    else
        for (std::size_t r = 0; r < registers_; ++r)
            std::copy_n(source + r * from->layout_.series, number, to + r * layout_.series);
    std::copy_n(from->memory_.data() + from->layout_.reciprocals, layout_.constant_outputs - layout_.reciprocals,
                memory_.data() + layout_.reciprocals);
    for (int k = 1; k <= order_; ++k)
        run(segments_[static_cast<std::size_t>(k)], k);
    return true;
}

void TapeJet::compute_values(std::span<const double> states) {
    set_states(states);
    // All of order 0, also what only derivatives need: `compute_from` goes on from it.
    run(segments_[0], 0);
    run(segments_[static_cast<std::size_t>(order_) + 1], 1);
    values_known_ = true;
}

} // namespace

bool is_supported(InstructionSet set) {
#if defined(__x86_64__)
    const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                          __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                            __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                            __builtin_cpu_supports("avx512vl");
    switch (set) {
    case InstructionSet::avx2:
        return has_avx2;
    case InstructionSet::avx512:
        return has_avx2 && has_avx512;
    default:
        return true;
    }
#else
    return set == InstructionSet::baseline;
#endif
}

InstructionSet best_instruction_set() {
    for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2})
        if (is_supported(set))
            return set;
    return InstructionSet::baseline;
}

std::string_view name_of(InstructionSet set) {
    switch (set) {
    case InstructionSet::avx2:
        return "avx2";
    case InstructionSet::avx512:
        return "avx512";
    default:
        return "baseline";
    }
}

int lanes_of(LaneKind kind, InstructionSet set) {
    const int width = table_of(kind, set).width;
    return kind == LaneKind::tangent ? width - 1 : width;
}

std::unique_ptr<Jet> make_jet(const Tape& tape, int order, LaneKind kind, InstructionSet set) {
    if (order < 1 || order > highest_order)
        throw std::invalid_argument("the order of a jet must be between 1 and " + std::to_string(highest_order));
    if (!is_supported(set))
        throw std::invalid_argument("this processor does not have the instruction set " + std::string(name_of(set)));
    return std::make_unique<TapeJet>(tape, order, table_of(kind, set));
}

} // namespace graze
