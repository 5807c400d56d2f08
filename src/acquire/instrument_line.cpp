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
