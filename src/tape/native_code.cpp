#include "tape/native_code.hpp"

#include "tape/aligned_numbers.hpp"

#if defined(GRAZE_NATIVE)
#include "tape/native_emitter.hpp"
#include "tape/native_steps.hpp"
#include "tape/tape_analysis.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <unordered_set>

#include <sys/mman.h>
#include <unistd.h>

// Debian's static library of AsmJit cannot be linked into a shared one because of three functions that print messages.
// These stand for them: the emitter is told of errors, and nothing is printed.
ASMJIT_BEGIN_NAMESPACE
namespace DebugUtils {

const char* errorAsString(Error) noexcept {
    return "";
}
void debugOutput(const char*) noexcept {}
void assertionFailed(const char*, int, const char*) noexcept {
    std::abort();
}

} // namespace DebugUtils
ASMJIT_END_NAMESPACE
#endif

namespace graze {

namespace {

/// The time for making the code is about that of as many computations.
constexpr std::size_t many = 4096;

} // namespace

#if defined(GRAZE_NATIVE)

namespace {

/// Most steps of all orders, and most bytes of code.
constexpr std::size_t most_steps = 16384, most_bytes = 1 << 19;
/// Bytes without meaning before the first instruction: sanitizers look for the type of a function there.
constexpr std::size_t before_code = 64;

/// Code, generated twice: see NativeRegisters.
struct Generated {
    explicit Generated(const NativeEmitter::Setting& setting)
        : trial(setting, nullptr), emitter(setting, &trial.uses()) {
        trial.emit();
        emitter.emit();
    }
    bool usable() const { return !emitter.failed() && emitter.code().size() <= most_bytes; }
    NativeEmitter trial, emitter;
};

/// Returns the series that are read in the memory of a jet: all of those that deferred expressions could need.
std::unordered_set<Offset> stored_series(const Tape& tape, const JetLayout& layout) {
    std::unordered_set<Offset> stored;
    const auto add = [&](std::uint32_t index) {
        stored.insert(static_cast<Offset>(layout.registers + index * layout.series));
    };
    if (!tape.deferred.empty()) {
        for (std::uint32_t index = 0; index < tape.registers; ++index)
            add(index);
        return stored;
    }
    for (std::uint32_t state = 0; state < tape.states; ++state)
        add(state);
    for (const Tape::Location& output : tape.outputs)
        if (!output.constant)
            add(output.index);
    const GuardingRegisters guards = guarding_registers(tape);
    for (const GuardingRegisters::Argument& argument : guards.arguments)
        add(argument.index);
    for (const std::uint32_t quotient : guards.quotients)
        add(quotient);
    return stored;
}

} // namespace

std::shared_ptr<const NativeCode> NativeCode::make(const Tape& tape, int order, const KernelTable& table,
                                                   InstructionSet set) {
    if (set == InstructionSet::baseline || order < 2)
        return nullptr;
    const JetLayout layout(tape, order, 1);
    const AlignedNumbers memory(layout.size); // only for its addresses
    std::vector<TermOperands> terms;
    for (const Term& term : tape.terms)
        terms.push_back(
            {memory.data() + layout.registers + term.series * layout.series, memory.data() + term.coefficient});
    const StepFinder finder(tape, table, layout, memory.data(), terms);
    const std::vector<NativeStep> first = native_steps(finder, table, memory.data(), 0, 1),
                                  steps = native_steps(finder, table, memory.data(), 2, order);
    if (steps.size() > most_steps)
        return nullptr;
    const std::unordered_set<Offset> stored = stored_series(tape, layout);
    const bool wide = set == InstructionSet::avx512;
    const Generated beginning({first, order, stored, wide, 0}),
        rest({steps, order, stored, wide, beginning.emitter.calls().size()});
    const std::shared_ptr<NativeCode> made(new NativeCode);
    if (!beginning.usable() || !rest.usable() || !made->store(beginning.emitter.code(), rest.emitter.code()))
        return nullptr;
    made->scratch_ = rest.emitter.scratch();
    for (const NativeEmitter* emitter : {&beginning.emitter, &rest.emitter})
        for (const NativeStep& call : emitter->calls())
            made->calls_.push_back({call.result, call.left, call.right, call.third});
    return made;
}

/// Writes the code to new pages of memory, which then can be executed and no longer written.
bool NativeCode::store(std::span<const std::uint8_t> beginning, std::span<const std::uint8_t> rest) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t second = before_code + (beginning.size() + before_code - 1) / before_code * before_code;
    const std::size_t size = (second + rest.size() + page - 1) / page * page;
    void* const pages = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED)
        return false;
    pages_ = pages;
    size_ = size;
    auto* const to = static_cast<std::uint8_t*>(pages);
    std::memset(to, 0xcc, size); // int3: a jump to a wrong place stops the program
    std::ranges::copy(beginning, to + before_code);
    std::ranges::copy(rest, to + second);
    beginning_ = reinterpret_cast<Entry>(to + before_code);
    rest_ = reinterpret_cast<Entry>(to + second);
    return mprotect(pages, size, PROT_READ | PROT_EXEC) == 0;
}

NativeCode::~NativeCode() {
    if (pages_ != nullptr)
        munmap(pages_, size_);
}

void NativeCode::prepare(double* scratch) const {
    for (int k = 1; k <= highest_order; ++k) {
        scratch[NativeEmitter::inverses + k] = 1.0 / k;
        scratch[NativeEmitter::negative_inverses + k] = -1.0 / k;
        scratch[NativeEmitter::integers + k] = k;
    }
}

std::vector<KernelOperands> NativeCode::calls(double* memory) const {
    const auto at = [&](Offset offset) { return offset == no_offset ? nullptr : memory + offset; };
    std::vector<KernelOperands> operands;
    for (const Call& call : calls_)
        operands.push_back({at(call.result), at(call.left), at(call.right), at(call.third), nullptr, nullptr});
    return operands;
}

#else

std::shared_ptr<const NativeCode> NativeCode::make(const Tape&, int, const KernelTable&, InstructionSet) {
    return nullptr;
}
NativeCode::~NativeCode() = default;
void NativeCode::prepare(double*) const {}
std::vector<KernelOperands> NativeCode::calls(double*) const {
    return {};
}

#endif

std::shared_ptr<const NativeCode> NativeCodes::after_portion(int order, InstructionSet set, bool now) {
    const std::scoped_lock lock(mutex_);
    Entry& entry = entries_[{order, set}];
    entry.computed += portion;
    if (!entry.tried && (now || entry.computed >= many)) {
        entry.tried = true;
        entry.code = NativeCode::make(tape_, order, kernel_table(LaneKind::single, set), set);
    }
    return entry.code;
}

std::shared_ptr<const NativeCode> NativeCodes::find(int order, InstructionSet set) {
    const std::scoped_lock lock(mutex_);
    const auto found = entries_.find({order, set});
    return found != entries_.end() ? found->second.code : nullptr;
}

NativeRun::NativeRun(std::shared_ptr<const NativeCode> code, double* memory)
    : code_(std::move(code)), memory_(memory), scratch_(code_->scratch()), calls_(code_->calls(memory)) {
    code_->prepare(scratch_.data());
}

} // namespace graze
