#include "program/design_progress.hpp"

#include "program/arguments.hpp"
#include "program/interrupt.hpp"

namespace graze {

DesignReportOptions interactive_options(int jobs, StatusLine& line) {
    DesignReportOptions options;
    options.jobs = threads_for(jobs);
    options.interrupted = [] { return InterruptGuard::requested(); };
    options.progress = [&line](const std::string& what) {
        if (line.is_due())
            line.show(what);
    };
    return options;
}

} // namespace graze
