#include "graze/tape/jet.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/piece_table.hpp"
#include "tape/aligned_numbers.hpp"
#include "tape/kernel_program.hpp"
#include "tape/native_code.hpp"
#include "tape/tape_analysis.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace graze {

const KernelTable& kernel_table(LaneKind kind, [[maybe_unused]] InstructionSet set) {
#if defined(GRAZE_WITH_AVX2)
    if (set == InstructionSet::avx2)
        return avx2::kernels(kind);
#endif
#if defined(GRAZE_WITH_AVX512)
    if (set == InstructionSet::avx512)
        return avx512::kernels(kind);
#endif
    return baseline::kernels(kind);
}

const TangentKernels& tangent_kernels(std::size_t directions, [[maybe_unused]] InstructionSet set) {
#if defined(GRAZE_WITH_AVX2)
    if (set == InstructionSet::avx2)
        return avx2::tangent_kernels(directions);
#endif
#if defined(GRAZE_WITH_AVX512)
    if (set == InstructionSet::avx512)
        return avx512::tangent_kernels(directions);
#endif
    return baseline::tangent_kernels(directions);
}

namespace {

/// exp(-40) is lost in a sum with 1.
constexpr double nothing = 40;

class TapeJet final : public Jet {
public:
    TapeJet(const Tape& tape, int order, LaneKind kind, InstructionSet set, MachineCode code);

    int order() const override { return order_; }
    int width() const override { return static_cast<int>(layout_.number); }
    void set_parameters(std::span<const double> parameters) override;
    void compute(std::span<const double> states) override;
    void begin(std::span<const double> states) override;
    const double* state(std::size_t index) const override {
        require_index(index, states_, "state");
        return memory_.data() + layout_.registers + index * layout_.series;
    }
    const double* output(std::size_t index) const override { return item_at(outputs_, index, "output"); }
    void compute_deferred(std::span<const std::uint32_t> groups) override;
    void begin_deferred(std::span<const std::uint32_t> groups) override;
    const double* deferred(std::size_t index) const override {
        return item_at(deferred_, index, "deferred expression");
    }
    std::size_t deferred_count() const override { return deferred_.size(); }
    std::span<const Series> series() const override { return series_; }
    void find_steps(double log_tolerance, std::span<const double> references, std::span<double> steps) const override {
        require_lanes(references);
        require_lanes(steps);
        table_.steps(to_follow_, order_, log_tolerance, references.data(), steps.data());
        guard_steps(steps);
    }
    void find_disagreement(const Jet& end, const EndAllowance& allowance, std::span<const double> lengths,
                           std::span<const double> values, std::span<const double> slopes,
                           std::span<double> worst) const override;
    void guard_steps(std::span<double> steps) const override {
        require_lanes(steps);
        if (guards_.argument_count + guards_.quotient_count > 0)
            table_.guard(guards_, order_, steps.data());
    }
    void evaluate_states(std::span<const double> times, std::span<double> values,
                         std::span<double> slopes) const override {
        require_lanes(times);
        require_states(values);
        require_states(slopes);
        table_.sums_and_slopes(series_.data(), degrees_.data(), states_, times.data(), values.data(), slopes.data());
    }
    void evaluate_states(std::span<const double> times, std::span<double> values) const override {
        require_lanes(times);
        require_states(values);
        for (std::size_t i = 0; i < states_; ++i)
            table_.sum(state(i), degrees_[i], times.data(), values.data() + i * layout_.number);
    }
    void evaluate_output(std::size_t index, std::span<const double> times, std::span<double> values) const override {
        require_lanes(times);
        require_lanes(values);
        table_.sum(output(index), order_, times.data(), values.data());
    }
    void bound_outputs(std::span<const double> lengths, std::span<double> least,
                       std::span<double> sizes) const override {
        require_lanes(lengths);
        require_room(outputs_.size() * layout_.number, least.size(), "bounds of outputs");
        require_size(sizes.size(), least.size(), "sizes of outputs");
        for (std::size_t i = 0, at = 0; at < least.size(); ++i, at += layout_.number)
            table_.bound(outputs_[i], order_, lengths.data(), &least[at], &sizes[at]);
    }

private:
    struct Copy {
        const double* from;
        double* to;
    };
    void require_lanes(std::span<const double> values) const {
        require_room(values.size(), layout_.number, "numbers, one for each lane,");
    }
    void require_states(std::span<const double> values) const {
        require_room(values.size(), states_ * layout_.number, "numbers, states for each lane,");
    }
    const TapeJet& of_same_tape(const Jet& other) const;
    void find_constants(const Tape& tape, const KernelTable& table);
    void compute_constants();
    template <class Run>
    void run_deferred(std::span<const std::uint32_t> groups, Run&& run);
    void set_states(std::span<const double> states);
    void look_up();
    bool has_states(std::span<const double> states) const;
    void sort_series(const Tape& tape);

    void use(std::shared_ptr<const NativeCode> code);

    const KernelTable& table_;
    InstructionSet set_;
    int order_;
    std::size_t states_;
    std::size_t parameters_;
    JetLayout layout_;
    AlignedNumbers memory_;
    std::vector<TermOperands> terms_;
    std::shared_ptr<NativeCodes> codes_; ///< null if only kernels are used
    std::optional<NativeRun> native_;    ///< computes what the first program does, if there is code
    int until_portion_ = NativeCodes::portion;
    std::vector<KernelProgram> programs_; ///< for states and outputs, then for each part of `deferred_code`
    /// What each program has computed from the present states and parameters: nothing, orders 0 and 1, or all orders.
    enum class Progress : unsigned char { none, begun, computed };
    std::vector<Progress> progress_;
    std::vector<KernelStep> constant_code_;
    std::vector<Copy> constant_copies_; ///< values of constants to be copied to rates and outputs
    std::vector<const double*> outputs_, deferred_;
    std::vector<Series> series_;           ///< states and outputs
    std::vector<Series> followed_, lines_; ///< the same, sorted for the choice of steps
    FollowedSeries to_follow_{};           ///< refers to both
    std::vector<GuardedArgument> arguments_;
    std::vector<Series> quotients_;
    Guards guards_{};                                        ///< refers to all guards
    std::vector<Series> compared_states_, compared_outputs_; ///< at ends of steps
    std::vector<std::size_t> compared_indices_;              ///< indices of those states
    EndComparison comparison_{};                             ///< refers to these three
    std::vector<int> degrees_;                               ///< of states, at least 1
    std::vector<Tape::Piece> pieces_;
    Function piece_arguments_;
    std::vector<double> inputs_, arguments_now_, work_; ///< of the tables that are looked up
};

TapeJet::TapeJet(const Tape& tape, int order, LaneKind kind, InstructionSet set, MachineCode code)
    : table_(kernel_table(kind, set)), set_(set), order_(order), states_(tape.states), parameters_(tape.parameters),
      layout_(tape, order, table_.width), memory_(layout_.size + read_behind) {
    const KernelTable& table = table_;
    const auto register_at = [&](std::uint32_t index) {
        return memory_.data() + layout_.registers + index * layout_.series;
    };
    terms_.reserve(tape.terms.size());
    for (const Term& term : tape.terms)
        terms_.push_back({register_at(term.series), memory_.data() + term.coefficient * layout_.number});

    programs_.reserve(1 + tape.deferred_code.size());
    programs_.emplace_back(StepFinder(tape, table, layout_, memory_.data(), terms_), table, order,
                           KernelProgram::Sequence::by_order);
    for (std::size_t part = 0; part < tape.deferred_code.size(); ++part)
        programs_.emplace_back(StepFinder(tape, part, table, layout_, memory_.data(), terms_), table, order,
                               KernelProgram::Sequence::by_instruction);
    progress_.assign(programs_.size(), Progress::none);

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
    for (const Tape::Location& location : tape.deferred)
        deferred_.push_back(location.constant ? memory_.data() + location.index * layout_.number
                                              : register_at(location.index));
    for (std::size_t i = 0; i < states_; ++i)
        series_.push_back({state(i), layout_.number});
    for (const double* output : outputs_)
        series_.push_back({output, layout_.number});
    const GuardingRegisters guards = guarding_registers(tape);
    // The allowed change is about twice the change over which the terms of an exponential or a sine are largest, but
    // not so large that the last terms grow.
    const double change = order < 6 ? 0.7 * order : 4;
    for (const auto& [index, guard, exponent] : guards.arguments) {
        const bool power = guard == GuardKind::power;
        arguments_.push_back({{register_at(index), layout_.number},
                              guard,
                              power ? 0 : change,
                              power ? change / exponent : 0,
                              power ? std::exp(-nothing / exponent) : 0});
    }
    for (const std::uint32_t index : guards.quotients)
        quotients_.push_back({register_at(index), layout_.number});
    guards_ = {arguments_.data(), arguments_.size(), quotients_.data(), quotients_.size()};
    pieces_ = tape.pieces;
    piece_arguments_ = tape.piece_arguments;
    inputs_.resize(states_ + parameters_);
    arguments_now_.resize(pieces_.size());
    work_.resize(piece_arguments_.workspace());
    sort_series(tape);
    find_constants(tape, table);
    compute_constants();
    if (kind == LaneKind::single && code != MachineCode::never && tape.native_codes) {
        codes_ = tape.native_codes;
        use(code == MachineCode::at_once ? codes_->after_portion(order_, set_, true) : codes_->find(order_, set_));
    }
}

/// Computes by machine code from now on, if there is any.
void TapeJet::use(std::shared_ptr<const NativeCode> code) {
    if (code)
        native_.emplace(std::move(code), memory_.data());
}

/// Selects the series that limit steps (a polynomial below the order does not), and those to be compared at ends of
/// steps.
void TapeJet::sort_series(const Tape& tape) {
    const auto order = static_cast<std::uint32_t>(order_);
    const std::vector<bool> affine = affine_registers(tape);
    for (std::size_t i = 0; i < states_; ++i) {
        const std::uint32_t degree = tape.degrees[i];
        degrees_.push_back(static_cast<int>(std::clamp(degree, 1u, order)));
        (degree <= 1 && order > 2 ? lines_ : followed_).push_back(series_[i]);
        if (degree <= order)
            continue;
        compared_states_.push_back(series_[i]);
        compared_indices_.push_back(i);
    }
    for (std::size_t j = 0; j < outputs_.size(); ++j) {
        const Tape::Location& at = tape.outputs[j];
        const Series& series = series_[states_ + j];
        const std::uint32_t degree = at.constant ? 0 : tape.degrees[at.index];
        if (at.constant || at.index >= tape.states) // the states have been added already
            (degree <= 1 && order > 2 ? lines_ : followed_).push_back(series);
        if (degree > order && !affine[at.index])
            compared_outputs_.push_back(series);
    }
    to_follow_ = {followed_.data(), followed_.size(), lines_.data(), lines_.size()};
    comparison_ = {compared_states_.data(),  compared_indices_.data(), compared_states_.size(),
                   compared_outputs_.data(), compared_outputs_.size(), order_};
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
    const KernelLink end{.kernel = end_of_chain};
    for (const KernelStep& step : constant_code_)
        step.kernel(&step.operands, &end, 0);
    for (const Copy& copy : constant_copies_)
        std::copy_n(copy.from, layout_.number, copy.to);
}

void TapeJet::set_parameters(std::span<const double> parameters) {
    require_size(parameters.size(), parameters_ * layout_.number, "parameters of a jet");
    if (parameters.empty() || std::memcmp(parameters.data(), memory_.data(), parameters.size_bytes()) == 0)
        return;
    progress_.front() = Progress::none;
    std::ranges::copy(parameters, memory_.data());
    compute_constants();
}

void TapeJet::set_states(std::span<const double> states) {
    require_size(states.size(), states_ * layout_.number, "states of a jet");
    double* to = memory_.data() + layout_.registers;
    if (layout_.number == 1) {
        for (const double value : states) {
            *to = value;
            to += layout_.series;
        }
        return;
    }
    constexpr std::size_t usual = 8; // a fixed number of lanes is copied without a function call
    for (const double* from = states.data(); from != states.data() + states.size(); from += layout_.number) {
        if (layout_.number == usual)
            std::copy_n(from, usual, to);
        else
            std::copy_n(from, layout_.number, to);
        to += layout_.series;
    }
}

/// Sets the constants of the pieces to which the present states belong.
void TapeJet::look_up() {
    bool changed = false;
    for (std::size_t lane = 0; lane < layout_.number; ++lane) {
        for (std::size_t i = 0; i < states_; ++i)
            inputs_[i] = state(i)[lane];
        for (std::size_t j = 0; j < parameters_; ++j)
            inputs_[states_ + j] = memory_.data()[j * layout_.number + lane];
        piece_arguments_.evaluate(inputs_, arguments_now_, work_);
        for (std::size_t p = 0; p < pieces_.size(); ++p) {
            const PieceTable::Piece piece = pieces_[p].table->piece_at(arguments_now_[p]);
            double* to = memory_.data() + pieces_[p].first * layout_.number + lane;
            const auto set = [&](double value) {
                changed |= std::bit_cast<std::uint64_t>(*to) != std::bit_cast<std::uint64_t>(value);
                *to = value;
                to += layout_.number;
            };
            set(piece.knot);
            for (int k = 0; k <= pieces_[p].table->degree(); ++k)
                set(piece.coefficients[static_cast<std::size_t>(k)]);
        }
    }
    if (changed)
        compute_constants();
}

bool TapeJet::has_states(std::span<const double> states) const {
    const double* here = memory_.data() + layout_.registers;
    if (layout_.number == 1) {
        for (const double value : states) {
            if (*here != value)
                return false;
            here += layout_.series;
        }
        return true;
    }
    for (const double* other = states.data(); other != states.data() + states.size(); other += layout_.number) {
        if (!std::equal(other, other + layout_.number, here))
            return false;
        here += layout_.series;
    }
    return true;
}

void TapeJet::compute(std::span<const double> states) {
    begin(states);
    if (native_) {
        native_->go_on();
    } else {
        programs_.front().go_on();
        if (codes_ && --until_portion_ == 0) {
            until_portion_ = NativeCodes::portion;
            use(codes_->after_portion(order_, set_, false));
        }
    }
    progress_.front() = Progress::computed;
}

void TapeJet::begin(std::span<const double> states) {
    if (progress_.front() == Progress::begun && states.size() == states_ * layout_.number && has_states(states))
        return;
    set_states(states);
    if (!pieces_.empty())
        look_up();
    if (native_)
        native_->begin();
    else
        programs_.front().begin();
    std::ranges::fill(progress_, Progress::none);
    progress_.front() = Progress::begun;
}

/// Calls `run` for each program needed by some groups: that of group 0, the shared one, and that of each group.
template <class Run>
void TapeJet::run_deferred(std::span<const std::uint32_t> groups, Run&& run) {
    constexpr std::size_t first = 1, shared = 2; // indices of programs; group g has program g + 2
    if (programs_.size() == first)
        return;
    run(first);
    for (const std::uint32_t group : groups) {
        if (group > 0 && shared + group < programs_.size()) {
            run(shared);
            run(shared + group);
        }
    }
}

void TapeJet::begin_deferred(std::span<const std::uint32_t> groups) {
    if (progress_.front() == Progress::none)
        throw OrderError("deferred expressions need coefficients 0 and 1 of the states: call begin or compute first");
    run_deferred(groups, [this](std::size_t program) {
        if (progress_[program] == Progress::none) {
            programs_[program].begin();
            progress_[program] = Progress::begun;
        }
    });
}

void TapeJet::compute_deferred(std::span<const std::uint32_t> groups) {
    if (progress_.front() != Progress::computed)
        throw OrderError("deferred expressions need all coefficients of the states: call compute first");
    begin_deferred(groups);
    run_deferred(groups, [this](std::size_t program) {
        if (progress_[program] == Progress::begun) {
            programs_[program].go_on();
            progress_[program] = Progress::computed;
        }
    });
}

/// Checks that another jet has the same tape, kind and order.
const TapeJet& TapeJet::of_same_tape(const Jet& other) const {
    const auto& same = static_cast<const TapeJet&>(other); // the only derived class
    if (&same.table_ != &table_ || same.layout_.size != layout_.size || same.order_ != order_)
        throw InputError("ends of steps can be compared only with a jet of the same tape", "");
    return same;
}

void TapeJet::find_disagreement(const Jet& end, const EndAllowance& allowance, std::span<const double> lengths,
                                std::span<const double> values, std::span<const double> slopes,
                                std::span<double> worst) const {
    const TapeJet& other = of_same_tape(end);
    require_lanes(lengths);
    require_states(values);
    require_states(slopes);
    require_lanes(worst);
    table_.disagreement(comparison_, {memory_.data(), other.memory_.data(), values.data(), slopes.data(), allowance},
                        lengths.data(), worst.data());
}

} // namespace

bool is_supported(InstructionSet set) {
#if defined(__x86_64__)
    [[maybe_unused]] const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                                           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    [[maybe_unused]] const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                                             __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                                             __builtin_cpu_supports("avx512vl");
#endif
    switch (set) {
#if defined(GRAZE_WITH_AVX2)
    case InstructionSet::avx2:
        return has_avx2;
#endif
#if defined(GRAZE_WITH_AVX512)
    case InstructionSet::avx512:
        return has_avx2 && has_avx512;
#endif
    default:
        return set == InstructionSet::baseline;
    }
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

namespace {

void require_known(LaneKind kind, InstructionSet set) {
    if (kind != LaneKind::single && kind != LaneKind::ensemble)
        throw InputError("there is no such kind of lanes", "");
    if (set != InstructionSet::baseline && set != InstructionSet::avx2 && set != InstructionSet::avx512)
        throw InputError("there is no such instruction set", "");
}

} // namespace

int lanes_of(LaneKind kind, InstructionSet set) {
    require_known(kind, set);
    return kernel_table(kind, set).width;
}

std::unique_ptr<Jet> make_jet(const Tape& tape, int order, LaneKind kind, InstructionSet set, MachineCode code) {
    require_known(kind, set);
    if (order < 1 || order > highest_order)
        throw InputError("the order of a jet must be between 1 and " + std::to_string(highest_order), "");
    if (!is_supported(set))
        throw InputError("this processor does not have the instruction set " + std::string(name_of(set)), "");
    return std::make_unique<TapeJet>(tape, order, kind, set, code);
}

} // namespace graze
