#pragma once

#include "graze/design/design_report.hpp"
#include "program/arguments.hpp"
#include "program/interrupt.hpp"
#include "program/mpi_workers.hpp"
#include "program/status_line.hpp"

namespace graze {

/// Options of a design's computations that stop on an interrupt and show progress on `line`, which must outlive them.
/// @param workers solve for the devices of yields, within carry_out; null: threads of this process do
inline DesignReportOptions interactive_options(int jobs, StatusLine& line, const Workers* workers = nullptr) {
    DesignReportOptions options;
    options.jobs = threads_beside(workers, jobs);
    options.elsewhere = workers ? workers->devices() : nullptr;
    options.interrupted = [] { return InterruptGuard::requested(); };
    options.progress = [&line](const std::string& what) {
        if (line.is_due())
            line.show(what);
    };
    return options;
}

} // namespace graze
