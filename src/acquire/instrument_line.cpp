#include "graze/acquire/instrument_line.hpp"

#include "acquire/instrument_failure.hpp"
#include "graze/base/require.hpp"

#include <algorithm>
#include <chrono>

namespace graze {

namespace {

struct EndingWords {
    std::string_view name, remedy;
};

/// In the order of AcquisitionEnding; the last are for numbers that are none of them.
constexpr EndingWords ending_words[]{
    {"complete", "call it again to go on"},
    {"interrupted", "call it again to go on"},
    {"line-lost", "look at its cable and whether it is switched on, then call it again to go on"},
    {"no-answer", "see whether it is switched on, and at this port with these settings of the line, then call it again "
                  "to go on"},
    {"garbled", "give the settings of the line that the instrument has (baud, parity, stop_bits, flow), or a better "
                "cable, then call it again to go on"},
    {"foreign", "nothing was set; give the generator's port, or what it answers as identity"},
    {"refused", "give levels that it can take, in an experiment and a folder of their own"},
    {"clipped", "see what limits it, its load or somebody at its knobs, then call it again to go on; or give a larger "
                "tolerance under [generator]"},
    {"samples", "see what it is doing, and whether rate, timeout and patience suit it, then call it again to go on"},
    {"", ""},
};

const EndingWords& word_of(AcquisitionEnding ending) {
    return ending_words[std::min(static_cast<std::size_t>(ending), std::size(ending_words) - 1)];
}

} // namespace

std::string_view name_of(AcquisitionEnding ending) {
    return word_of(ending).name;
}

std::string remedy_of(AcquisitionEnding ending) {
    return std::string(word_of(ending).remedy);
}

std::string awaited_line(InstrumentLine& line, double timeout, const std::function<bool()>& interrupted,
                         std::string_view who, std::string_view question) {
    constexpr double longest = 1e6; // s: longer times overflow some clocks
    require_finite(timeout, "time to wait for an instrument");
    timeout = std::clamp(timeout, 0.0, longest);
    using Clock = std::chrono::steady_clock;
    constexpr double slice = 0.05; // s, between calls of `interrupted`
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout));
    for (;;) {
        if (interrupted && interrupted())
            throw InstrumentError(AcquisitionEnding::interrupted, "interrupted");
        const double left = std::chrono::duration<double>(end - Clock::now()).count();
        if (auto received = line.receive(std::clamp(left, 0.0, slice)))
            return *std::move(received);
        if (left <= 0)
            fail(AcquisitionEnding::no_answer, "{} has not answered {}{}for {} s", who, question,
                 question.empty() ? "" : " ", timeout);
    }
}

} // namespace graze
