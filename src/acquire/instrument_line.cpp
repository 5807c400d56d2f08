#include "graze/acquire/instrument_line.hpp"

#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace graze {

std::string_view name_of(AcquisitionEnding ending) {
    switch (ending) {
    case AcquisitionEnding::complete:
        return "complete";
    case AcquisitionEnding::interrupted:
        return "interrupted";
    case AcquisitionEnding::line_lost:
        return "line-lost";
    case AcquisitionEnding::no_answer:
        return "no-answer";
    case AcquisitionEnding::garbled:
        return "garbled";
    case AcquisitionEnding::foreign:
        return "foreign";
    case AcquisitionEnding::refused:
        return "refused";
    case AcquisitionEnding::clipped:
        return "clipped";
    case AcquisitionEnding::samples:
        return "samples";
    }
    return "";
}

std::string remedy_of(AcquisitionEnding ending) {
    switch (ending) {
    case AcquisitionEnding::complete:
    case AcquisitionEnding::interrupted:
        break;
    case AcquisitionEnding::line_lost:
        return "look at its cable and whether it is switched on, then call it again to go on";
    case AcquisitionEnding::no_answer:
        return "see whether it is switched on, and at this port with these settings of the line, then call it again to "
               "go "
               "on";
    case AcquisitionEnding::garbled:
        return "give the settings of the line that the instrument has (baud, parity, stop_bits, flow), or a better "
               "cable, then call it again to go on";
    case AcquisitionEnding::foreign:
        return "nothing was set; give the generator's port, or what it answers as identity";
    case AcquisitionEnding::refused:
        return "give levels that it can take, in an experiment and a folder of their own";
    case AcquisitionEnding::clipped:
        return "see what limits it, its load or somebody at its knobs, then call it again to go on; or give a larger "
               "tolerance under [generator]";
    case AcquisitionEnding::samples:
        return "see what it is doing, and whether rate, timeout and patience suit it, then call it again to go on";
    }
    return "call it again to go on";
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
            throw InstrumentError(
                AcquisitionEnding::no_answer,
                fmt::format("{} has not answered {}{}for {} s", who, question, question.empty() ? "" : " ", timeout));
    }
}

} // namespace graze
